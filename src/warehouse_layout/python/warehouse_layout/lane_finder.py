# SPDX-License-Identifier: Apache-2.0
"""Lanes on a floor without markings: found where belts and room permit.

Before a belt's side or end, seen with the belt to the right (q queue, s service, x exit):

    straight      there and back      around a corner
        q           x x x x x                     x
        q                   s ==                  s ==
        s ==        q q q q q             q q q q q
        x
"""

from dataclasses import replace

import numpy as np

from warehouse_layout._core import check_layout
from warehouse_layout.stations import PICK, STEPS, Station, lane_mask, neighbour
from warehouse_layout.street_graph import without_dead_ends

CUTS = "every lane there would cut others off from the streets, or no cell beside it is free"
QUEUE = 6  # cells, the entry and a corner among them


def find(plan, belts, belt_cells):
    """The FloorPlan with a PICK station at every belt that has room for one; the others are named
    in `without_lane`, with the reason. `belts` is {name: (x, y)} [m], `belt_cells` (h, w) bool."""
    plan = _without_dead_ends(plan)
    before = _faults(plan)
    stations, without = [], []
    for name, at in belts.items():
        station = _station(plan, stations, name, at, belt_cells, before)
        if station:
            stations.append(station)
            continue
        reason = _why(plan, stations, at, belt_cells) or CUTS
        without.append(f"{name} at ({at[0]:g}, {at[1]:g}) has no lane: {reason}")
    return replace(_with(plan, stations), without_lane=tuple(without))


def _station(plan, stations, belt, at, belt_cells, faults):
    """The first lane there with which the floor has no fault that it had not before, or None."""
    for lane, service in _candidates(plan, stations, at, belt_cells):
        station = Station(f"pick{len(stations) + 1}", PICK, lane, service, belt)
        if _faults(_with(plan, [*stations, station])) <= faults:
            return station
    return None


def _with(plan, stations):
    return type(plan).laid_out(
        origin=plan.origin,
        spacing=plan.spacing,
        passable=plan.passable,
        storage=plan.storage,
        parking=plan.parking,
        exits=plan.exits,
        stations=stations,
    )


def _faults(plan):
    return set(check_layout(plan.floor()))


def _without_dead_ends(plan):
    """What leads nowhere is for robots without a load alone: there two could not pass."""
    streets = plan.passable & ~plan.storage & ~plan.parking
    kept = without_dead_ends(streets)
    return replace(plan, parking=plan.parking | (streets & ~kept))


def _streets(plan, stations):
    return plan.passable & ~plan.storage & ~plan.parking & ~lane_mask(stations, plan.shape)


def _services(plan, streets, at, belt_cells):
    """Cells of streets beside the belt there, (x, y), each with the heading towards it."""
    column, row = (round((p - o) / plan.spacing) for p, o in zip(at, plan.origin))
    near = np.zeros_like(belt_cells)
    near[max(row - 2, 0) : row + 3, max(column - 2, 0) : column + 3] = True
    own = belt_cells & near
    for heading in range(4):
        for y, x in np.argwhere(streets & neighbour(own, heading)).tolist():
            yield (x, y), heading


def _candidates(plan, stations, at, belt_cells):
    """Pairs (cells, index of the service cell), the smoothest first."""
    streets = _streets(plan, stations)
    for points in _shapes(plan, streets, at, belt_cells):
        if not _lacking(points, streets):
            x, y = np.array(points).T
            yield (y * plan.width + x).astype(np.int32), QUEUE


def _shapes(plan, streets, at, belt_cells):
    """Lists of points (x, y) in cells."""
    services = list(_services(plan, streets, at, belt_cells))
    for shape in (_straight, _back, _corner):
        for service, heading in services:
            for side in (1, -1):
                yield shape(np.array(service), np.array(STEPS[heading]), side)


def _straight(service, towards, side):
    """Units pass the belt without turning."""
    along = side * towards[::-1]
    return [service + i * along for i in range(-QUEUE, 2)]


def _back(service, towards, side):
    """They turn before and after it."""
    along = side * towards[::-1]
    there = [service - along - i * towards for i in range(QUEUE)]
    return [*there[::-1], service, *(point + 2 * along for point in there)]


def _corner(service, towards, side):
    along = side * towards[::-1]
    there = [service - along - i * towards for i in range(QUEUE)]
    return [*there[::-1], service, service + along]


def _lacking(points, streets):
    """Those that are not free."""
    height, width = streets.shape
    return [
        (int(x), int(y))
        for x, y in points
        if not (0 <= x < width and 0 <= y < height and streets[y, x])
    ]


def _why(plan, stations, at, belt_cells):
    """Which cells the lane lacks that lacks the fewest; "" if none lacks any."""
    streets = _streets(plan, stations)
    least = min(
        (_lacking(points, streets) for points in _shapes(plan, streets, at, belt_cells)),
        key=len,
        default=[],
    )
    points = [plan.point_of(y * plan.width + x) for x, y in least]
    return "it would need " + ", ".join(f"({x:g}, {y:g})" for x, y in points) if points else ""
