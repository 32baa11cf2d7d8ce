# SPDX-License-Identifier: Apache-2.0
"""Clears streets and lanes of robots without work."""

from collections.abc import Collection

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.contracts import Roads
from warehouse_fleet.transports.dispatch.idle import idle_robots
from warehouse_fleet.transports.distances import Distances
from warehouse_fleet.transports.transport_book import TransportBook
from warehouse_fleet.transports.unit_map import UnitMap


class Clearing:
    """Sends robots that stand in streets and lanes beneath stored units. `aside`, (cells,) bool:
    the cells where no robot passes. `charging`: the robots that have charging places, at any
    time."""

    def __init__(
        self,
        aside: np.ndarray,
        distances: Distances,
        book: TransportBook,
        robots: RobotTable,
        units: UnitMap,
        charging: Collection[int],
        roads: Roads,
    ) -> None:
        self._aside, self._distances, self._book = aside, distances, book
        self._roads = roads
        self._robots, self._units, self._charging = robots, units, charging

    def run(self) -> None:
        """Sends each robot that has neither work nor a goal, and stands where others pass."""
        robots, idle = self._robots, idle_robots(self._robots, self._book)
        idle[list(self._charging)] = False
        in_the_way = idle & (robots.goal == NOWHERE) & ~self._aside[robots.cell]
        if not in_the_way.any():
            return
        places = self._free_places()
        for robot in np.flatnonzero(in_the_way).tolist():
            if not len(places):
                return
            far = self._distances(int(robots.cell[robot]), places)
            place = self._units.first_in(places[far == far.min()])
            places = places[places != place]
            robots.send(robot, place)

    def _free_places(self) -> np.ndarray:
        """Returns the cells with units beneath which no robot stands, or is to stand."""
        free = self._units.stands & self._aside & ~self._roads.is_cut
        for cells in (self._robots.goal, self._robots.cell):
            free[cells[cells != NOWHERE]] = False
        return np.flatnonzero(free)
