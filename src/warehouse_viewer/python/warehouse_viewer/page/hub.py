# SPDX-License-Identifier: Apache-2.0
"""Brings news to the pages, each at the pace it keeps up with.

Nothing is queued: a page that is ready gets all that changed since it was last served, once.
"""

import asyncio
import json
import math
import time
from contextlib import suppress

import numpy as np
from starlette.websockets import WebSocketDisconnect

from warehouse_layout import poses
from warehouse_viewer.page import protocol
from warehouse_viewer.server.access import RateLimit

GAP = 0.08  # least time between two updates [s, wall]
SCENE_GAP = 1.0  # likewise between two scenes, of a megabyte where there are many items [s, wall]
STATUS_GAP = 1.0  # between two looks at the simulation's own state [s, wall]
OFFERS_GAP = 5.0  # between two looks at which services there are [s, wall]
IN_FLIGHT = 3  # updates a page may owe an answer to
MOST_GAP = 5.0  # between two updates, whatever a page asks for [s, wall]
MOST_WISHES = 100  # of a page [1/s]
NONSENSE = (ValueError, TypeError, KeyError, AttributeError)  # what reading it leads to
MOST_SCANS = 20  # robots whose scans are shown at once, by all pages


class Page:
    """One browser; `socket` is a starlette WebSocket that was accepted."""

    def __init__(self, socket, last_event):
        self.socket, self.tick, self.revision = socket, -1, None
        self.event, self.in_flight, self.status = last_event, 0, None
        self.gap = 0.0  # that it asks for between two updates [s, wall]
        self.scans, self.seen_scans = set(), {}
        self.paths, self.seen_paths = set(), {}
        self.ways, self.seen_ways = set(), None  # of these robots, None: of all
        self.coordinator = None  # the CoordinatorState that it was told

    async def send_json(self, message):
        await self.socket.send_text(json.dumps(message, separators=(",", ":")))


class Hub:
    """Lives in an asyncio loop; news() may be called from any thread.

    Without ROS: what comes is asked of `feed` and `simulation`, and `coordinator` tells a
    CoordinatorState as the API does.
    """

    def __init__(self, feed, model, journal, simulation, coordinator=None):
        self._tell_coordinator = coordinator
        self._feed, self._model, self._journal = feed, model, journal
        self._simulation = simulation
        self._pages, self._turn = set(), asyncio.Condition()
        self._news, self._loop = asyncio.Event(), None
        self._status, self._offers, self._offers_due = {}, {}, 0.0
        self._scene_due = 0.0

    def news(self):
        """Something came that a page may want to show."""
        with suppress(RuntimeError):  # the loop has ended
            if self._loop:
                self._loop.call_soon_threadsafe(self._news.set)

    @property
    def pages(self):
        return len(self._pages)

    # --- taking in
    async def run(self):
        """Until cancelled."""
        self._loop = asyncio.get_running_loop()
        watching = asyncio.create_task(self._watch_simulation())
        try:
            while True:
                with suppress(TimeoutError):
                    await asyncio.wait_for(self._news.wait(), 0.5)
                self._news.clear()
                self._refresh()
                async with self._turn:
                    self._turn.notify_all()
                await asyncio.sleep(GAP)
        finally:
            watching.cancel()

    def _refresh(self):
        if self._pages:
            self._feed.look()
        elif self._feed.rest():
            return
        if not self._feed.complete:
            return
        objects, states = self._feed.units_and_objects
        scenery = self._feed["scenery"]
        # While a warehouse is built, what stands there changes ten times a second.
        if not self._model.is_same_scene(objects, scenery):
            if time.monotonic() < self._scene_due:
                return
            self._scene_due = time.monotonic() + SCENE_GAP
        self._model.take(objects, states, self._feed["fleet"], scenery)

    async def _watch_simulation(self):
        while True:
            if self._pages:
                self._status = await asyncio.to_thread(self._look_at_simulation)
                self._news.set()
            await asyncio.sleep(STATUS_GAP)

    def _look_at_simulation(self):
        if time.monotonic() >= self._offers_due:
            self._offers = self._simulation.offers()
            self._offers_due = time.monotonic() + OFFERS_GAP
        lacks = {action: lack for action, lack in self._offers.items() if lack}
        try:
            state = self._simulation.state()
        except RuntimeError as error:
            return {"type": "status", "away": str(error), "lacks": lacks}
        name, number = self._simulation.warehouse()
        performance = self._feed["performance"]
        factor = performance.real_time_factor if performance else 0.0
        return {
            "type": "status",
            "away": None,
            "warehouse": name,
            "id": number,
            "factor": round(factor, 2),
            "lacks": lacks,
            **state,
        }

    # --- serving a page
    async def serve(self, socket):
        """One page, from its coming to its going."""
        self._feed.look()
        page = Page(socket, max(0, self._journal.last_id - 200))
        self._pages.add(page)
        self._news.set()
        sender = asyncio.create_task(self._send_forever(page))
        listener = asyncio.create_task(self._listen_forever(page))
        try:
            await asyncio.wait({sender, listener}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in (sender, listener):
                task.cancel()
            with suppress(Exception, asyncio.CancelledError):
                await asyncio.gather(sender, listener, return_exceptions=True)
            self._pages.discard(page)
            self._hear_wishes()

    async def _listen_forever(self, page):
        """Until the page goes, or says what no page would."""
        limit = RateLimit(MOST_WISHES)
        with suppress(WebSocketDisconnect, *NONSENSE):
            while limit.allows(page):
                await self._obey(page, json.loads(await page.socket.receive_text()))

    async def _obey(self, page, wish):
        """{"ack": n} answers updates; {"gap": s} asks for no two within so many seconds; {"watch":
        {"scans": [ids], "paths": [ids], "ways": [ids]}} asks for more, "ways": "all" for those of
        all robots."""
        if "ack" in wish:
            page.in_flight = max(0, page.in_flight - int(wish["ack"]))
        if "gap" in wish:
            page.gap = min(MOST_GAP, max(0.0, float(wish["gap"])))
        if "watch" in wish:
            page.scans = set(map(int, wish["watch"].get("scans", [])[:MOST_SCANS]))
            page.paths = set(map(int, wish["watch"].get("paths", [])))
            ways = wish["watch"].get("ways", [])
            page.ways, page.seen_ways = None if ways == "all" else set(map(int, ways)), None
            self._hear_wishes()
        async with self._turn:
            self._turn.notify_all()

    def _hear_wishes(self):
        scans = sorted(set().union(*(p.scans for p in self._pages)))[:MOST_SCANS]
        ways = any(p.ways is None or p.ways for p in self._pages)
        self._feed.want(any(p.paths for p in self._pages), ways, scans)

    async def _send_forever(self, page):
        with suppress(WebSocketDisconnect, RuntimeError):
            while True:
                if page.in_flight < IN_FLIGHT:
                    await self._send_news(page)
                    await asyncio.sleep(page.gap)
                async with self._turn:
                    await self._turn.wait()

    async def _send_news(self, page):
        model = self._model
        if model.revision and page.revision != model.revision:
            page.revision, page.tick = model.revision, -1
            await page.socket.send_text(model.scene_text())
        if page.revision and page.tick < model.changed_at:
            since, page.tick = page.tick, model.tick
            page.in_flight += 1
            await page.socket.send_bytes(model.update(since))
        await self._send_events(page)
        await self._send_fleet(page)
        await self._send_extras(page)
        if self._status and self._status != page.status:
            page.status = self._status
            await page.send_json(self._status)

    async def _send_events(self, page):
        events = self._journal.since(page.event, limit=200)
        if events:
            page.event = events[-1]["id"]
            await page.send_json({"type": "events", "events": events})

    async def _send_fleet(self, page):
        state = self._feed.coordinator
        if state is not page.coordinator:
            page.coordinator = state
            told = json.loads(self._tell_coordinator(state).json()) if state else None
            await page.send_json({"type": "fleet", "fleet": told})
        ways = self._feed["ways"] if page.ways is None or page.ways else None
        if ways and ways is not page.seen_ways:
            page.seen_ways = ways
            await page.socket.send_bytes(protocol.ways(ways, page.ways))

    async def _send_extras(self, page):
        for kiva_id in page.scans:
            scan = self._feed[f"scan{kiva_id}"]
            mount = mount_of(self._feed["frames"], f"kiva{kiva_id}/laser")
            if scan and mount and page.seen_scans.get(kiva_id) is not scan:
                page.seen_scans[kiva_id] = scan
                seen = (scan.angle_min, scan.angle_increment, scan.ranges)
                await page.socket.send_bytes(protocol.scan(kiva_id, mount, *seen))
        paths = paths_of(self._feed["paths"], page.paths) if page.paths else {}
        if paths != page.seen_paths:
            page.seen_paths = paths
            await page.send_json({"type": "paths", "paths": paths})


def mount_of(frames, name):
    """(x, y, z, yaw) of a frame on its parent in a TFMessage; None where none tells."""
    for stamped in frames.transforms if frames else ():
        if stamped.child_frame_id == name:
            at, turn = stamped.transform.translation, stamped.transform.rotation
            row = np.array([[at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]])
            return at.x, at.y, at.z, float(poses.yaw(row)[0])
    return None


def paths_of(message, wanted):
    """{kiva_id: [[x, y], …]} of the wanted robots in a FleetPaths, or of none in None."""
    out, at = {}, 0
    if message is None:
        return out
    for kiva_id, points in zip(message.kiva_id, message.points):
        if kiva_id in wanted:
            end = at + points
            xy = zip(message.x[at:end], message.y[at:end])
            out[kiva_id] = [[x, y] for x, y in xy if math.isfinite(x) and math.isfinite(y)]
        at += points
    return out
