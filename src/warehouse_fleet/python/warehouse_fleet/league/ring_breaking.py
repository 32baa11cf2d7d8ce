# SPDX-License-Identifier: Apache-2.0
"""Breaks the rings of a plan: robots that follow each other in a circle, all at the same tick.

Bodies of 0.76 m x 0.64 m can't do that on cells of 1 m: at each of a ring's corners the robot ahead
would have to be 0.4 m further on than the one behind. So a ring becomes moves into free cells, one
after the other, that end as the ring does:

    1 2 .      2 steps aside by a detour that leaves the ring at its cell and comes back to it at
    4 3 .      the next one, 3's; the others go on, 1 first and 3 last; then 2 enters 3's cell

Robots that stand on the detour make room before, and go back in the end.
"""

import heapq
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

NO_ROBOT = NOWHERE = -1
OCCUPIED = 6  # what a robot on a detour, which has to make room, costs [cells]
FAR = 2_000  # cells that are looked at for one way

Cells: TypeAlias = NDArray[np.integer[Any]]


class Move(NamedTuple):
    """One robot drives from its cell into a free one beside it."""

    robot: int
    start: int
    end: int


def rings_of(before: Cells, after: Cells, at: Cells) -> list[list[int]]:
    """Returns the rings of a tick: robots of which each enters the cell of the next, in a circle.

    before, after: (robots,) cells. at: (cells,) the robot in each cell before the tick, or
    NO_ROBOT.
    """
    count = len(before)
    moves, followers = before != after, at[after]
    leader = np.full(count + 1, count)  # whose cell it enters; `count`: no robot's
    leader[:count] = np.where(moves & (followers != NO_ROBOT) & moves[followers], followers, count)
    jump = leader
    for _ in range(count.bit_length()):  # a robot in no ring comes to the end of its queue
        jump = jump[jump]
    left = set(np.flatnonzero(jump[:count] != count).tolist())
    rings = []
    while left:
        ring = [min(left)]
        while (robot := int(leader[ring[-1]])) != ring[0]:
            ring.append(robot)
        left.difference_update(ring)
        rings.append(ring)
    return rings


class RingBreaker:
    """Finds moves that take the place of rings. passable: (rows, columns) bool."""

    def __init__(self, passable: NDArray[np.bool_]) -> None:
        self._columns = passable.shape[1]
        self._passable = passable.ravel()

    def moves(self, ring: Sequence[int], cells: Cells, at: Cells) -> list[Move] | None:
        """Returns moves after which each robot of a ring is in the cell of the next, and all
        others are where they were; None: there is no room.

        cells: (robots,), at: (cells,), as for rings_of(); `at` is the same afterwards.
        """
        around = [int(cells[robot]) for robot in ring]
        for detour, first in self._detours(around, at):
            cleared = self._clear(detour, {*around, *detour}, at)
            if cleared is not None:
                order = [*range(first, len(ring)), *range(first)]
                turned = _turn([ring[i] for i in order], [around[i] for i in order], detour)
                return [*cleared, *turned, *(Move(r, b, a) for r, a, b in reversed(cleared))]
        return None

    def _detours(self, around: list[int], at: Cells) -> Iterator[tuple[list[int], int]]:
        """Yields the cells between two of a ring's that follow each other, the cheapest detour
        first, and the index of the first of the two."""
        ways = []
        for i, cell in enumerate(around):
            ends = {*self._beside(around[(i + 1) % len(around)])}
            cost, way = self._way(cell, ends.__contains__, {*around}, at)
            if way:
                ways.append((cost, i, way))
        yield from ((way, i) for _, i, way in sorted(ways))

    def _clear(self, detour: list[int], kept: set[int], at: Cells) -> list[Move] | None:
        """Returns moves that free the cells of a detour, none into `kept`; None: there are none."""
        now, moves = at.copy(), []
        for cell in detour:
            if now[cell] == NO_ROBOT:
                continue
            _, way = self._way(cell, lambda next_cell: now[next_cell] == NO_ROBOT, kept, now)
            if not way:
                return None
            for start, end in reversed(list(zip([cell, *way], way))):
                moves.append(Move(int(now[start]), start, end))
                now[end], now[start] = now[start], NO_ROBOT
        return moves

    def _way(
        self, start: int, is_end: Callable[[int], bool], barred: set[int], at: Cells
    ) -> tuple[int, list[int]]:
        """Returns the cheapest way to an end near `start`: its cost and its cells, without `start`
        and those barred; no cells if there is none."""
        costs, before, queue = {start: 0}, {start: NOWHERE}, [(0, start)]
        while queue and len(costs) < FAR:
            cost, cell = heapq.heappop(queue)
            if cell != start and is_end(cell):
                return cost, _way_back(cell, before)
            for beside in self._beside(cell):
                total = cost + 1 + OCCUPIED * int(at[beside] != NO_ROBOT)
                if beside not in barred and total < costs.get(beside, total + 1):
                    costs[beside], before[beside] = total, cell
                    heapq.heappush(queue, (total, beside))
        return 0, []

    def _beside(self, cell: int) -> Iterator[int]:
        column = cell % self._columns
        near = (cell + 1, cell - 1, cell + self._columns, cell - self._columns)
        is_inside = (column + 1 < self._columns, column > 0, True, True)
        for neighbour, inside in zip(near, is_inside):
            if inside and 0 <= neighbour < len(self._passable) and self._passable[neighbour]:
                yield neighbour


def _way_back(end: int, before: dict[int, int]) -> list[int]:
    """Returns the way to `end` by the cell before each; its start has none and is left out."""
    way = [end]
    while before[before[way[-1]]] != NOWHERE:
        way.append(before[way[-1]])
    return way[::-1]


def _turn(ring: list[int], around: list[int], detour: list[int]) -> list[Move]:
    """Returns the moves of a ring whose first robot drives a detour, which is free, to the cell of
    the second."""
    out = [around[0], *detour]
    moves = [Move(ring[0], a, b) for a, b in zip(out, detour)]
    for i in range(len(ring) - 1, 0, -1):  # the last enters the first's cell, and so on
        moves.append(Move(ring[i], around[i], around[(i + 1) % len(ring)]))
    return [*moves, Move(ring[0], detour[-1], around[1])]
