# SPDX-License-Identifier: Apache-2.0
"""Notes twice a second what the warehouse does, whether or not a page is open."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_viewer.api.change_book import ChangeBook
from warehouse_viewer.page.activities import Activity, activity, wait_too_long
from warehouse_viewer.page.journal import ALARM, ALARM_OVER, Journal
from warehouse_viewer.watch import causes, troubles
from warehouse_viewer.watch.alarm_book import AlarmBook, Trouble
from warehouse_viewer.watch.alarm_file import AlarmFile
from warehouse_viewer.watch.figures import Figures
from warehouse_viewer.watch.reasons import Reasons
from warehouse_viewer.watch.span_log import SpanLog
from warehouse_viewer.watch.station_watch import StationWatch
from warehouse_viewer.watch.zone_log import ZoneLog, held_units

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorState, FleetState, StationState
    from warehouse_viewer.ros.emergency_stop import EmergencyStop
    from warehouse_viewer.ros.feed import Feed
    from warehouse_viewer.ros.shift_feed import ShiftFeed

PERIOD = 0.5  # between two looks [s, wall]
LOG = logging.getLogger(__name__)


class Monitor:
    """Reads what the feeds hear into spans, alarms, stations and figures. Lives in an asyncio loop.

    `feed` is a ros.feed.Feed, `shift` a ShiftFeed; what changes is noted in a ChangeBook under
    `alarms` and `figures`. assigned(): the unit and the station of each robot with a transport.
    kept: where the alarms outlast this process; None: nowhere. stop: the fleet's emergency stop;
    tell(event, alarm) hears of each alarm's `begin` and `end`.
    """

    def __init__(
        self,
        feed: Feed,
        shift: ShiftFeed,
        journal: Journal,
        book: ChangeBook,
        assigned: Callable[[], Mapping[int, tuple[int, str]]] = dict,
        kept: AlarmFile | None = None,
        stop: EmergencyStop | None = None,
        tell: Callable[[str, Mapping[str, Any]], None] = lambda event, alarm: None,
    ) -> None:
        self._stop, self._tell = stop, tell
        self._feed, self._shift, self._journal, self._book = feed, shift, journal, book
        self._assigned, self._kept, self._written = assigned, kept, 0
        self.spans, self.alarms = SpanLog(), AlarmBook(self._remedies)
        self.reasons = Reasons()
        self.stations, self._figures = StationWatch(), Figures()
        self._moments = troubles.Moments()
        self._zone_log = ZoneLog()
        self._event = journal.last_id
        self._noted: dict[str, Any] = {}
        self._read: dict[str, Any] = {}  # the messages that were taken in last
        self.now = 0.0

    async def run(self) -> None:
        """Looks until it is cancelled."""
        self._feed.keep()
        self._restore()
        while True:
            try:
                self.look()
            except (ValueError, AttributeError, IndexError):
                LOG.exception("the warehouse's messages can't be read")
            await self._keep()
            await asyncio.sleep(PERIOD)

    def _restore(self) -> None:
        try:
            if self._kept and (state := self._kept.read()):
                self.alarms.restore(state)
        except (OSError, ValueError, KeyError, TypeError) as error:
            LOG.warning("the alarms of before can't be read: %s", error)

    async def _keep(self) -> None:
        """Writes what has changed of the alarms."""
        if not self._kept or self.alarms.changes == self._written:
            return
        self._written = self.alarms.changes
        try:
            await asyncio.to_thread(self._kept.write, self.alarms.state())
        except OSError as error:
            LOG.warning("the alarms can't be kept: %s", error)
            self._kept = None

    def look(self) -> None:
        """Processes the messages since the last call."""
        fleet, stations = self._feed["fleet"], self._shift["stations"]
        if fleet is None and stations is None:
            return
        stamps = [fleet.stamp] if fleet else []
        stamps += [stations.header.stamp] if stations else []
        self.now = max(stamp.to_sec() for stamp in stamps)
        if self._stop:
            self._stop.keep(fleet)
        rows = stations.stations if stations else ()
        if stations is not self._read.get("stations") or fleet is not self._read.get("fleet"):
            self._read |= {"stations": stations, "fleet": fleet}
            self._journal.expect(len(fleet.kiva_id) if fleet else 0)
            self.stations.update(self.now, rows, fleet)
            self._note_spans(fleet, rows)
        starved = self.stations.starved
        self.reasons.update(
            self.now,
            fleet,
            self._feed.coordinator,
            rows,
            starved,
            self._assigned(),
            held_units(self._feed.zones),
        )
        self._note_zones()
        self._note_alarms(fleet, rows)
        self._note_figures()

    def _note_spans(self, fleet: FleetState, stations: Collection[Any]) -> None:
        if fleet is not None:
            names = [f"kiva{number}" for number in fleet.kiva_id]
            waiting = wait_too_long(self._feed.coordinator)
            does = activity(fleet, waiting)
            self.spans.update(self.now, "robot", names, does)
            self._noted["available"] = _available(does, self._feed.coordinator)
        if stations:
            names = [station.name for station in stations]
            self.spans.update(self.now, "station", names, self.stations.states(stations))

    def _note_zones(self) -> None:
        """Adds what has happened to closed zones to the events."""
        message = self._feed["zones"]
        if message is None or message is self._read.get("zones"):
            return
        self._read["zones"] = message
        for row in self._zone_log.news(message):
            self._journal.add(row)

    def _note_alarms(self, fleet: FleetState, stations: Collection[Any]) -> None:
        for event in self._journal.since(self._event):
            self._event = event["id"]
            self._moments.take_event(event)
        pending = self._troubles(fleet, stations)
        self.alarms.update(self.now, causes.by_cause(pending, self.reasons, self.now))
        self._note("alarms", self.alarms.as_json())
        begun, ended = self.alarms.news()
        for alarm in begun:
            self._report(ALARM, alarm, alarm["text"])
            self._tell("begin", alarm)
        for alarm in ended:
            text = f"{alarm['cause']}, for {causes.span(alarm['duration'])}"
            self._report(ALARM_OVER, alarm, text)
            self._tell("end", alarm)

    def _report(self, kind: str, alarm: Mapping[str, Any], text: str) -> None:
        """Adds the begin or the end of an alarm to the events."""
        # What concerns no thing has its sentence in place of a name.
        subject = "" if alarm["subject"] == alarm["cause"] else alarm["subject"]
        row = {"kind": kind, "model": subject, "text": text, "command": 0, "other": ""}
        self._journal.add(row | {"time": round(self.now, 3)})

    def _troubles(self, fleet: FleetState, stations: Collection[Any]) -> list[Trouble]:
        pending: list[Trouble] = []
        state = self._feed.coordinator
        if fleet is not None:
            pending += troubles.of_fleet(fleet)
        if state:
            is_felt = bool(self._stop and self._stop.is_felt)
            self._moments.take_watchdog(state.watchdog, self.now, is_felt)
            pending += _without(troubles.of_coordinator(state), bool(stations))
        elif stations:
            text = "a shift runs without a coordinator: what robots do is unknown"
            pending.append(Trouble("NO_COORDINATOR", "coordinator", text))
        pending += troubles.of_stations(stations, self.now, self.stations.starved)
        pending += self._moments.lasting(self.now)
        pending += troubles.of_forecast(self._shift.forecast, self.now)
        notices = self._shift["notices"]
        pending += troubles.of_notices(notices.notices if notices else ())
        return troubles.of_stop(self._stop, pending) if self._stop else pending

    def _remedies(self, trouble: Trouble) -> list[causes.Remedy]:
        state = self._feed.coordinator
        modes = {f"kiva{n}": "MANUAL" for n in state.manual_kiva} if state else {}
        modes |= {f"kiva{n}": "OUT_OF_SERVICE" for n in state.out_of_service_kiva} if state else {}
        return causes.remedies(trouble, modes)

    def note(self, subject: str, by: str, what: str) -> None:
        """Notes what a person did about a robot, item or station; see AlarmBook.note."""
        self.alarms.note(subject, by, what)
        self._note("alarms", self.alarms.as_json())

    def see(self, number: int, by: str) -> dict[str, Any] | None:
        """Notes that a person has seen an alarm; see AlarmBook.see."""
        alarm = self.alarms.see(number, by)
        self._note("alarms", self.alarms.as_json())
        return alarm

    def _note_figures(self) -> None:
        kpis, throughput = self._shift["kpis"], self._shift["throughput"]
        if not (kpis and throughput) or throughput is self._read.get("throughput"):
            return
        self._read["throughput"] = throughput
        available, robots = self._noted.get("available", (1.0, 0))
        self._figures.update(self.now, kpis, available)
        self._note("figures", self._figures.as_json(kpis, throughput, available, robots))

    def _note(self, topic: str, row: object) -> None:
        """Notes the newest row of a topic, if it differs from the last."""
        if self._noted.get(topic) != row:
            self._noted[topic] = row
            self._book.note(topic, topic, row)

    def figures(self) -> dict[str, Any] | None:
        """Returns the four figures as JSON; None before the first of a shift."""
        return self._noted.get("figures")

    def station(self, station: StationState) -> dict[str, Any]:
        """Returns what JSON has of a StationState beside its own fields."""
        reason = self.reasons.station(station.name)
        return self.stations.as_json(station) | {"why": reason.text if reason else ""}


def _available(does: np.ndarray, coordinator: CoordinatorState | None) -> tuple[float, int]:
    """Returns the share of robots that can work, and how many robots there are."""
    away = coordinator.out_of_service + coordinator.manual if coordinator else 0
    helpless = int((does == Activity.NEEDS_HELP).sum())
    return max(0.0, 1 - (helpless + away) / max(len(does), 1)), len(does)


def _without(pending: Iterable[Trouble], has_stations: bool) -> list[Trouble]:
    """Leaves out what stations report themselves, more exactly."""
    return [
        trouble
        for trouble in pending
        if not (has_stations and trouble.kind == "STATION_UNATTENDED")
    ]
