# SPDX-License-Identifier: Apache-2.0
"""Handles arrivals: beneath a unit, at a destination, at a storage place."""

from collections.abc import Callable

import numpy as np

from warehouse_fleet.robots.robot_table import RobotTable
from warehouse_fleet.transports.journeys import Journeys
from warehouse_fleet.transports.lifts import Lifts
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    DROPPING,
    FETCHING,
    READY,
    STORING,
    Step,
    Transport,
    TransportBook,
)

DRIVES = np.isin(np.arange(len(Step) + 1), (FETCHING, BRINGING, STORING))  # by step; none: False


class Arrival:
    """Brings transports whose robots have arrived to the next step; `on_delivered` is called with
    each whose unit has arrived at its destination."""

    def __init__(
        self,
        book: TransportBook,
        robots: RobotTable,
        journeys: Journeys,
        lifts: Lifts,
        on_delivered: Callable[[Transport], None],
    ) -> None:
        self._book, self._robots, self._journeys = book, robots, journeys
        self._lifts, self._on_delivered = lifts, on_delivered

    def run(self) -> None:
        """Begins the next step of each robot that stands at its goal."""
        for robot in self._journeys.take_arrived(DRIVES[self._book.step_of]):
            transport = self._book.of_robot[robot]
            if transport.step == FETCHING:
                self._book.go_on(transport, READY)
            elif transport.step == BRINGING:
                self._robots.busy[robot] = True
                self._on_delivered(transport)
            else:
                self._lifts.begin(transport, DROPPING)
