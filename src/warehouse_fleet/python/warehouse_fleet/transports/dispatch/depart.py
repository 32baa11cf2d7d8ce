# SPDX-License-Identifier: Apache-2.0
"""Lets units that have been released leave their destinations."""

from warehouse_fleet.robots.robot_table import RobotTable
from warehouse_fleet.transports.lifts import Lifts
from warehouse_fleet.transports.storing import Storing
from warehouse_fleet.transports.transport_book import (
    DROPPING,
    STAY,
    WAITING,
    Kind,
    Transport,
    TransportBook,
)


class Departure:
    """Sends units that have been released to storage, or has them put down where they are."""

    def __init__(
        self, book: TransportBook, robots: RobotTable, lifts: Lifts, storing: Storing
    ) -> None:
        self._book, self._robots, self._lifts, self._storing = book, robots, lifts, storing
        self._released: list[Transport] = []

    def add(self, transport: Transport) -> None:
        """Adds a transport that waits at its destination and may leave."""
        self._released.append(transport)

    def run(self) -> None:
        """Lets the units leave that have been released since the last call."""
        released, self._released = self._released, []
        for transport in sorted(released, key=lambda transport: transport.turn):
            if transport.step == WAITING and transport.number in self._book:
                self._leave(transport)

    def _leave(self, transport: Transport) -> None:
        self._robots.busy[transport.robot] = False
        self._book.publish_event(transport, Kind.RELEASED)
        if transport.then != STAY:
            self._storing.store(transport)
            return
        if self._storing.is_place(transport.cell):
            self._book.keep(transport, transport.cell)
        self._lifts.begin(transport, DROPPING)
