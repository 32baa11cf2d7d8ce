# SPDX-License-Identifier: Apache-2.0
"""What stations do at a glance, what each waits for, and for how long."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_viewer.page.activities import QUEUED_TOO_LONG, Activity
from warehouse_viewer.watch.troubles import UNATTENDED

if TYPE_CHECKING:
    from warehouse_msgs.msg import FleetState, StationState

QUARTER = 900.0  # over which pieces per hour are averaged [s, simulated]
SAMPLES = 30.0  # between two counts of pieces [s, simulated]
UNIT_TOO_LONG = 60.0  # for a station with orders to be without a unit [s, simulated]
STANDS = 1e-3  # a robot below these speeds stands still [m/s, rad/s]


@dataclass
class _Past:
    """What is remembered of a station; times are simulated [s]."""

    state: Activity = Activity.RESTING
    since: float = 0.0
    unit: int = 0
    unit_since: float = 0.0
    pieces: deque[tuple[float, int]] = field(default_factory=deque)


def needs_units(station: StationState) -> bool:
    """Whether a StationState has work and no storage unit."""
    return station.open and not station.shelf_id and bool(station.orders)


def state_of(station: StationState, starved: float) -> Activity:
    """Returns what a StationState does, which has been without a unit for `starved` [s]."""
    if station.shelf_id:
        return Activity.NEEDS_HELP if station.waiting >= UNATTENDED else Activity.WORKING
    if needs_units(station) and starved >= UNIT_TOO_LONG:
        return Activity.WAITING
    return Activity.MOVING if station.open and station.inbound else Activity.RESTING


class StationWatch:
    """Remembers what stations and robots did. One thread at a time."""

    def __init__(self) -> None:
        self._past: dict[str, _Past] = {}
        self.starved: dict[str, float] = {}  # since when a station has been without a unit [s]
        self._carriers: dict[int, tuple[int, float]] = {}
        self._still: dict[int, float] = {}
        self.now = 0.0

    def update(self, now: float, stations: Iterable[Any], fleet: FleetState) -> None:
        """Updates from the StationState of all stations and a FleetState, or None, at `now` [s]."""
        if now < self.now:
            self._past, self.starved, self._still = {}, {}, {}
        self.now = now
        for station in stations:
            self._take(station, now)
        if fleet is not None:
            self._take_robots(fleet, now)

    def _take(self, station: StationState, now: float) -> None:
        past = self._past.setdefault(station.name, _Past(since=now))
        if needs_units(station):
            self.starved.setdefault(station.name, now)
        else:
            self.starved.pop(station.name, None)
        state = state_of(station, now - self.starved.get(station.name, now))
        if state != past.state:
            past.state, past.since = state, now
        if station.shelf_id != past.unit:
            past.unit, past.unit_since = station.shelf_id, now
        if not past.pieces or now - past.pieces[-1][0] >= SAMPLES:
            past.pieces.append((now, station.pieces))
        while now - past.pieces[0][0] > QUARTER:
            past.pieces.popleft()

    def _take_robots(self, fleet: FleetState, now: float) -> None:
        speeds = np.abs([fleet.vx, fleet.vy, fleet.yaw_rate]).max(axis=0, initial=0)
        ids, units = np.asarray(fleet.kiva_id).tolist(), np.asarray(fleet.shelf_id).tolist()
        still = (speeds < STANDS).tolist()
        before = self._still
        self._still = {n: before.get(n, now) for n, stands in zip(ids, still) if stands}
        self._carriers = {unit: (n, self._still.get(n, now)) for n, unit in zip(ids, units) if unit}

    def states(self, stations: Iterable[Any]) -> np.ndarray:
        """Returns the Activity of each station, (n,) uint8."""
        return np.array([self._past[station.name].state for station in stations], np.uint8)

    def as_json(self, station: StationState) -> dict[str, Any]:
        """Returns what JSON has of a StationState beside the message's own fields."""
        past = self._past.get(station.name) or _Past(since=self.now)
        since = self.starved.get(station.name, past.since)
        return {
            "activity": Activity(past.state).name,
            "since": past.unit_since if station.shelf_id else since,
            "pieces_per_hour": self._rate(past, station.pieces),
            "queue": self._queue(station),
        }

    def _rate(self, past: _Past, pieces: int) -> float:
        if not past.pieces:
            return 0.0
        since, before = past.pieces[0]
        elapsed = max(self.now - since, SAMPLES)
        return round(3600 * max(0, pieces - before) / elapsed, 1)

    def _queue(self, station: StationState) -> list[dict[str, Any]]:
        """Returns the units that come; a robot stands for too long from QUEUED_TOO_LONG for each
        unit before its own on."""
        out, before = [], int(station.shelf_id != 0)
        for unit in station.inbound:
            robot, since = self._carriers.get(unit, (0, self.now))
            stands = round(self.now - since, 1)
            is_long = stands >= QUEUED_TOO_LONG * max(1, before)
            out.append({"unit": unit, "robot": robot, "stands": stands, "is_long": is_long})
            before += int(robot != 0)
        return out
