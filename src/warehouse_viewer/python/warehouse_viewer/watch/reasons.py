# SPDX-License-Identifier: Apache-2.0
"""Why robots and stations wait, where each robot goes, and for which order: one sentence for each,
the same on all pages, in alarms, events and the API."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_client.message_names import failures_of
from warehouse_layout.message_enums import EventKind
from warehouse_viewer.page.activities import FAULTY
from warehouse_viewer.watch.sentence_log import SentenceLog

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorState, FleetState, StationState

DOES = {
    "idle": "has no work",
    "ready": "stands beneath its unit until its station has room",
    "waiting": "stands at its goal",
    "manual": "is manual: a person commands it",
    "out_of_service": "is out of service",
}
MOVES = ("fetching", "lifting", "bringing", "storing", "dropping")
UNDER_WAY = [f"is {work}" for work in MOVES]


@dataclass(frozen=True)
class Reason:
    """Why a robot or station waits, or what it does; times are simulated [s].

    text: the sentence without its subject. errand: where a robot goes, for which unit and order.
    behind: the robot directly ahead. cause: the robot or station that the wait comes from, itself
    if it is at fault; empty where nothing is wrong.
    """

    name: str
    text: str
    since: float
    errand: str = ""
    station: str = ""
    unit: int = 0
    order: int = 0
    behind: str = ""
    cause: str = ""

    @property
    def sentence(self) -> str:
        """The whole sentence: what it waits for, and where it goes."""
        is_under_way = self.errand and self.text in UNDER_WAY
        parts = (self.errand,) if is_under_way else (self.text, self.errand)
        return f"{self.name} " + "; ".join(part for part in parts if part)

    def as_json(self) -> dict[str, Any]:
        """Returns the reason as JSON."""
        return {
            "name": self.name,
            "text": self.text,
            "sentence": self.sentence,
            "since": round(self.since, 1),
            "errand": self.errand,
            "station": self.station,
            "storage_unit": f"storage_unit{self.unit}" if self.unit else "",
            "order": self.order,
            "behind": self.behind,
            "cause": self.cause,
        }


class Reasons:
    """The reasons of all robots and stations now, and what they were. One thread at a time."""

    def __init__(self) -> None:
        self._now, self._past = 0.0, SentenceLog()
        self._waits: dict[int, tuple[int, float, str]] = {}  # robot ahead, since, why
        self._doing: dict[int, str] = {}
        self._faults: dict[int, str] = {}
        self._explained: dict[str, float] = {}  # until when a fault explained that one waits
        self._loads: dict[int, int] = {}  # unit by robot
        self._carriers: dict[int, int] = {}
        self._errands: dict[int, tuple[int, str, int]] = {}  # unit, station, order by robot
        self._stations: dict[str, StationState] = {}
        self._starved: Mapping[str, float] = {}
        self._held: Mapping[int, str] = {}
        self._robots: frozenset[int] = frozenset()

    def update(
        self,
        now: float,
        fleet: FleetState | None,
        coordinator: CoordinatorState | None,
        stations: Iterable[StationState],
        starved: Mapping[str, float],
        assigned: Mapping[int, tuple[int, str]],
        held: Mapping[int, str] = MappingProxyType({}),
    ) -> None:
        """Updates from the messages at `now` [s]. `starved`: since when stations with orders have
        had no unit; `assigned`: the unit and the station of each robot with a transport;
        `held`: why units wait for a closed zone."""
        if now < self._now:
            self._past, self._explained = SentenceLog(), {}
        self._now, self._starved, self._held = now, starved, held
        self._stations = {station.name: station for station in stations}
        self._take_fleet(fleet)
        self._take_coordinator(coordinator)
        self._take_errands(assigned)
        self._remember()
        self._explain()

    def _take_fleet(self, fleet: FleetState | None) -> None:
        self._faults, self._loads, self._robots = {}, {}, frozenset()
        if fleet is None:
            return
        ids = np.asarray(fleet.kiva_id).tolist()
        self._robots = frozenset(ids)
        failures = np.frombuffer(bytes(fleet.failures), np.uint8)
        ends = np.frombuffer(bytes(fleet.last_end), np.uint8)
        for i in np.flatnonzero(ends == EventKind.BLOCKED).tolist():
            self._faults[ids[i]] = "stopped before an obstacle"
        for i in np.flatnonzero(failures).tolist():
            self._faults[ids[i]] = f"broken ({', '.join(failures_of(failures[i]))})"
        units = np.asarray(fleet.shelf_id).tolist()
        self._loads = {robot: unit for robot, unit in zip(ids, units) if unit}
        self._carriers = {unit: robot for robot, unit in self._loads.items()}

    def _take_coordinator(self, state: CoordinatorState | None) -> None:
        self._waits, self._doing = {}, {}
        if state is None:
            return
        self._doing = dict(zip(state.doing_kiva, state.doing))
        rows = zip(state.waiting_kiva, state.waiting_for, state.waiting_since, state.waiting_text)
        self._waits = {robot: (ahead, since, text) for robot, ahead, since, text in rows}
        for robot in state.manual_kiva:
            self._faults.setdefault(robot, "manual")
        for robot in state.out_of_service_kiva:
            self._faults.setdefault(robot, "out of service")

    def _take_errands(self, assigned: Mapping[int, tuple[int, str]]) -> None:
        orders: dict[int, tuple[str, int]] = {}
        for name, station in self._stations.items():
            brought = list(station.inbound_orders) or [0] * len(station.inbound)
            orders |= {unit: (name, order) for unit, order in zip(station.inbound, brought)}
            if station.shelf_id:
                served = [pick.order_id for pick in station.picks if pick.order_id]
                orders[station.shelf_id] = name, served[0] if served else 0
        self._errands = {}
        for robot in self._robots & (assigned.keys() | self._loads.keys()):
            unit, name = assigned.get(robot, (0, ""))
            unit = self._loads.get(robot, unit)
            station, order = orders.get(unit, (name, 0))
            # A unit on its way back goes to no station.
            if self._doing.get(robot) not in ("storing", "dropping"):
                self._errands[robot] = unit, station, order

    def root(self, robot: int) -> int:
        """Returns the robot at which the chain of waiting robots ends: the first at fault, or that
        waits for none; itself if it is one."""
        passed = {robot}
        while not self.fault(robot) and (ahead := self._waits.get(robot, (0,))[0]):
            if ahead in passed:
                return min(passed)  # all robots of a ring have the same root
            passed.add(ahead)
            robot = ahead
        return robot

    def fault(self, robot: int) -> str:
        """Returns why a robot can't drive autonomously, as "broken (drive)"; else empty."""
        return self._faults.get(robot, "")

    def works(self, robot: int) -> bool:
        """Returns whether a robot drives autonomously and waits for nothing."""
        return robot not in self._waits and not self.fault(robot)

    def explained(self, name: str) -> float:
        """Returns until when a robot at fault explained that a robot or station waits [s]; 0: it
        never did."""
        return self._explained.get(name, 0.0)

    def _explain(self) -> None:
        """Notes whom robots at fault hold up."""
        behind = {robot for robot in self._waits if self.fault(self.root(robot))}
        names = [f"kiva{robot}" for robot in self._faults.keys() | behind]
        names += [station for rows in self.stuck().values() for station, _, _ in rows]
        self._explained |= dict.fromkeys(names, self._now)

    def waiting(self) -> dict[int, list[int]]:
        """Returns the robots that wait for each root, the longest wait first."""
        behind = defaultdict(list)
        for robot in sorted(self._waits, key=lambda robot: self._waits[robot][1]):
            if (root := self.root(robot)) != robot:
                behind[root].append(robot)
        return dict(behind)

    def stuck(self) -> dict[int, list[tuple[str, int, float]]]:
        """Returns the stations that stand still for each root at fault, as (station, unit, since
        when [s])."""
        out = defaultdict(list)
        for name, since in self._starved.items():
            for unit in self._stations[name].inbound if name in self._stations else ():
                robot = self._carriers.get(unit, 0)
                root = self.root(robot)
                if robot and self.fault(root):
                    out[root].append((name, unit, since))
                    break
        return dict(out)

    def robot(self, robot: int) -> Reason:
        """Returns why a robot waits, or what it does."""
        name = f"kiva{robot}"
        unit, station, order = self._errands.get(robot, (0, "", 0))
        about: dict[str, Any] = {
            "unit": unit,
            "station": station,
            "order": order,
            "errand": self._errand(robot),
        }
        ahead, since, why = self._waits.get(robot, (0, self._now, ""))
        fault = self.fault(robot)
        if fault:
            text = f"is {fault}"
            return Reason(name, text, self._since(name, text), cause=name, **about)
        if why:
            root = self.root(robot)
            cause = f"kiva{root}" if FAULTY in why or self.fault(root) else ""
            behind = f"kiva{ahead}" if ahead else ""
            return Reason(name, f"waits {why}", since, behind=behind, cause=cause, **about)
        text = DOES.get(self._doing.get(robot, ""), "")
        if station and self._doing.get(robot) == "waiting":
            of_order = f" for order {order}" if order else ""
            text = f"stands at {station} with unit {unit}{of_order}"
            about["errand"] = ""
        if not text:
            text = (
                f"is {self._doing[robot]}" if self._doing.get(robot) in MOVES else "does its work"
            )
        return Reason(name, text, self._since(name, text), **about)

    def _errand(self, robot: int) -> str:
        unit, station, order = self._errands.get(robot, (0, "", 0))
        if not unit or not station:
            return ""
        verb = "brings" if robot in self._loads else "fetches"
        ending = f" for order {order}" if order else ""
        return f"{verb} unit {unit} {'to' if verb == 'brings' else 'for'} {station}{ending}"

    def station(self, name: str) -> Reason | None:
        """Returns why a station waits, or what it does; None if it is unknown."""
        station = self._stations.get(name)
        if station is None:
            return None
        since = self._starved.get(name, self._now)
        unit = station.shelf_id
        if unit and station.waiting:
            text = f"waits for a person: unit {unit} is there"
            since = self._now - station.waiting
            return Reason(name, text, since, unit=unit, cause=name)
        if unit:
            text = f"works at unit {unit}"
            return Reason(name, text, self._since(name, text), unit=unit)
        if station.inbound:
            return self._awaited(name, station.inbound, since)
        if station.open and station.orders:
            return Reason(name, "waits for a unit: none is on its way", since)
        text = "has nothing to do" if station.open else "is closed"
        return Reason(name, text, self._since(name, text))

    def _awaited(self, name: str, inbound: Sequence[int], since: float) -> Reason:
        """Returns why a station waits for the first of its units, or for the first that a robot
        carries."""
        unit = next((unit for unit in inbound if unit in self._carriers), inbound[0])
        order = self._order_of(name, unit)
        robot = self._carriers.get(unit, 0)
        if not robot:
            robot = next((r for r, errand in self._errands.items() if errand[0] == unit), 0)
        about: dict[str, Any] = {"unit": unit, "order": order}
        if not robot:
            why = self._held.get(unit, "no robot has it yet")
            return Reason(name, f"waits for unit {unit}; {why}", since, **about)
        own = self.robot(robot)
        text = f"waits for unit {unit} on kiva{robot}"
        if unit not in self._carriers:
            text = f"waits for unit {unit}, which kiva{robot} fetches"
        if own.cause == own.name or own.text.startswith("waits "):
            text += f", which {own.text}"
        return Reason(name, text, since, behind=own.name, cause=own.cause, **about)

    def _order_of(self, name: str, unit: int) -> int:
        station = self._stations[name]
        return dict(zip(station.inbound, station.inbound_orders)).get(unit, 0)

    def find(self, name: str) -> Reason | None:
        """Returns the reason of a robot or station; None for other names."""
        number = name.removeprefix("kiva")
        if number != name and number.isdecimal() and int(number) in self._robots:
            return self.robot(int(number))
        return self.station(name)

    def at(self, name: str, time: float) -> str:
        """Returns the sentence that held for a robot or station at a time [s]; else empty."""
        return self._past.at(name, time)

    def _remember(self) -> None:
        """Keeps the sentences of those that wait or are at fault."""
        names = [self.robot(robot) for robot in self._waits.keys() | self._faults.keys()]
        names += [reason for name in self._stations if (reason := self.station(name))]
        sentences = {reason.name: reason.sentence for reason in names}
        self._past.expect(len(self._robots) + len(self._stations))
        for name in sentences.keys() | self._past.names:
            self._past.note(name, self._now, sentences.get(name, ""))

    def _since(self, name: str, text: str) -> float:
        """Returns since when a robot or station has done what it does [s]."""
        since = self._past.since(name, text)
        return self._now if since is None else since
