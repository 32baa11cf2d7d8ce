# SPDX-License-Identifier: Apache-2.0
"""Parks robots without work."""

from collections.abc import Callable, Collection

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.completion import Completion
from warehouse_fleet.transports.contracts import Roads
from warehouse_fleet.transports.dispatch.idle import idle_robots
from warehouse_fleet.transports.transport_book import TransportBook

CellChoice = Callable[[int], int | None]  # robot -> the cell where it waits; None: where it is


class Parking:
    """Sends robots without work to where they are to wait. `aside`, (cells,) bool: the cells where
    no robot passes. `charging`: the robots that have charging places, at any time. `choose_cell`
    returns the cell for a robot that has ended a transport, or None: it waits where it is."""

    def __init__(
        self,
        aside: np.ndarray,
        book: TransportBook,
        robots: RobotTable,
        completion: Completion,
        charging: Collection[int],
        choose_cell: CellChoice,
        roads: Roads,
    ) -> None:
        self._roads = roads
        self._aside, self._book, self._robots = aside, book, robots
        self._completion, self._charging, self._choose_cell = completion, charging, choose_cell

    def run(self) -> None:
        """Ends the drives of robots without work that have come to their goal, or at whose goal
        another robot has work. Sends those that have ended a transport since the last call."""
        robots, idle = self._robots, idle_robots(self._robots, self._book)
        idle[list(self._charging)] = False
        robots.goal[idle & (robots.goal == robots.cell)] = NOWHERE
        sent = idle & (robots.goal != NOWHERE)
        if sent.any():
            needed = np.zeros(len(self._aside), bool)
            needed[robots.goal[~idle & (robots.goal != NOWHERE)]] = True
            robots.goal[sent & needed[robots.goal]] = NOWHERE
        for robot in self._completion.take_freed():
            self._send(robot, self._choose_cell(robot) if idle[robot] else None)

    def _send(self, robot: int, cell: int | None) -> None:
        robots = self._robots
        if cell is None or cell in robots.goal or self._roads.is_cut[cell]:
            return
        if cell != robots.cell[robot] and self._aside[cell]:
            robots.send(robot, cell)
