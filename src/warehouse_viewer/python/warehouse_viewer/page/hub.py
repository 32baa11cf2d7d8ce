# SPDX-License-Identifier: Apache-2.0
"""Sends changes to every open page, each at the pace that it keeps up with.

Nothing is queued: a page that is ready gets everything that changed since its last update, once.
"""

from __future__ import annotations

import asyncio
import json
import math
import time
from collections.abc import Collection, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from starlette.websockets import WebSocket, WebSocketDisconnect

from warehouse_layout.floor import poses
from warehouse_msgs.msg import CoordinatorPaths
from warehouse_viewer.json_text import dumps
from warehouse_viewer.page import protocol
from warehouse_viewer.page.activities import wait_too_long
from warehouse_viewer.page.model import Model
from warehouse_viewer.page.source import Source
from warehouse_viewer.server.access import RateLimit

if TYPE_CHECKING:
    from tf2_msgs.msg import TFMessage

    from warehouse_msgs.msg import FleetPaths

GAP = 0.08  # least time between two updates [s, wall]
SCENE_GAP = 1.0  # least time between two scenes: many items make a megabyte [s, wall]
STATUS_GAP = 1.0  # between two requests for the simulation's own state [s, wall]
OFFERS_GAP = 5.0  # between two checks which services there are [s, wall]
IN_FLIGHT = 3  # updates that a page may leave unacknowledged
MOST_GAP = 5.0  # between two updates, whatever a page asks for [s, wall]
MOST_REQUESTS = 100  # of a page [1/s]
MALFORMED = (ValueError, TypeError, KeyError, AttributeError)  # what a bad request raises
MOST_NAME = 80  # characters of a robot's or station's name
MOST_SCANS = 20  # robots whose scans are shown at once, by all pages


class Page:
    """What one browser asks for, and what it has been sent.

    `socket` is accepted already; `last_event` is the id of the last event that it need not get.
    """

    def __init__(self, socket: WebSocket, last_event: int) -> None:
        self.socket, self.tick, self.event, self.in_flight = socket, -1, last_event, 0
        self.revision: int | None = None
        self.status: dict[str, Any] | None = None
        self.gap = 0.0  # that it asks for between two updates [s, wall]
        self.scans: set[int] = set()
        self.sent_scans: dict[int, Any] = {}
        self.sent_requested: list[int] | None = None
        self.paths: set[int] = set()
        self.sent_paths: dict[int, Any] = {}
        self.ways: set[int] | None = set()  # of these robots, None: of all
        self.sent_ways: CoordinatorPaths | None = None
        self.why = ""  # the robot or station of which it shows why it waits
        self.sent_why: dict[str, Any] | None = None
        self.coordinator = None  # the CoordinatorState that it was sent
        self.zones = None  # the ClosedZones that it was sent

    async def send_json(self, message: Mapping[str, Any]) -> None:
        """Sends a message as compact JSON."""
        await self.socket.send_text(dumps(message))


class Keeper(Protocol):
    """Keeps what was shown, whether a page is open or not."""

    def take(self) -> None:
        """Reads the model's present contents."""

    def gap(self, factor: float) -> float:
        """Returns how long it may wait for the next [s, wall], at a real-time factor."""


class Hub:
    """Serves every open page from a Source. Lives in an asyncio loop; any thread may notify().

    keeper: gets what the model shows after each update, even if no page is open.
    """

    def __init__(self, source: Source, model: Model, keeper: Keeper | None = None) -> None:
        self._keeper = keeper
        self._feed, self._model, self._journal = source.feed, model, source.journal
        self._simulation, self._source = source.simulation, source
        self._pages: set[Page] = set()
        self._turn, self._changed = asyncio.Condition(), asyncio.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._status: dict[str, Any] = {}
        self._offers: dict[str, str | None] = {}
        self._offers_due = 0.0
        self._scene_due = 0.0

    def notify(self) -> None:
        """Wakes the hub: the Source has something new."""
        with suppress(RuntimeError):  # the loop has ended
            if self._loop:
                self._loop.call_soon_threadsafe(self._changed.set)

    @property
    def pages(self) -> int:
        """How many pages are open."""
        return len(self._pages)

    # --- reading the source
    async def run(self) -> None:
        """Keeps the model up to date and wakes the pages' senders, until cancelled."""
        self._loop = asyncio.get_running_loop()
        watching = asyncio.create_task(self._watch_simulation())
        try:
            while True:
                with suppress(TimeoutError):
                    await asyncio.wait_for(self._changed.wait(), 0.5)
                self._changed.clear()
                self._refresh()
                async with self._turn:
                    self._turn.notify_all()
                await asyncio.sleep(self._gap)
        finally:
            watching.cancel()

    @property
    def _gap(self) -> float:
        """The duration between two updates [s, wall]."""
        if self._pages or not self._keeper:
            return GAP
        performance = self._feed["performance"]
        return self._keeper.gap(performance.real_time_factor if performance else 1.0)

    def _refresh(self) -> None:
        if self._pages or self._keeper:
            self._feed.subscribe()
        elif self._feed.unsubscribe_if_idle():
            return
        together = self._feed.objects_and_states
        if together is None or not self._feed.is_complete:
            return
        objects, states = together
        scenery = self._feed["scenery"]
        # What stands there changes ten times a second while a warehouse is built.
        if not self._model.is_same_scene(objects, scenery):
            if time.monotonic() < self._scene_due:
                return
            self._scene_due = time.monotonic() + SCENE_GAP
        waiting = wait_too_long(self._feed.coordinator)
        self._model.update(objects, states, self._feed["fleet"], scenery, waiting)
        if self._keeper:
            self._keeper.take()

    async def _watch_simulation(self) -> None:
        while True:
            if self._pages:
                self._status = await asyncio.to_thread(self._read_status)
                self._changed.set()
            await asyncio.sleep(STATUS_GAP)

    def _read_status(self) -> dict[str, Any]:
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
            "stopped": self._source.stopped(),
            **state,
        }

    # --- serving a page
    async def serve(self, socket: WebSocket) -> None:
        """Serves one page until it disconnects. The socket is accepted already."""
        self._feed.subscribe()
        page = Page(socket, max(0, self._journal.last_id - 200))
        self._pages.add(page)
        self._changed.set()
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
            self._update_subscriptions()

    async def _listen_forever(self, page: Page) -> None:
        """Reads requests until the page disconnects, or sends what no page would send."""
        limit = RateLimit(MOST_REQUESTS)
        with suppress(WebSocketDisconnect, *MALFORMED):
            while limit.allows(page):
                await self._handle(page, json.loads(await page.socket.receive_text()))

    async def _handle(self, page: Page, wish: Mapping[str, Any]) -> None:
        """Handles a page's request: {"ack": n} acknowledges updates, {"gap": s} sets the least time
        between two, and {"watch": {"scans": [ids], "paths": [ids], "ways": [ids], "why": name}}
        chooses whose extras to send, "ways": "all" those of every robot."""
        if "ack" in wish:
            page.in_flight = max(0, page.in_flight - int(wish["ack"]))
        if "gap" in wish:
            page.gap = min(MOST_GAP, max(0.0, float(wish["gap"])))
        if "watch" in wish:
            page.scans = set(map(int, wish["watch"].get("scans", [])[:MOST_SCANS]))
            page.paths = set(map(int, wish["watch"].get("paths", [])))
            ways = wish["watch"].get("ways", [])
            page.ways, page.sent_ways = None if ways == "all" else set(map(int, ways)), None
            page.why, page.sent_why = str(wish["watch"].get("why", ""))[:MOST_NAME], None
            self._update_subscriptions()
        async with self._turn:
            self._turn.notify_all()

    def _update_subscriptions(self) -> None:
        scans = sorted(set().union(*(p.scans for p in self._pages)))[:MOST_SCANS]
        ways = any(p.ways is None or p.ways for p in self._pages)
        self._feed.subscribe_extras(any(p.paths for p in self._pages), ways, scans)

    async def _send_forever(self, page: Page) -> None:
        with suppress(WebSocketDisconnect, RuntimeError):
            while True:
                if page.in_flight < IN_FLIGHT:
                    await self._send_changes(page)
                    await asyncio.sleep(page.gap)
                async with self._turn:
                    await self._turn.wait()

    async def _send_changes(self, page: Page) -> None:
        model = self._model
        if model.revision and page.revision != model.revision:
            page.revision, page.tick = model.revision, -1
            await page.socket.send_text(model.scene_text())
        if page.revision and page.tick < model.changed_at:
            since, page.tick = page.tick, model.tick
            page.in_flight += 1
            await page.socket.send_bytes(model.encode_update(since))
        await self._send_events(page)
        await self._send_fleet(page)
        await self._send_zones(page)
        await self._send_extras(page)
        await self._send_why(page)
        if self._status and self._status != page.status:
            page.status = self._status
            await page.send_json(self._status)

    async def _send_events(self, page: Page) -> None:
        events = self._journal.since(page.event, limit=200)
        if events:
            page.event = events[-1]["id"]
            await page.send_json({"type": "events", "events": events})

    async def _send_fleet(self, page: Page) -> None:
        state = self._feed.coordinator
        if state is not page.coordinator:
            page.coordinator = state
            describe = self._source.describe_coordinator
            fleet = describe(state) if state and describe else None
            await page.send_json({"type": "fleet", "fleet": fleet})
        ways = self._feed["ways"] if page.ways is None or page.ways else None
        if ways and ways is not page.sent_ways:
            page.sent_ways = ways
            await page.socket.send_bytes(protocol.ways(ways, page.ways))

    async def _send_zones(self, page: Page) -> None:
        describe = self._source.describe_zones
        zones = self._feed["zones"] if describe and self._feed.coordinator else None
        if describe and zones is not page.zones:
            page.zones = zones
            await page.send_json({"type": "zones"} | describe(zones))

    async def _send_why(self, page: Page) -> None:
        explain = self._source.explain
        why = explain(page.why) if explain and page.why else None
        if why != page.sent_why:
            page.sent_why = why
            await page.send_json({"type": "why", "why": why})

    async def _send_extras(self, page: Page) -> None:
        for kiva_id in page.scans:
            scan = self._feed[f"scan{kiva_id}"]
            mount = mount_of(self._feed["frames"], f"kiva{kiva_id}/laser")
            if scan and mount and page.sent_scans.get(kiva_id) is not scan:
                page.sent_scans[kiva_id] = scan
                rays = (scan.angle_min, scan.angle_increment, scan.ranges)
                await page.socket.send_bytes(protocol.scan(kiva_id, mount, *rays))
        requested = self._feed["requested"]
        if requested is not None and requested != page.sent_requested:
            page.sent_requested = requested
            await page.send_json({"type": "requested", "units": requested})
        paths = paths_of(self._feed["paths"], page.paths) if page.paths else {}
        if paths != page.sent_paths:
            page.sent_paths = paths
            await page.send_json({"type": "paths", "paths": paths})


def mount_of(frames: TFMessage | None, name: str) -> tuple[float, float, float, float] | None:
    """Returns (x, y, z [m], yaw [rad]) of a frame on its parent in a TFMessage; None if unknown."""
    for stamped in frames.transforms if frames else ():
        if stamped.child_frame_id == name:
            at, turn = stamped.transform.translation, stamped.transform.rotation
            row = np.array([[at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]])
            return at.x, at.y, at.z, float(poses.yaw(row)[0])
    return None


def paths_of(message: FleetPaths | None, robots: Collection[int]) -> dict[int, list[list[float]]]:
    """Returns {kiva_id: [[x, y], …]} [m] of the wanted robots in a FleetPaths or None."""
    out: dict[int, list[list[float]]] = {}
    at = 0
    if message is None:
        return out
    for kiva_id, points in zip(message.kiva_id, message.points):
        if kiva_id in robots:
            end = at + points
            xy = zip(message.x[at:end], message.y[at:end])
            out[kiva_id] = [[x, y] for x, y in xy if math.isfinite(x) and math.isfinite(y)]
        at += points
    return out
