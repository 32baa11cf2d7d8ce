# SPDX-License-Identifier: Apache-2.0
"""Explains to a person why robots wait that have somewhere to go, and what each robot does."""

from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.transport_book import Step, Transport
from warehouse_layout.message_enums import RobotMode

if TYPE_CHECKING:
    from warehouse_fleet.traffic.traffic import Traffic

WAITS_LONG = 10.0  # [s]
DOES = {
    Step.FETCHING: "fetching",
    Step.READY: "ready",
    Step.LIFTING: "lifting",
    Step.BRINGING: "bringing",
    Step.WAITING: "waiting",
    Step.STORING: "storing",
    Step.DROPPING: "dropping",
}
# What the robots in a station's queue do: the first may just have been served.
QUEUE = (Step.BRINGING, Step.WAITING, Step.STORING)


class Waiting:
    """The waiting robots of a Traffic with its transports. `by_hand`: names of the stations where a
    person works."""

    def __init__(
        self,
        traffic: "Traffic",
        transports: Iterable[Transport],
        by_hand: Collection[str] = frozenset(),
    ) -> None:
        self._traffic, self._robots, self._by_hand = traffic, traffic.robots, by_hand
        self._ahead = traffic.all_ahead().tolist()
        self._of_robot = {t.robot: t for t in transports if t.robot != NOWHERE}

    def doing(self) -> dict[int, str]:
        """Returns {kiva_id: word}: what each robot that is there does."""
        return {
            int(kiva): self._does(robot)
            for robot, kiva in enumerate(self._robots.kiva_ids)
            if not self._robots.gone[robot]
        }

    def _does(self, robot: int) -> str:
        mode = RobotMode(self._robots.mode[robot])
        if mode != RobotMode.AUTOMATIC:
            return mode.name.lower()
        transport = self._of_robot.get(robot)
        return DOES[transport.step] if transport else "idle"

    def behind(self, robot: int) -> int:
        """Returns the robot that a robot waits for; or NOWHERE."""
        return self._ahead[robot]

    def long(self) -> list[tuple[int, str]]:
        """Returns [(robot, text)]: robots that have stood for WAITS_LONG, and the reason. Leaves
        out those in the queue of a station that itself waits for a person."""
        traffic = self._traffic
        still = (
            (traffic.time - self._robots.still_since > WAITS_LONG)
            & ~self._robots.busy
            & ~self._robots.gone
        )
        waiting = []
        for robot in np.flatnonzero(still).tolist():
            last = self._last_ahead(robot)
            station = self._served_at(last)
            if station not in self._by_hand:
                waiting.append((robot, self._reason(robot, last, station)))
        return waiting

    def for_people(self) -> list[str]:
        """Returns a sentence for each station that waits for a person to confirm, and how long."""
        return [
            f"{station} has waited for a person for "
            f"{_lasting(self._traffic.time - transport.since)}"
            for robot, transport in sorted(self._of_robot.items())
            if (station := self._served_at(robot)) in self._by_hand
            and self._traffic.time - transport.since > WAITS_LONG
        ]

    def _served_at(self, robot: int) -> str:
        """Returns the station at which a robot's unit is served now; an empty name if at none."""
        transport = self._of_robot.get(robot)
        return transport.station if transport and transport.step == Step.WAITING else ""

    def _last_ahead(self, robot: int) -> int:
        """Returns the robot at the head of the queue in which a robot is; itself at its head."""
        passed = {robot}
        while (ahead := self._ahead[robot]) != NOWHERE and ahead not in passed:
            passed.add(ahead)
            robot = ahead
        return robot

    def _reason(self, robot: int, last: int, station: str) -> str:
        """Returns why a robot waits: the queue that it is in, the robot before it, and what is
        wrong with that or with the queue's head. `station` serves the head."""
        served = bool(station)
        ahead = self._ahead[robot]
        if ahead == NOWHERE:
            if self._robots.slowed_for_people[robot]:
                return "for people on the floor"
            if self._robots.broken[robot]:
                return "until it is repaired"
            return "until its route is free"
        text = f"behind kiva{self._robots.kiva_ids[ahead]}"
        if station := station or self._shared_queue(robot, ahead):
            text = f"in the queue of {station} {text}"
        if fault := self._fault(ahead):
            return f"{text}, which is {fault}"
        fault = self._fault(last)
        leaves = bool(self._shared_queue(robot, last))
        if last == ahead or ((served or leaves) and not fault):
            return text
        head = f"kiva{self._robots.kiva_ids[last]}"
        return f"{text}, in a queue behind {head}" + (f", which is {fault}" if fault else "")

    def _shared_queue(self, robot: int, ahead: int) -> str:
        """Returns the station to which a robot brings a unit, as the other does, or from which that
        comes; an empty name if none."""
        own, other = self._of_robot.get(robot), self._of_robot.get(ahead)
        if not (own and other) or own.station != other.station or own.step != Step.BRINGING:
            return ""
        return own.station if other.step in QUEUE else ""

    def _fault(self, robot: int) -> str:
        """Returns why a robot can't drive autonomously; empty if it can."""
        if self._robots.broken[robot]:
            return "broken"
        mode = RobotMode(self._robots.mode[robot])
        return "" if mode == RobotMode.AUTOMATIC else mode.name.lower().replace("_", " ")


def _lasting(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"
