# SPDX-License-Identifier: Apache-2.0
"""What cuts robots off from where they are to go: those in a one-way street, of one that has
broken down ahead of them."""

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_layout import Floor


class CutOff:
    """Looks for the obstacles that leave a robot no way to its goal. Answers are kept while the
    obstacles stay the same."""

    def __init__(self, floor: Floor) -> None:
        self._floor = floor
        self._edges: dict[bool, np.ndarray] = {}  # by whether a robot is loaded; when asked
        self._closed = np.zeros(0, bool)
        self._known: dict[tuple[int, int, bool], np.ndarray] = {}

    def set_obstacles(self, cells: np.ndarray, count: int) -> None:
        """Sets the cells that no robot can enter, of `count` cells."""
        closed = np.zeros(count, bool)
        closed[cells] = True
        if not np.array_equal(closed, self._closed):
            self._closed, self._known = closed, {}

    def obstacles(self, cell: int, goal: int, loaded: bool) -> np.ndarray:
        """Returns, ascending, the obstacles at the edge of what a robot in a cell can reach if none
        of that is its goal; else nothing."""
        key = (cell, goal, loaded)
        if key not in self._known:
            self._known[key] = self._look_from(*key)
        return self._known[key]

    def _look_from(self, cell: int, goal: int, loaded: bool) -> np.ndarray:
        reached = self._reach(cell, loaded)
        beside = np.flatnonzero(
            (self._edges_of(False) == goal).any(1)
        )  # loaded ones end there, too
        if reached[goal] or reached[beside].any():
            return np.zeros(0, np.int32)
        ahead = np.unique(self._edges_of(loaded)[reached])
        ahead = ahead[ahead != NOWHERE]
        return ahead[self._closed[ahead]]

    def _reach(self, cell: int, loaded: bool) -> np.ndarray:
        """Returns (cells,) bool: where a robot comes to from a cell."""
        edges = self._edges_of(loaded)
        reached = np.zeros(len(edges), bool)
        reached[cell] = True
        front = np.array([cell])
        while len(front):
            ahead = np.unique(edges[front])
            ahead = ahead[ahead != NOWHERE]
            front = ahead[~reached[ahead] & ~self._closed[ahead]]
            reached[front] = True
        return reached

    def _edges_of(self, loaded: bool) -> np.ndarray:
        """Returns (cells, 4) int: the next cell towards each heading, or NOWHERE."""
        if loaded not in self._edges:
            self._edges[loaded] = np.asarray(self._floor.edges(loaded))
        return self._edges[loaded]
