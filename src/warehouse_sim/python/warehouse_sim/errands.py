# SPDX-License-Identifier: Apache-2.0
"""Plans for two robots: their storage units, their belts, and an aisle in which they meet.

A cell is (column, row). Robots go as the actions of warehouse_msgs do: along x first, then along y.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations, product

from warehouse_client.routes import STEPS, NoRouteError, Point, elbow

MAX_ROBOTS = 6  # candidates of which two are chosen; more are not worth their time
MAX_ERRANDS = 400
AISLE = 5  # cells that two robots need to meet head on and see each other in time


@dataclass(frozen=True)
class Errand:
    """A robot fetches a storage unit, puts it down at a belt, and leaves it."""

    robot: int
    unit: int
    belt: str
    to_unit: list[Point]
    to_belt: list[Point]

    @property
    def way(self) -> list[Point]:
        """The cells from the robot over the unit to the belt."""
        return self.to_unit + self.to_belt[1:]

    @property
    def exit(self) -> Point:
        """The cell before the last, to which the robot leaves."""
        return self.to_belt[-2]


@dataclass(frozen=True)
class Chart:
    """The cells of a floor, and where robots and storage units stand, by number."""

    passable: set[Point]
    robots: dict[int, Point]
    units: dict[int, Point]

    def free(self, without: int | None = None) -> set[Point]:
        """Returns the cells free of robots other than `without`."""
        return self.passable - {cell for n, cell in self.robots.items() if n != without}


def two_errands(chart: Chart, belts: Mapping[str, Point]) -> list[Errand]:
    """Returns the two shortest errands that can be done at once; `belts`: the cells for units.

    Their ways are at least two cells apart: neighbours that turn at once would touch. Raises
    NoRouteError if there is no such pair.
    """
    errands = sorted(_all_errands(chart, belts), key=lambda e: len(e.way))[:MAX_ERRANDS]
    pairs = [pair for pair in combinations(errands, 2) if _are_apart(*pair)]
    if not pairs:
        raise NoRouteError("no two robots can fetch two storage units at once here")
    best = min(pairs, key=lambda pair: len(pair[0].way) + len(pair[1].way))
    return sorted(best, key=lambda errand: errand.robot)


def _all_errands(chart: Chart, belts: Mapping[str, Point]) -> Iterable[Errand]:
    for robot, start in sorted(chart.robots.items())[:MAX_ROBOTS]:
        unloaded = chart.free(without=robot)
        loaded = unloaded - set(chart.units.values())
        for unit, cell in chart.units.items():
            to_unit = elbow(start, cell)
            if not unloaded.issuperset(to_unit):
                continue
            for belt, end in belts.items():
                to_belt = elbow(cell, end)
                if len(to_belt) > 1 and loaded.issuperset(to_belt[1:]):
                    yield Errand(robot, unit, belt, to_unit, to_belt)


def _are_apart(a: Errand, b: Errand) -> bool:
    near = {(x + dx, y + dy) for x, y in a.way for dx, dy in (*STEPS, (0, 0))}
    return near.isdisjoint(b.way)


def meeting(free: set[Point], a: Point, b: Point) -> tuple[Point, Point]:
    """Returns the ends of a free straight aisle, near to the cells a and b. Raises NoRouteError."""
    reach = AISLE - 1
    aisles = (
        ((x, y), (x + dx * reach, y + dy * reach)) for (x, y), (dx, dy) in product(free, STEPS)
    )
    ends = [aisle for aisle in aisles if free.issuperset(elbow(*aisle))]
    if not ends:
        raise NoRouteError("no aisle is long enough for two robots to meet in")
    return min(ends, key=lambda end: (math.dist(a, end[0]) + math.dist(b, end[1]), end))
