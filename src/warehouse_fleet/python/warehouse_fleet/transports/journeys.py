# SPDX-License-Identifier: Apache-2.0
"""The journeys of robots with transports: where each is sent, and what all of them took."""

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.contracts import Drives
from warehouse_fleet.transports.transport_book import Totals


class Journeys:
    """Sends robots on journeys, and adds each journey that ends to `totals`."""

    def __init__(self, robots: RobotTable, drives: Drives, totals: Totals) -> None:
        self._robots, self._drives, self._totals = robots, drives, totals
        self._shortest: dict[int, int] = {}  # cells of the journey that a robot is on

    def begin(self, robot: int, cell: int, home: int = NOWHERE) -> None:
        """Sends a robot to a cell; with a `home` it drives loaded, see RobotTable."""
        self._drives.journey(robot)
        begin = int(self._robots.cell[robot])
        loaded = home != NOWHERE
        self._shortest[robot] = self._drives.shortest(begin, int(cell), loaded=loaded)
        self._robots.send(robot, cell, home)

    def take_arrived(self, among: np.ndarray) -> list[int]:
        """Returns the robots that have arrived, of those `among`, (n,) bool; their journeys end."""
        arrived = self._drives.arrived(among).tolist()
        for robot in arrived:
            self._end(robot)
        return arrived

    def _end(self, robot: int) -> None:
        driven, planned, cells = self._drives.journey(robot)
        self._totals.driven += driven
        self._totals.planned += planned
        self._totals.cells += cells
        self._totals.shortest += self._shortest.pop(robot, cells)
