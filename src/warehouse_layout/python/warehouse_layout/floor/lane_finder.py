# SPDX-License-Identifier: Apache-2.0
"""Finds lanes on a floor without markings, where belts and room permit.

Before a belt's side or end, seen with the belt to the right (q queue, s service, x exit):

    straight      there and back      around a corner
        q           x x x x x                     x
        q                   s ==                  s ==
        s ==        q q q q q             q q q q q
        x
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from warehouse_layout._core import check_layout
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import PICK, STEPS, Station, lane_mask, neighbour
from warehouse_layout.floor.street_graph import without_dead_ends

CUTS = "every lane there would cut others off from the streets, or no cell beside it is free"
QUEUE = 6  # cells, the entry and a corner among them

Point = Sequence[float]  # x, y [m]
Cell = tuple[int, int]  # x, y
Shape = Callable[[np.ndarray, np.ndarray, int, int], list[np.ndarray]]  # see _straight


def find(plan: FloorPlan, belts: Mapping[str, Point], belt_cells: np.ndarray) -> FloorPlan:
    """Returns the FloorPlan with a PICK station at every belt that has room for one.

    Its `without_lane` names the other belts, with the reason. `belts` is {name: (x, y)} [m],
    `belt_cells` (h, w) bool.
    """
    plan = _without_dead_ends(plan)
    before = _faults(plan)
    stations: list[Station] = []
    without = []
    for name, at in belts.items():
        station = _station(plan, stations, name, at, belt_cells, before)
        if station:
            stations.append(station)
            continue
        reason = _why(plan, stations, at, belt_cells) or CUTS
        without.append(f"{name} at ({at[0]:g}, {at[1]:g}) has no lane: {reason}")
    return replace(_with(plan, stations), without_lane=tuple(without))


def _station(
    plan: FloorPlan,
    stations: Sequence[Station],
    belt: str,
    at: Point,
    belt_cells: np.ndarray,
    faults: set[str],
) -> Station | None:
    """Returns a station on the first lane there that adds no fault to the floor, or None."""
    for lane, service in _candidates(plan, stations, at, belt_cells):
        station = Station(f"pick{len(stations) + 1}", PICK, lane, service, belt)
        if _faults(_with(plan, [*stations, station])) <= faults:
            return station
    return None


def _with(plan: FloorPlan, stations: Iterable[Station]) -> FloorPlan:
    return FloorPlan.laid_out(
        origin=plan.origin,
        spacing=plan.spacing,
        passable=plan.passable,
        storage=plan.storage,
        parking=plan.parking,
        exits=plan.exits,
        stations=stations,
    )


def _faults(plan: FloorPlan) -> set[str]:
    return set(check_layout(plan.floor()))


def _without_dead_ends(plan: FloorPlan) -> FloorPlan:
    """Keeps loaded robots out of dead ends, where two could not pass each other."""
    streets = plan.passable & ~plan.storage & ~plan.parking
    kept = without_dead_ends(streets)
    return replace(plan, parking=plan.parking | (streets & ~kept))


def _streets(plan: FloorPlan, stations: Iterable[Station]) -> np.ndarray:
    return plan.passable & ~plan.storage & ~plan.parking & ~lane_mask(stations, plan.shape)


def _services(
    plan: FloorPlan, streets: np.ndarray, at: Point, belt_cells: np.ndarray
) -> Iterator[tuple[Cell, int]]:
    """Yields cells (x, y) of streets beside the belt there, each with the heading towards it."""
    column, row = (round((p - o) / plan.spacing) for p, o in zip(at, plan.origin))
    near = np.zeros_like(belt_cells)
    near[max(row - 2, 0) : row + 3, max(column - 2, 0) : column + 3] = True
    own = belt_cells & near
    for heading in range(4):
        for y, x in np.argwhere(streets & neighbour(own, heading)).tolist():
            yield (x, y), heading


def _candidates(
    plan: FloorPlan, stations: Sequence[Station], at: Point, belt_cells: np.ndarray
) -> Iterator[tuple[np.ndarray, int]]:
    """Yields lanes as (cells, index of the service cell), the smoothest first."""
    streets = _streets(plan, stations)
    for points in _shapes(plan, streets, at, belt_cells):
        if not _lacking(points, streets):
            x, y = np.array(points).T
            yield (y * plan.width + x).astype(np.int32), QUEUE


def _shapes(
    plan: FloorPlan, streets: np.ndarray, at: Point, belt_cells: np.ndarray
) -> Iterator[list[Cell]]:
    """Yields the points (x, y) of each conceivable lane, in cells."""
    services = list(_services(plan, streets, at, belt_cells))
    for shape in SHAPES:
        for service, heading in services:
            yield from _both_ways(shape, service, heading, QUEUE)


def lanes_past(service: Cell, headings: Iterable[int], queue: int) -> Iterator[list[Cell]]:
    """Yields the cells of each conceivable lane past a service cell, in driving order.

    `headings` are those in which its belt can be; `queue` is the number of cells before the service
    cell.
    """
    for shape in SHAPES:
        for heading in headings:
            yield from _both_ways(shape, service, heading, queue)


def _both_ways(shape: Shape, service: Cell, heading: int, queue: int) -> Iterator[list[Cell]]:
    for side in (1, -1):
        points = shape(np.array(service), np.array(STEPS[heading]), side, queue)
        yield [(int(x), int(y)) for x, y in points]


def _straight(service: np.ndarray, towards: np.ndarray, side: int, queue: int) -> list[np.ndarray]:
    """Returns a lane on which units pass the belt without turning."""
    along = side * towards[::-1]
    return [service + i * along for i in range(-queue, 2)]


def _back(service: np.ndarray, towards: np.ndarray, side: int, queue: int) -> list[np.ndarray]:
    """Returns a lane on which units turn before the belt and after it."""
    along = side * towards[::-1]
    there = [service - along - i * towards for i in range(queue)]
    return [*there[::-1], service, *(point + 2 * along for point in there)]


def _corner(service: np.ndarray, towards: np.ndarray, side: int, queue: int) -> list[np.ndarray]:
    """Returns a lane on which units turn before the belt and go straight on after it."""
    along = side * towards[::-1]
    there = [service - along - i * towards for i in range(queue)]
    return [*there[::-1], service, service + along]


SHAPES: tuple[Shape, ...] = (_straight, _back, _corner)


def _lacking(points: Iterable[Cell], streets: np.ndarray) -> list[Cell]:
    """Returns the points that are no streets."""
    height, width = streets.shape
    return [
        (int(x), int(y))
        for x, y in points
        if not (0 <= x < width and 0 <= y < height and streets[y, x])
    ]


def _why(plan: FloorPlan, stations: Sequence[Station], at: Point, belt_cells: np.ndarray) -> str:
    """Names the cells that are missing for the best conceivable lane; "" if one lacks none."""
    streets = _streets(plan, stations)
    least: list[Cell] = min(
        (_lacking(points, streets) for points in _shapes(plan, streets, at, belt_cells)),
        key=len,
        default=[],
    )
    points = [plan.point_of(y * plan.width + x) for x, y in least]
    return "it would need " + ", ".join(f"({x:g}, {y:g})" for x, y in points) if points else ""
