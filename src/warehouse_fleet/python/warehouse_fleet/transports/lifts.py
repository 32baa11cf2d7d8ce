# SPDX-License-Identifier: Apache-2.0
"""The orders to lift and to drop units, as they are to be sent to robots."""

from typing import NamedTuple

from warehouse_fleet.robots.robot_table import RobotTable
from warehouse_fleet.transports.transport_book import LIFTING, Step, Transport, TransportBook


class LiftOrder(NamedTuple):
    """A robot is to lift (up) or drop a unit, where it stands."""

    kiva_id: int
    shelf_id: int
    up: bool


class Lifts:
    """Begins lifts of the transports in a book, and keeps their orders until they are sent."""

    def __init__(self, book: TransportBook, robots: RobotTable) -> None:
        self._book, self._robots = book, robots
        self._orders: list[LiftOrder] = []

    def begin(self, transport: Transport, step: Step) -> None:
        """Begins the first attempt of a transport's robot at LIFTING or DROPPING its unit."""
        transport.attempts = 0
        self.repeat(transport, step)

    def repeat(self, transport: Transport, step: Step) -> None:
        """Begins one more attempt at LIFTING or DROPPING a unit."""
        self._book.go_on(transport, step)
        transport.attempts += 1
        self._robots.busy[transport.robot] = True
        kiva_id = int(self._robots.kiva_ids[transport.robot])
        self._orders.append(LiftOrder(kiva_id, transport.shelf, step == LIFTING))

    def take(self) -> list[LiftOrder]:
        """Returns the orders since the last call."""
        orders, self._orders = self._orders, []
        return orders
