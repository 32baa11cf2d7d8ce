# SPDX-License-Identifier: Apache-2.0
"""Ways over the grid, and the `/mov` commands that follow them."""

import heapq
import math
from collections.abc import Collection, Sequence
from typing import Any

Point = tuple[int, int]
STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))

# A stop, a quarter turn and a start take about the time of two cells at full speed.
TURN_COST = 2.0


class NoRouteError(ValueError):
    """Raised where no way leads from start to goal; names both."""


def point(p: Sequence[float]) -> Point:
    """Returns the grid point nearest to a position (x, y, …) [m]."""
    return round(p[0]), round(p[1])


def covered(x: float, y: float, yaw: float, length: float, width: float) -> list[Point]:
    """Returns the grid points whose cells a rectangle reaches into: centre [m], heading [rad],
    extents [m]."""
    c, s = abs(math.cos(yaw)), abs(math.sin(yaw))
    reach_x = (length * c + width * s) / 2 + 0.5 - 1e-9
    reach_y = (length * s + width * c) / 2 + 0.5 - 1e-9
    return [(i, j) for i in _between(x, reach_x) for j in _between(y, reach_y)]


def _between(centre: float, reach: float) -> range:
    return range(math.ceil(centre - reach), math.floor(centre + reach) + 1)


def route(free: Collection[Point], start: Point, goal: Point) -> list[Point]:
    """Returns the grid points from start to goal, both included: short, with few turns.

    Dijkstra (1959) over the free points and headings. The start may be blocked: the robot stands
    there. Raises NoRouteError.
    """
    queue: list[Any] = [(0.0, start, None, None)]
    came_from: dict[Any, Any] = {}
    while queue:
        cost, here, step, before = heapq.heappop(queue)
        if (here, step) in came_from:
            continue
        came_from[here, step] = before
        if here == goal:
            return _walk_back(came_from, (here, step))
        for ahead in STEPS:
            there = (here[0] + ahead[0], here[1] + ahead[1])
            turn = TURN_COST if step not in (None, ahead) else 0.0
            if there in free:
                heapq.heappush(queue, (cost + 1 + turn, there, ahead, (here, step)))
    raise NoRouteError(f"no way from {start} to {goal}")


def _walk_back(came_from: dict[Any, Any], node: Any) -> list[Point]:
    points = []
    while node:
        points.append(node[0])
        node = came_from[node]
    return points[::-1]


def corners(points: Sequence[Point]) -> list[Point]:
    """Returns the points where a route turns, and its end."""
    turns = [
        b
        for a, b, c in zip(points, points[1:], points[2:])
        if (b[0] - a[0], b[1] - a[1]) != (c[0] - b[0], c[1] - b[1])
    ]
    return [*turns, points[-1]] if len(points) > 1 else []


def goals(points: Sequence[Point]) -> list[Point]:
    """Returns the fewest `/mov` goals of a route: each goes along x first, then along y."""
    ends = corners(points)
    kept, here = [], points[0]
    for end, after in zip(ends, ends[1:] + [None]):
        # A leg along x is left to the goal of the leg along y that follows it.
        if end[1] != here[1] or after is None:
            kept.append(end)
        here = end
    return kept


def elbow(start: Point, goal: Point) -> list[Point]:
    """Returns the grid points that a single `/mov` passes from start to goal, both included."""
    (x0, y0), (x1, y1) = point(start), point(goal)
    along_x = [(x, y0) for x in _count(x0, x1)]
    return along_x + [(x1, y) for y in _count(y0, y1)][1:]


def _count(a: int, b: int) -> range:
    return range(a, b + 1) if b >= a else range(a, b - 1, -1)
