# SPDX-License-Identifier: Apache-2.0
"""RWARE's task as the fleet's own planner does it, EPIBT: it sees the whole warehouse, and
commands every robot: the baseline for policies that learn without that view."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from warehouse_fleet import Action as Tick
from warehouse_fleet import Fleet, Rules, epibt
from warehouse_layout import Floor
from warehouse_learning._core import Rware
from warehouse_learning.rware.task import Action, Direction, Task

# Rows count downwards in RWARE: the planner's y is the row, +x towards +y a turn to the right.
HEADING = np.array(
    [{Direction.RIGHT: 0, Direction.DOWN: 1, Direction.LEFT: 2}.get(d, 3) for d in Direction]
)
ACTION = {
    Tick.WAIT: Action.NOOP,
    Tick.FORWARD: Action.FORWARD,
    Tick.TURN_POSITIVE: Action.RIGHT,
    Tick.TURN_NEGATIVE: Action.LEFT,
}
NONE = -1


class Planned:
    """Plans for one warehouse, number `i` of an environment's, in an episode that begins now."""

    def __init__(self, task: Task, warehouses: Rware, i: int, seed: int = 1) -> None:
        self._warehouses, self._i, self._task = warehouses, i, task
        highways = task.floor.highways
        self._height, self._width = highways.shape
        self._highway = highways.ravel().astype(bool)
        self._goals = np.array([y * self._width + x for x, y in task.floor.goals])
        walls = task.floor.walls
        ways = np.ones(highways.shape, np.uint8) if walls is None else 1 - walls
        storage = (highways == 0).astype(np.uint8)
        # A cell that is left can be entered at once; rings and exchanges RWARE settles otherwise.
        self._planner = epibt(Floor(ways, storage), Rules(following=True), seed, threads=1)
        self._fetches = np.full(task.n_agents, NONE)  # shelf
        self._stores = np.full(task.n_agents, NONE)  # cell

    def act(self) -> np.ndarray:
        """Returns (agents,) actions."""
        agents = self._warehouses.agents(self._i)
        cell, heading, shelf = agents[:, 0], HEADING[agents[:, 1]], agents[:, 2]
        goal = self._goal(cell, shelf)
        there = cell == goal
        out = np.where(there, Action.TOGGLE_LOAD, Action.NOOP)
        # At a goal a shelf is delivered by standing there.
        out[there & np.isin(cell, self._goals) & (shelf >= 0)] = Action.NOOP
        fleet = Fleet(
            cell.astype(np.int32),
            heading.astype(np.uint8),
            np.where(there, NONE, goal).astype(np.int32),
            loaded=(shelf >= 0).astype(np.uint8),
            home=np.where(shelf >= 0, self._home(cell), NONE).astype(np.int32),
            stopped=(out == Action.TOGGLE_LOAD).astype(np.uint8),
        )
        ticks = self._planner.plan(fleet, attempts=16)[:, 0]
        planned = np.array([ACTION[Tick(int(tick))] for tick in ticks])
        return np.where(out == Action.TOGGLE_LOAD, out, planned).astype(np.int8)

    def _home(self, cell: np.ndarray) -> np.ndarray:
        """The storage place that a loaded robot may enter: where it stores, or leaves from."""
        return np.where(
            self._stores != NONE, self._stores, np.where(self._highway[cell], NONE, cell)
        )

    def _goal(self, cell: np.ndarray, shelf: np.ndarray) -> np.ndarray:
        """The cell that each robot goes to: a requested shelf, a goal, a free storage place."""
        requested = self._warehouses.requests(self._i)
        shelves = np.array(self._warehouses.shelves(self._i))
        self._fetches[shelf >= 0] = NONE
        self._fetches[~np.isin(self._fetches, requested)] = NONE
        carried = set(shelf.tolist())
        self._assign([s for s in requested if s not in carried], cell, shelf, shelves)
        goal = np.where(self._fetches != NONE, shelves[self._fetches], NONE)
        delivers = (shelf >= 0) & np.isin(shelf, requested)
        self._stores[(shelf < 0) | delivers] = NONE
        for robot in np.flatnonzero(delivers):
            goal[robot] = self._goals[self._apart(cell[robot], self._goals).argmin()]
        standing = np.delete(shelves, shelf[shelf >= 0])
        for robot in np.flatnonzero((shelf >= 0) & ~delivers):
            goal[robot] = self._place(robot, cell[robot], standing)
        return goal

    def _assign(
        self, waiting: Iterable[int], cell: np.ndarray, shelf: np.ndarray, shelves: np.ndarray
    ) -> None:
        """The nearest pairs first, of shelves and robots without a load, until one side is out."""
        self._fetches[shelf < 0] = NONE
        free = np.flatnonzero(shelf < 0).tolist()
        pairs = sorted(
            (int(self._apart(cell[robot], shelves[asked])), robot, asked)
            for robot in free
            for asked in waiting
        )
        taken: set[int] = set()
        for _, robot, asked in pairs:
            if self._fetches[robot] == NONE and asked not in taken:
                self._fetches[robot] = asked
                taken.add(asked)

    def _place(self, robot: int, cell: int, standing: np.ndarray) -> int:
        """The storage place for a robot's shelf, where none stands: as chosen, or the nearest."""
        if self._stores[robot] == NONE or self._stores[robot] in standing:
            free = np.setdiff1d(np.flatnonzero(~self._highway), standing)
            free = np.setdiff1d(free, self._stores)
            self._stores[robot] = free[self._apart(cell, free).argmin()]
        return self._stores[robot]

    def _apart(self, cell: int, cells: ArrayLike) -> np.ndarray:
        """Cells along the axes between one cell and others."""
        row, column = np.divmod(np.asarray(cells), self._width)
        return abs(row - cell // self._width) + abs(column - cell % self._width)
