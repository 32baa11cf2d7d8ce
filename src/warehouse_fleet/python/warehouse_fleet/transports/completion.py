# SPDX-License-Identifier: Apache-2.0
"""The end of transports."""

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.transport_book import Kind, Transport, TransportBook


class Completion:
    """Ends transports of a book. The robot of a transport that ends is free, and stays."""

    def __init__(self, book: TransportBook, robots: RobotTable) -> None:
        self._book, self._robots = book, robots
        self._freed: list[int] = []

    def end(self, transport: Transport) -> None:
        """Removes a transport that is over."""
        self._book.remove(transport)
        if transport.robot != NOWHERE:
            self._freed.append(transport.robot)
            self._robots.send(transport.robot, NOWHERE)

    def fail(self, transport: Transport, text: str) -> None:
        """Ends a transport that can't be done, for the reason `text`."""
        self._book.totals.failed += 1
        self._book.publish_event(transport, Kind.FAILED, text)
        self.end(transport)

    def put_back(self, transport: Transport) -> None:
        """Has the unit of a transport, which has just been stored, fetched again later."""
        robot, transport.is_put_back = transport.robot, False
        self._book.unassign(transport)
        self._book.publish_event(transport, Kind.RECEIVED, "its unit was put back")
        self._freed.append(robot)
        self._robots.send(robot, NOWHERE)

    def take_freed(self) -> list[int]:
        """Returns the robots whose transports have ended since the last call."""
        freed, self._freed = self._freed, []
        return freed
