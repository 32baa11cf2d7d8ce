# SPDX-License-Identifier: Apache-2.0
"""Which robot does which task of a problem of the League of Robot Runners."""

import math
from collections.abc import Iterator
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from warehouse_fleet._core import PURSUING
from warehouse_fleet.league.problem import Problem
from warehouse_fleet.league.steps import steps_between

NOWHERE = -1  # no task
MOST_TABLE = 4_000  # cells of a map with a table of all ways, of 32 MB
LANDMARKS = 200  # about as many squares of a larger map, from each of which all ways are known
MOST_PAIRS = 1_000_000  # robots times tasks that are weighed at once
WEIGHT = 0.1  # of a task's length beside the way to it
CHANCE = 3  # tasks that may wait at a place by chance
QUEUE = 0.01  # of the tasks' mean length: robots come so much farther for each task above CHANCE
STAY = 1.0  # cells by which another robot has to be nearer to take over a task
UNREACHABLE = 65_535  # cells

Cells: TypeAlias = NDArray[np.integer[Any]]


class Scheduler(Protocol):
    """Deals out tasks."""

    def give(
        self, task: Cells, errand: Cells, cell: Cells, finished: int
    ) -> Iterator[tuple[int, int]]:
        """Yields (robot, task) for each robot that begins another task.

        task, errand, cell, (robots,): its task, NOWHERE without, how many errands of it are done,
        and where it is. finished: the tasks that are done so far.
        """


class RoundRobin:
    """Gives task k to robot k mod robots, in the order of the file."""

    def __init__(self, problem: Problem) -> None:
        self._tasks = math.inf if problem.repeats else len(problem.tasks)
        self._robots = len(problem.agents)
        self._next = np.arange(self._robots)

    def give(
        self, task: Cells, _errand: Cells, _cell: Cells, _finished: int
    ) -> Iterator[tuple[int, int]]:
        """Yields a task for each robot without, as far as it has some left."""
        for robot in np.flatnonzero(task == NOWHERE).tolist():
            if self._next[robot] < self._tasks:
                yield robot, int(self._next[robot])
                self._next[robot] += self._robots


class Shortest:
    """Gives tasks so that the ways to them and a part of their own lengths are shortest in all.

    Weighed are the tasks that are revealed, and that no robot has begun: of a robot that is on its
    way to a task, another one takes it over that is nearer; of large fleets some robots on their
    way are weighed again, others in the next tick. Ways are as long as without other robots. Where
    more tasks wait, robots come from farther away, or they would serve what is nearest and leave a
    part of the map behind (the longest queue counts most: Tassiulas and Ephremides, IEEE
    Transactions on Automatic Control 37, 1992). On a crowded floor only those robots get tasks that
    are nearest to one, as many as the planner lets pursue goals; of many that wait, some are
    weighed.
    """

    def __init__(self, problem: Problem, pursuing: float = PURSUING) -> None:
        """pursuing: how many robots have tasks at a time, as a share of the passable cells."""
        self._limit = int(problem.revealed)
        self._most = max(1, int(pursuing * np.count_nonzero(problem.passable)))
        self._ways = _Ways(problem.passable)
        self._start = np.array([cells[0] for cells in problem.tasks])
        self._length = self._lengths(problem.tasks)
        self._random = np.random.default_rng(0)
        self._queue = QUEUE * self._length.mean()
        self._open: list[int] = []
        self._revealed = 0

    def _lengths(self, tasks: list[list[int]]) -> NDArray[np.float64]:
        """Returns the way through the cells of each task [cells]."""
        cells = np.concatenate(tasks)
        begins = np.cumsum([0, *map(len, tasks[:-1])])
        legs = np.append(self._ways.between(cells[:-1], cells[1:]), 0.0)
        legs[begins[1:] - 1] = 0.0  # from a task to the next one
        return np.add.reduceat(legs, begins)

    def give(
        self, task: Cells, errand: Cells, cell: Cells, finished: int
    ) -> Iterator[tuple[int, int]]:
        """Yields a task for robots without, and others for robots that have not begun theirs."""
        self._reveal(finished)
        idle = self._next(np.flatnonzero(task == NOWHERE), cell)
        if not len(idle):
            return
        going = np.flatnonzero((task != NOWHERE) & (errand == 0))
        waits = np.union1d(idle, self._some(going, len(idle)))
        held = task[waits]
        self._open += held[held != NOWHERE].tolist()
        while len(waits) and self._open:
            some = waits[: max(1, MOST_PAIRS // len(self._open))]
            waits = waits[len(some) :]
            for robot, other in self._assigned(some, task[some], cell[some]):
                if task[robot] != other:
                    yield robot, other

    def _reveal(self, finished: int) -> None:
        """Reveals tasks until as many are unfinished as the problem says."""
        end = finished + self._limit
        self._open += range(self._revealed, end)
        self._revealed = end

    def _next(self, idle: Cells, cell: Cells) -> Cells:
        """Returns those of the idle robots that may begin a task now, in their order."""
        room = max(0, self._most - (len(cell) - len(idle)))
        if room >= len(idle) or not self._open:
            return idle
        weighed = max(room, MOST_PAIRS // len(self._open))
        if weighed < len(idle):
            idle = np.sort(self._random.choice(idle, weighed, replace=False))
        if room == weighed:
            return idle
        nearest = self._cost(cell[idle], np.array(self._open)).min(axis=1)
        return np.sort(idle[np.argsort(nearest, kind="stable")[:room]])

    def _some(self, going: Cells, idle: int) -> Cells:
        """Draws those robots on their way to a task that are weighed again beside `idle` idle ones.

        They are as many as keep the table of robots and tasks at MOST_PAIRS or fewer: each robot
        adds a row, and a column for the task that it holds.
        """
        tasks = len(self._open)
        most = (math.sqrt((idle - tasks) ** 2 + 4 * MOST_PAIRS) - idle - tasks) / 2
        if len(going) <= most:
            return going
        return self._random.choice(going, max(0, int(most)), replace=False)

    def _assigned(self, robots: Cells, held: Cells, cell: Cells) -> list[tuple[int, int]]:
        """Returns robots with their tasks, and takes these off the open ones."""
        tasks = np.array(self._open)
        cost = self._cost(cell, tasks) - STAY * (held[:, None] == tasks)
        robot, column = linear_sum_assignment(np.minimum(cost, UNREACHABLE))
        dealt = list(zip(robots[robot].tolist(), tasks[column].tolist()))
        self._open = np.delete(tasks, column).tolist()
        return dealt

    def _cost(self, cell: Cells, tasks: Cells) -> NDArray[np.float64]:
        """Returns what tasks cost robots in these cells, (robots, tasks) [cells]."""
        rows = tasks % len(self._start)  # after the last task comes the first one again
        starts = self._start[rows]
        ways = self._ways.between(cell[:, None], starts)
        queues = np.maximum(np.bincount(starts) - CHANCE, 0)[starts]
        return ways + WEIGHT * self._length[rows] - self._queue * queues


class _Ways:
    """How far cells are from each other [cells]; on large maps at least so far.

    Large maps have landmarks. From each to every cell the way is known, so that the way between two
    cells is at least the difference of theirs from a landmark (the bound of Goldberg and Harrelson,
    Computing the Shortest Path: A* Search Meets Graph Theory, 2005). The end's nearest one is used.
    On small maps each cell is one, so that ways are exact.
    """

    def __init__(self, passable: NDArray[np.bool_]) -> None:
        self._width = passable.shape[1]
        self._number = np.cumsum(passable).reshape(-1) - 1  # by cell: among the passable ones
        is_small = passable.size <= MOST_TABLE
        marks = None if is_small else self._number[_landmarks(passable)]
        self._ways = _from(steps_between(passable), marks)
        self._nearest = self._ways.argmin(axis=0)

    def between(self, starts: Cells, ends: Cells) -> NDArray[np.float64]:
        """Returns the ways from starts to ends, whose shapes are broadcast."""
        start, end = self._number[starts], self._number[ends]
        rows, columns = np.divmod(starts, self._width)
        other_rows, other_columns = np.divmod(ends, self._width)
        straight = np.abs(rows - other_rows) + np.abs(columns - other_columns)
        mark = self._nearest[end]
        farther = self._ways[mark, start].astype(int) - self._ways[mark, end]
        return np.maximum(straight, farther).astype(float)


def _landmarks(passable: NDArray[np.bool_]) -> Cells:
    """Returns passable cells, one of each square of the map that has any."""
    side = max(1, math.isqrt(np.count_nonzero(passable) // LANDMARKS))
    cells = np.flatnonzero(passable)
    rows, columns = np.divmod(cells, passable.shape[1])
    aside = np.abs(rows % side - side // 2) + np.abs(columns % side - side // 2)
    order = np.argsort(aside, kind="stable")
    squares = (rows // side) * passable.shape[1] + columns // side
    return cells[order[np.unique(squares[order], return_index=True)[1]]]


def _from(graph: csr_matrix, cells: Cells | None) -> NDArray[np.uint16]:
    """Returns the ways from these cells, or from all, to all cells, (cells, all cells)."""
    ways = dijkstra(graph, directed=False, unweighted=True, indices=cells)
    return np.minimum(ways, UNREACHABLE).astype(np.uint16)
