# SPDX-License-Identifier: Apache-2.0
"""Admits units to stations: lifts those whose station has room."""

from collections.abc import Mapping

from warehouse_fleet.robots.robot_table import RobotTable
from warehouse_fleet.transports.lifts import Lifts
from warehouse_fleet.transports.streets import Streets
from warehouse_fleet.transports.transport_book import LIFTING, Transport, TransportBook


class Admission:
    """Lifts units whose robots wait beneath them. `capacity`: the largest number of units that are
    inbound to each station, by its name."""

    def __init__(
        self,
        book: TransportBook,
        robots: RobotTable,
        lifts: Lifts,
        streets: Streets,
        capacity: Mapping[str, int],
    ) -> None:
        self._book, self._robots, self._lifts = book, robots, lifts
        self._streets, self._capacity = streets, capacity

    def run(self) -> None:
        """Lifts units for whose station there is room, in the order in which their robots came.
        Lifts none for a station whose lane can't be entered, passed and left now."""
        for station, ready in self._book.ready.items():
            for transport in ready.copy():
                if not self._has_room(station):
                    break
                if self._may_lift(transport):
                    self._lifts.begin(transport, LIFTING)

    def _has_room(self, station: str) -> bool:
        return not station or self._book.inbound[station] < self._capacity[station]

    def _may_lift(self, transport: Transport) -> bool:
        return self._is_beneath(transport) and not self._streets.is_cut_off(
            transport.station, transport.shelf
        )

    def _is_beneath(self, transport: Transport) -> bool:
        robots, robot = self._robots, transport.robot
        return bool(robots.stands[robot] and robots.cell[robot] == robots.goal[robot])
