# SPDX-License-Identifier: Apache-2.0
"""What cuts robots off from where they are to go: those in a one-way street, of one that has
broken down ahead of them."""

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_layout.floor.floor_edges import FloorEdges


class CutOff:
    """Looks for the obstacles that leave a robot no way to its goal. Answers are kept while the
    obstacles stay the same."""

    def __init__(self, edges: FloorEdges) -> None:
        self._edges = edges
        self._closed = np.zeros(0, bool)
        self._known: dict[tuple[int, int, bool], np.ndarray] = {}

    def set_obstacles(self, cells: np.ndarray, count: int) -> None:
        """Sets the cells that no robot can enter, of `count` cells."""
        closed = np.zeros(count, bool)
        closed[cells] = True
        if not np.array_equal(closed, self._closed):
            self._closed, self._known = closed, {}

    def obstacles(self, cell: int, goal: int, loaded: bool) -> np.ndarray:
        """Returns, ascending, the obstacles that each alone keep a robot in a cell from its goal;
        where it takes several, those at the edge of what it can reach; nothing if it has a way."""
        key = (cell, goal, loaded)
        if key not in self._known:
            self._known[key] = self._look_from(*key)
        return self._known[key]

    def _look_from(self, cell: int, goal: int, loaded: bool) -> np.ndarray:
        reached = self._edges.reached_from(cell, loaded, self._closed)
        if self._ends_at(goal, reached):
            return np.zeros(0, np.int32)
        ahead = np.unique(self._edges.ahead(loaded)[reached])
        ahead = ahead[ahead != NOWHERE]
        ahead = ahead[self._closed[ahead]]
        alone = [obstacle for obstacle in ahead if self._cuts_alone(obstacle, cell, goal, loaded)]
        return np.array(alone, np.int32) if alone else ahead

    def _cuts_alone(self, obstacle: int, cell: int, goal: int, loaded: bool) -> bool:
        """Returns whether a robot would come to its goal without that obstacle."""
        closed = self._closed.copy()
        closed[obstacle] = False
        return self._ends_at(goal, self._edges.reached_from(cell, loaded, closed))

    def _ends_at(self, goal: int, reached: np.ndarray) -> bool:
        """Returns whether a robot that comes to the cells `reached`, (cells,) bool, comes to its
        goal: loaded ones may enter a storage place there."""
        return bool(reached[goal] or reached[self._edges.before(goal, False)].any())
