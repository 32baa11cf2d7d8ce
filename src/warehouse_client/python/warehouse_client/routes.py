# SPDX-License-Identifier: Apache-2.0
"""Grid points: the nearest to a position, those that a body covers, those that `/mov` passes."""

import math
from collections.abc import Sequence

Point = tuple[int, int]


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


def elbow(start: Point, goal: Point) -> list[Point]:
    """Returns the grid points that a single `/mov` passes from start to goal, both included."""
    (x0, y0), (x1, y1) = point(start), point(goal)
    along_x = [(x, y0) for x in _count(x0, x1)]
    return along_x + [(x1, y) for y in _count(y0, y1)][1:]


def _count(a: int, b: int) -> range:
    return range(a, b + 1) if b >= a else range(a, b - 1, -1)
