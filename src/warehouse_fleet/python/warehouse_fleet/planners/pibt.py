# SPDX-License-Identifier: Apache-2.0
"""Priority inheritance with backtracking (Okumura et al., Artificial Intelligence 310, 2022): each
robot gets its best next cell that leaves one for all others."""

from collections.abc import Iterable

import numpy as np

NOWHERE = -1


class Pibt:
    """One step. cell: (n,) of the robots; targets: (n, 5), the cells that each could enter, its own
    among them, NOWHERE where there is none; free: (n,) bool, who may move; barred: cells that
    none may enter; goal: (n,), NOWHERE: none."""

    def __init__(
        self,
        cell: np.ndarray,
        targets: np.ndarray,
        free: np.ndarray,
        barred: Iterable[int],
        goal: np.ndarray,
    ) -> None:
        self._cell, self._goal = cell.tolist(), goal.tolist()
        self._targets = targets.tolist()
        self._free = free.tolist()
        self._holder = {at: robot for robot, at in enumerate(self._cell)}
        self._taken: dict[int, int] = {}
        self._next = [NOWHERE] * len(self._cell)
        self._barred = set(barred)
        for robot, is_free in enumerate(self._free):
            if not is_free:
                self._take(robot, self._cell[robot])

    def assign(self, scores: np.ndarray, ranks: np.ndarray) -> np.ndarray:
        """Returns the cell of each robot after the step, (n,).

        scores: (n, 5), of the targets, the best first, -inf: never; ranks: (n,), the least first.
        """
        self._order = np.argsort(-scores, axis=1, kind="stable").tolist()
        self._possible = (scores > -np.inf).tolist()
        for robot in np.argsort(ranks, kind="stable").tolist():
            if self._next[robot] == NOWHERE:
                self._find(robot, NOWHERE)
        return np.array(self._next)

    def _take(self, robot: int, cell: int) -> None:
        self._next[robot] = cell
        self._taken[cell] = robot

    def _find(self, robot: int, pushed_by: int) -> bool:
        """Gives a robot a cell; whether it is one that is no other's. Else it stays."""
        here = self._cell[robot]
        for option in self._order[robot]:
            cell = self._targets[robot][option]
            if not self._possible[robot][option] or cell in self._taken:
                continue
            if cell != here and cell in self._barred:
                continue
            if pushed_by != NOWHERE and cell == self._cell[pushed_by]:
                continue  # they would exchange their cells
            other = self._holder.get(cell, NOWHERE)
            if other not in (NOWHERE, robot):
                if not self._yields(other, robot) or self._closes_a_ring(robot, cell):
                    continue
                self._take(robot, cell)
                if self._next[other] == NOWHERE and not self._find(other, robot):
                    continue
                return True
            self._take(robot, cell)
            return True
        self._take(robot, here)
        return False

    def _yields(self, other: int, robot: int) -> bool:
        """Whether one that stands where it is going makes way: not to those that queue behind."""
        if self._next[other] != NOWHERE:
            return self._next[other] != self._cell[other]
        goal = self._goal[other]
        return not (goal == self._cell[other] and goal == self._goal[robot])

    def _closes_a_ring(self, robot: int, cell: int) -> bool:
        """Whether those ahead, each on its way into the next one's cell, come back to a robot."""
        ahead = self._holder.get(cell, NOWHERE)
        for _ in self._cell:
            if ahead in (NOWHERE, robot):
                break
            to = self._next[ahead]
            if to in (NOWHERE, self._cell[ahead]):
                return False
            ahead = self._holder.get(to, NOWHERE)
        return ahead == robot
