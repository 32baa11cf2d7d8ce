# SPDX-License-Identifier: Apache-2.0
"""Reads what is wrong from the messages of robots, coordinator, stations and shift."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_client.message_names import failures_of
from warehouse_layout.message_enums import EventKind
from warehouse_operations.reports.limits import clock
from warehouse_viewer.watch.alarm_book import Trouble

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorState, FleetState, ForecastResult
    from warehouse_viewer.ros.emergency_stop import EmergencyStop

UNATTENDED = 60.0  # that a station waits for a person [s, simulated]
STARVED = 180.0  # that a station with orders waits for a storage unit [s, simulated]
HELD_UP = 120.0  # that a robot waits [s, simulated]
QUEUED = 600.0  # the same in the queue of a station, where waiting is as it should be
FORECAST = 1800.0  # for which a forecast counts at most [s, simulated]
LASTING = 600.0  # for which a momentary trouble is shown [s, simulated]

BROKEN = "ROBOT_BROKEN"

# Kinds by patterns of the coordinator's sentences; the first group is whom they concern.
SENTENCES = (
    (re.compile(r"(kiva\d+): "), BROKEN),
    (re.compile(r"(kiva\d+) does not move(?:: |$)"), "ROBOT_STALLED"),
    (re.compile(r"(kiva\d+) (?:was pushed|is off the floor)"), "ROBOT_LOST"),
    (re.compile(r"(.+) has waited for a person for "), "STATION_UNATTENDED"),
    (re.compile(r"(.+) lies on the floor, off "), "ITEM_FALLEN"),
    (re.compile(r"(.+) stands (?:in a street|across cells|in the way) at "), "OBSTACLE"),
    (re.compile(r"(a plan was refused): "), "PLAN_REFUSED"),
)
MOMENTS = {EventKind.COLLISION.name: "COLLISION", EventKind.TIPPED.name: "UNIT_TIPPED"}


def of_coordinator(state: CoordinatorState) -> Iterator[Trouble]:
    """Yields the alarms of a CoordinatorState, and the robots that wait for long."""
    for text in state.alarms:
        yield of_sentence(text)
    now = state.header.stamp.to_sec()
    waits = zip(state.waiting_kiva, state.waiting_since, state.waiting_text)
    for robot, since, why in waits:
        text = f"kiva{robot} waits {why}"
        if now - since >= patience(text):
            yield Trouble("ROBOT_WAITS", f"kiva{robot}", text, since)


def patience(text: str) -> float:
    """Returns how long a robot may wait as a sentence says [s]."""
    return QUEUED if " waits in the queue of " in text else HELD_UP


def _parted(text: str) -> tuple[str, str]:
    name, _, rest = text.partition(": ")
    return name, rest


def _broken(name: str, failures: str) -> str:
    failures = failures.replace("drive without torque", "drive")  # the word of pages and API
    return f"{name} is broken ({failures})"


def of_sentence(text: str) -> Trouble:
    """Returns what a sentence of the coordinator's alarms means."""
    for pattern, kind in SENTENCES:
        if match := pattern.match(text):
            return Trouble(kind, match[1], _broken(*_parted(text)) if kind == BROKEN else text)
    return Trouble("COORDINATOR", text, text)


def of_fleet(fleet: FleetState) -> Iterator[Trouble]:
    """Yields the robots of a FleetState that need help."""
    failures = np.frombuffer(bytes(fleet.failures), np.uint8)
    for i in np.flatnonzero(failures):
        name = f"kiva{fleet.kiva_id[i]}"
        yield Trouble(BROKEN, name, _broken(name, ", ".join(failures_of(failures[i]))))
    blocked = np.frombuffer(bytes(fleet.last_end), np.uint8) == EventKind.BLOCKED
    for i in np.flatnonzero(blocked & (failures == 0)):
        name = f"kiva{fleet.kiva_id[i]}"
        yield Trouble("ROBOT_BLOCKED", name, f"{name} stands before an obstacle")


# Kinds that follow from a stop of the whole fleet.
OF_A_STOP = ("ROBOT_WAITS", "ROBOT_STALLED", "WATCHDOG", "STATION_STARVED")


def of_stop(stop: EmergencyStop, pending: list[Trouble]) -> list[Trouble]:
    """Returns the alarms where an emergency stop may hold; what follows from it is left out."""
    if stop.is_felt:
        pending = [trouble for trouble in pending if trouble.kind not in OF_A_STOP]
    hold = stop.hold
    if hold is None:
        return pending
    who = f"{hold.by} has stopped" if hold.by else "a client has stopped"
    text = f"{who} all robots"
    return [Trouble("EMERGENCY_STOP", "fleet", text, hold.since), *pending]


def of_stations(
    stations: Iterable[Any], now: float, starved: dict[str, float]
) -> Iterator[Trouble]:
    """Yields the stations, as StationState, that wait for a person or for storage units; `starved`
    has since when [s] each has had orders and no unit."""
    for station in stations:
        if station.waiting >= UNATTENDED:
            what = "confirm a pick" if station.kind == "PICK" else "put new stock in"
            text = f"unit {station.shelf_id} is at {station.name}: a person has to {what}"
            yield Trouble("STATION_UNATTENDED", station.name, text, now - station.waiting)
        since = starved.get(station.name, now)
        if now - since >= STARVED:
            coming = (
                f"{len(station.inbound)} on their way" if station.inbound else "none is on its way"
            )
            text = f"{station.name} works at {len(station.orders)} orders and has no unit; {coming}"
            yield Trouble("STATION_STARVED", station.name, text, since)


def of_notices(notices: Iterable[str]) -> Iterator[Trouble]:
    """Yields a shift's notices."""
    for text in notices:
        yield Trouble("NOTICE", text, text)


def of_forecast(forecast: ForecastResult | None, now: float) -> Iterator[Trouble]:
    """Yields the alarm that orders will be late, by the newest forecast of the shift as it is."""
    if forecast is None or not forecast.runs or forecast.changes:
        return
    begin, length = forecast.made_at, 60 * forecast.minutes
    if not begin <= now < begin + min(length, FORECAST):
        return
    bands = (forecast.late_p10, forecast.late_p50, forecast.late_p90)
    least, likely, most = (max(0, round(band[-1] - band[0])) for band in bands)
    if likely:
        orders = "1 order" if likely == 1 else f"{likely} orders"
        text = f"{orders} ({least} to {most}) will become late by {clock(begin + length)}"
        yield Trouble("ORDERS_WILL_BE_LATE", "orders", f"{text}, by a forecast", begin)


class Moments:
    """Momentary troubles, each shown for LASTING seconds after its last occurrence."""

    def __init__(self) -> None:
        self._kept: dict[tuple[str, str], tuple[Trouble, float, int]] = {}
        self._watchdog: int | None = None

    def add(self, trouble: Trouble, now: float) -> None:
        """Adds one, or counts it again."""
        key = trouble.kind, trouble.subject
        _, _, times = self._kept.get(key, (trouble, now, 0))
        self._kept[key] = trouble._replace(since=now), now, times + 1

    def take_event(self, event: dict[str, Any]) -> None:
        """Adds an event of the journal if it is one of MOMENTS."""
        kind = MOMENTS.get(event["kind"])
        if kind:
            self.add(
                Trouble(kind, event["model"], f"{event['model']}: {event['text']}"), event["time"]
            )

    def take_watchdog(self, count: int, now: float, is_expected: bool = False) -> None:
        """Adds what a CoordinatorState's count of its watchdog has grown by, unless a stop explains
        it."""
        if self._watchdog is not None and count > self._watchdog and not is_expected:
            text = "a robot made no progress for 30 s, which nothing explains"
            self.add(Trouble("WATCHDOG", "watchdog", text), now)
        self._watchdog = count

    def lasting(self, now: float) -> list[Trouble]:
        """Returns those that still count at `now` [s]."""
        self._kept = {key: kept for key, kept in self._kept.items() if 0 <= now - kept[1] < LASTING}
        return [_counted(trouble, times) for trouble, _, times in self._kept.values()]


def _counted(trouble: Trouble, times: int) -> Trouble:
    return trouble if times == 1 else trouble._replace(text=f"{trouble.text} ({times} times)")
