# SPDX-License-Identifier: Apache-2.0
"""Plans for a few robots: who fetches which storage unit, by which way, and where two can meet.

Grid points are (x, y) in whole metres; a route is a list of them, both ends included.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

from warehouse_client.routes import STEPS, Grid, NoRouteError, covered, point, route
from warehouse_client.survey import BELT, Survey
from warehouse_layout.place.layout import Floor

# So many robots, units of each and belts of each unit are tried; the optimum is not needed.
TRIES = 6
CORRIDOR = 5  # cells two robots need to meet head on and see each other in time

Point = tuple[int, int]  # on the grid [m]


@dataclass(frozen=True)
class Mission:
    """A robot fetches a unit, puts it down at a belt, and leaves it."""

    kiva: int
    unit: int
    belt: int
    to_unit: list[Point]
    to_drop: list[Point]

    @property
    def out(self) -> Point:
        """The point before the drop point, to which the robot leaves."""
        return self.to_drop[-2]

    @property
    def cells(self) -> set[Point]:
        """The points of both its ways [m]."""
        return {*self.to_unit, *self.to_drop}

    @property
    def length(self) -> int:
        """How many points both its ways have."""
        return len(self.to_unit) + len(self.to_drop)


class Map:
    """Where robots may go, with a load and without, in a survey.Survey.

    Where the `floor` is not known, it is taken to reach a step beyond what stands on it.
    """

    def __init__(self, survey: Survey, floor: Floor | None = None) -> None:
        self.robots = {number: point(pose) for number, pose in survey.kiva.items()}
        self.headings = {number: _step(pose[2]) for number, pose in survey.kiva.items()}
        self.units = {number: point(pose) for number, pose in survey.storage_unit.items()}
        self.fixed = survey.obstacles()
        self.floor = floor or _bounds({*self.robots.values(), *self.units.values(), *self.fixed})
        self.drops = {n: _drop(pose, self.grid()) for n, pose in survey.conveyor_belt.items()}

    def grid(
        self,
        without: Collection[int] = (),
        loaded_from: Point | None = None,
        also: Iterable[Point] = (),
    ) -> Grid:
        """Returns the grid for a robot without a load, or with that from the point `loaded_from`.

        The robots `without` are no obstacles; the points `also` are.
        """
        others = [p for number, p in self.robots.items() if number not in without]
        units = set(self.units.values()) - {loaded_from} if loaded_from else set()
        return Grid(self.floor, {*self.fixed, *others, *units, *also})


def _step(yaw: float) -> tuple[int, int]:
    return round(math.cos(yaw)), round(math.sin(yaw))


def _bounds(points: Iterable[Point]) -> Floor:
    xs, ys = zip(*points)
    return Floor(min(xs) - 1.5, max(xs) + 1.5, min(ys) - 1.5, max(ys) + 1.5)


def _drop(belt: tuple[float, float, float], grid: Grid) -> Point | None:
    """The free point before one end of a belt (x, y, yaw), or None."""
    x, y, yaw = belt
    cells = set(covered(x, y, yaw, *BELT))
    for way in (-1, 1):
        steps = ((way * i / 2 * math.cos(yaw), way * i / 2 * math.sin(yaw)) for i in range(1, 9))
        beyond = next(p for p in (point((x + dx, y + dy)) for dx, dy in steps) if p not in cells)
        if grid.free(beyond):
            return beyond
    return None


def two_missions(chart: Map) -> list[Mission]:
    """Returns the two shortest missions that can be driven at once: their ways share no cell.

    Raises NoRouteError if there is no such pair on the Map.
    """
    missions = sorted(_all_missions(chart), key=lambda m: m.length)
    pairs = (pair for pair in combinations(missions, 2) if _apart(*pair))
    best = min(pairs, key=lambda pair: pair[0].length + pair[1].length, default=None)
    if not best:
        raise NoRouteError("no two robots can fetch two storage units at once here")
    return sorted(best, key=lambda m: m.kiva)


def _apart(a: Mission, b: Mission) -> bool:
    """Whether two missions have nothing in common."""
    differ = a.kiva != b.kiva and a.unit != b.unit and a.belt != b.belt
    # Two units that turn side by side touch: half their diagonals make 1.13 m.
    return differ and a.cells.isdisjoint(b.cells) and _beside(a.to_drop).isdisjoint(b.to_drop)


def _beside(points: Iterable[Point]) -> set[Point]:
    return {(x + dx, y + dy) for x, y in points for dx, dy in STEPS}


def _all_missions(chart: Map) -> Iterator[Mission]:
    drops = {belt: drop for belt, drop in chart.drops.items() if drop}
    for kiva, start in sorted(chart.robots.items())[:TRIES]:
        for unit in _nearest(chart.units, start):
            for belt in _nearest(drops, chart.units[unit]):
                mission = _mission(chart, kiva, unit, belt)
                if mission:
                    yield mission


def _nearest(points: Mapping[int, Point], start: Point) -> list[int]:
    """Numbers of the points nearest to the start."""
    return sorted(points, key=lambda number: math.dist(start, points[number]))[:TRIES]


def _mission(chart: Map, kiva: int, unit: int, belt: int) -> Mission | None:
    """None where there is no way."""
    at, drop = chart.units[unit], chart.drops[belt]
    if drop is None:
        return None
    try:
        to_unit = _leave(chart.grid([kiva]), chart.robots[kiva], chart.headings[kiva], at)
        to_drop = route(chart.grid([kiva], loaded_from=at), at, drop)
    except NoRouteError:
        return None
    return Mission(kiva, unit, belt, to_unit, to_drop)


def _leave(grid: Grid, start: Point, heading: tuple[int, int], goal: Point) -> list[Point]:
    """A route that begins with a step ahead, if it can.

    Two robots parked back to back clear each other by 6 mm where both turn at once.
    """
    ahead = (start[0] + heading[0], start[1] + heading[1])
    if grid.free(ahead) and start != goal:
        return [start] + route(grid, ahead, goal, heading)
    return route(grid, start, goal)


def meeting(grid: Grid, a: Point, b: Point) -> tuple[Point, Point]:
    """Returns two ends of a free straight corridor, near to the points a and b.

    Raises NoRouteError.
    """
    runs = [run for p in _free_points(grid) for run in _corridors(grid, p)]
    ends = [(run[0], run[-1]) for run in runs] + [(run[-1], run[0]) for run in runs]
    if not ends:
        raise NoRouteError("no aisle is long enough for two robots to meet in")
    return min(ends, key=lambda e: math.dist(a, e[0]) + math.dist(b, e[1]))


def _free_points(grid: Grid) -> list[Point]:
    return [(x, y) for x in grid.x for y in grid.y if grid.free((x, y))]


def _corridors(grid: Grid, start: Point) -> Iterator[list[Point]]:
    """Free points in a row from `start`, along x and along y, as far as they go."""
    for dx, dy in STEPS[:2]:
        run = [start]
        while grid.free((run[-1][0] + dx, run[-1][1] + dy)):
            run.append((run[-1][0] + dx, run[-1][1] + dy))
            if len(run) >= CORRIDOR:
                yield list(run)
