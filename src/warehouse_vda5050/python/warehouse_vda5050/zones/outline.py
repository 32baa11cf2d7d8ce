# SPDX-License-Identifier: Apache-2.0
"""The geometry of a zone's polygon, convex or not: whether a robot or its way is within it."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from warehouse_vda5050.zones.zone import Point

LEAST_AREA = 1e-4  # of an overlap that is more than a touch [m²]
LEAST_LENGTH = 1e-3  # of a way within a polygon [m]


@dataclass(frozen=True)
class Box:
    """A rectangle around x, y that is turned by yaw [m, rad]."""

    x: float
    y: float
    yaw: float
    length: float
    width: float


def overlaps(polygon: Sequence[Point], box: Box) -> bool:
    """Returns whether a box covers a part of a polygon."""
    c, s = math.cos(box.yaw), math.sin(box.yaw)
    moved = [(x - box.x, y - box.y) for x, y in polygon]
    rest = [(c * x + s * y, c * y - s * x) for x, y in moved]
    for axis, half in ((0, box.length / 2), (1, box.width / 2)):
        for sign in (1, -1):
            rest = _cut(rest, axis, sign, half)
    return abs(area(rest)) > LEAST_AREA


def _cut(polygon: list[Point], axis: int, sign: int, half: float) -> list[Point]:
    """Returns the part of a polygon within half a side of a box (Sutherland and Hodgman, 1974)."""
    kept: list[Point] = []
    for a, b in _sides(polygon):
        before, after = half - sign * a[axis], half - sign * b[axis]
        if before >= 0:
            kept.append(a)
        if (before >= 0) != (after >= 0):
            share = before / (before - after)
            kept.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
    return kept


def area(polygon: Sequence[Point]) -> float:
    """Returns the area of a polygon, above 0 if its vertices are counterclockwise [m²]."""
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in _sides(polygon)) / 2


def _sides(polygon: Sequence[Point]) -> list[tuple[Point, Point]]:
    return list(zip(polygon, [*polygon[1:], *polygon[:1]]))


def is_near(polygon: Sequence[Point], point: Point, radius: float) -> bool:
    """Returns whether a disc covers a part of a polygon."""
    if contains(polygon, point):
        return True
    return any(_distance(point, a, b) < radius - 1e-6 for a, b in _sides(polygon))


def contains(polygon: Sequence[Point], point: Point) -> bool:
    """Returns whether a point is within a polygon."""
    x, y = point
    inside = False
    for (ax, ay), (bx, by) in _sides(polygon):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            inside = not inside
    return inside


def _distance(point: Point, a: Point, b: Point) -> float:
    ax, ay = b[0] - a[0], b[1] - a[1]
    square = ax * ax + ay * ay
    share = ((point[0] - a[0]) * ax + (point[1] - a[1]) * ay) / square if square else 0.0
    share = min(1.0, max(0.0, share))
    return math.dist(point, (a[0] + share * ax, a[1] + share * ay))


def passes(polygon: Sequence[Point], start: Point, end: Point) -> bool:
    """Returns whether a straight way leads through a polygon."""
    length = math.dist(start, end)
    shares = sorted({0.0, 1.0, *_crossings(polygon, start, end)})
    for a, b in itertools.pairwise(shares):
        middle = (a + b) / 2
        point = tuple(s + middle * (e - s) for s, e in zip(start, end))
        if (b - a) * length > LEAST_LENGTH and contains(polygon, (point[0], point[1])):
            return True
    return False


def _crossings(polygon: Sequence[Point], start: Point, end: Point) -> list[float]:
    """Returns where a way crosses sides of a polygon, as shares of its length."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    shares: list[float] = []
    for a, b in _sides(polygon):
        sx, sy = b[0] - a[0], b[1] - a[1]
        cross = dx * sy - dy * sx
        if abs(cross) < 1e-12:
            continue
        way = ((a[0] - start[0]) * sy - (a[1] - start[1]) * sx) / cross
        if 0 < way < 1:
            shares.append(way)
    return shares
