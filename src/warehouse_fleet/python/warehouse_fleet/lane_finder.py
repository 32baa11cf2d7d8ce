# SPDX-License-Identifier: Apache-2.0
"""Lanes on a floor without markings: found where belts and room permit.

Before a belt's side or end, seen with the belt to the right (q queue, s service, x exit):

    straight         around a corner      there and back
        q
        q                      x                  x x x x x x
        s ==            q q q  s ==               q q q q q s ==
        x
"""

from dataclasses import replace

import numpy as np

from warehouse_fleet._core import check_layout
from warehouse_fleet.stations import PICK, STEPS, Station, lane_mask, neighbour

QUEUE = 5  # cells, the entry among them


def find(plan, belts, belt_cells):
    """The FloorPlan with a PICK station at every belt that has room for one; the others are named
    in `without_lane`, with the reason. `belts` is {name: (x, y)} [m], `belt_cells` (h, w) bool."""
    plan = _without_dead_ends(plan)
    before = _faults(plan)
    stations, without = [], []
    for name, (x, y) in belts.items():
        found, reason = None, "no cell beside it is free"
        for lane, service in _candidates(plan, stations, (x, y), belt_cells):
            station = Station(f"pick{len(stations) + 1}", PICK, lane, service, name)
            if _faults(_with(plan, [*stations, station])) <= before:
                found = station
                break
            reason = "every lane there would cut cells off from the other streets"
        else:
            reason = _why(plan, stations, (x, y), belt_cells) or reason
        if found:
            stations.append(found)
        else:
            without.append(f"{name} at ({x:g}, {y:g}) has no lane: {reason}")
    return replace(_with(plan, stations), without_lane=tuple(without))


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
    return len(check_layout(plan.floor()))


def _without_dead_ends(plan):
    """What leads nowhere is for robots without a load alone: there two could not pass."""
    streets = plan.passable & ~plan.storage & ~plan.parking
    kept = streets.copy()
    while True:
        ways = sum(neighbour(kept, heading).astype(int) for heading in range(4))
        dead = kept & (ways < 2)
        if not dead.any():
            break
        kept &= ~dead
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
    services = list(_services(plan, streets, at, belt_cells))
    for shape in (_straight, _corner, _back):
        for service, heading in services:
            for side in (1, -1):
                points = shape(np.array(service), np.array(STEPS[heading]), side)
                if _are_free(points, streets):
                    x, y = np.array(points).T
                    yield (y * plan.width + x).astype(np.int32), QUEUE


def _straight(service, towards, side):
    along = side * towards[::-1]
    return [service + i * along for i in range(-QUEUE, 2)]


def _corner(service, towards, side):
    along = side * towards[::-1]
    return [*(service + i * towards for i in range(-QUEUE, 1)), service + along]


def _back(service, towards, side):
    there = [service + i * towards for i in range(-QUEUE, 1)]
    return [*there, *(p + side * towards[::-1] for p in there[::-1])]


def _are_free(points, streets):
    height, width = streets.shape
    return all(0 <= x < width and 0 <= y < height and streets[y, x] for x, y in points)


def _why(plan, stations, at, belt_cells):
    """Which cells a straight lane lacks where it lacks the fewest; "" if none lacks any."""
    streets, least = _streets(plan, stations), None
    height, width = streets.shape
    for service, heading in _services(plan, streets, at, belt_cells):
        for shape in (_straight, _corner, _back):
            for side in (1, -1):
                lacking = [
                    (int(x), int(y))
                    for x, y in shape(np.array(service), np.array(STEPS[heading]), side)
                    if not (0 <= x < width and 0 <= y < height and streets[y, x])
                ]
                if least is None or len(lacking) < len(least):
                    least = lacking
    if not least:
        return ""
    points = [plan.point_of(y * width + x) for x, y in least]
    return "it would need " + ", ".join(f"({x:g}, {y:g})" for x, y in points)
