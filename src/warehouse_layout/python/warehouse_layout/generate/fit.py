# SPDX-License-Identifier: Apache-2.0
"""Fits a warehouse onto the free cells of the floor of another world.

It stands in one Region of the floor (rooms.py), on a Site there (sites.py). Stations, for which
streets must be without dead ends, take a block and the street below it, where all of it is free:

    │ x x x x x x
    │           s ==        q  queue, s  service cell, x  the way back, ==  belt
    │ q q q q q

Where there is no room for that, stations are bays without a queue; see hall.py.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from warehouse_layout.file import items as shelves
from warehouse_layout.file.request import Request, RequestError, proportioned
from warehouse_layout.floor.floor_plan import ALL_EXITS, FloorError, FloorPlan
from warehouse_layout.floor.masks import shifted
from warehouse_layout.floor.stations import PICK, REPLENISH, STEPS, Station, lane_mask
from warehouse_layout.generate import hall, rooms, sites
from warehouse_layout.generate.blocks import places_for
from warehouse_layout.generate.cells import Cells
from warehouse_layout.generate.sites import Ground, Site
from warehouse_layout.place.layout import SEED, Layout, chance

WIDE = 3000  # free cells, on which a few shifts of the pattern are as good as all
# From a drop point to the centre of a belt of 1.8 m that begins 0.1 m beyond its cell [m].
TO_BELT = 1.5
ENOUGH = 0.5  # share of the storage units that would fit without lanes: enough with lanes

Finder = Callable[[Ground, int], Iterator[Site]]


def fit(request: Request, cells: Cells, seed: int = SEED, at: rooms.Point | None = None) -> Layout:
    """Returns the Layout of a resolved Request on free Cells, as generated.plan() does.

    The warehouse goes into the largest room, or to the point `at`, (x, y) in `world` [m]. Where
    there is no room even for bays, the belts are at the ends of streets, and the Layout has no
    plan. Raises RequestError if there are too few cells.
    """
    ground = Ground(cells, rooms.choose(cells, at))
    most = 0
    tried: Sequence[Finder] = (
        sites.with_lanes,
        sites.with_bays,
        sites.with_picking_alone,
        sites.with_dead_ends,
    )
    if request.robots + request.shelves > ground.free.sum():
        tried = tried[-1:]  # it can't fit, and only the figures of the refusal are wanted
    for find in tried:
        for site in find(ground, request.belts):
            layout = _laid_out(ground, site, request, seed)
            if layout:
                return layout
            most = max(most, len(site.places))
    raise RequestError(_refusal(request, ground, most))


def fit_largest(
    cells: Cells, seed: int = SEED, at: rooms.Point | None = None
) -> tuple[Request, Layout]:
    """Returns Request and Layout of the largest warehouse in sensible proportions that fits.

    Its stations have lanes, unless more than twice as much fits without them. Raises RequestError
    where no warehouse fits. `at` is as for fit().
    """
    ground = Ground(cells, rooms.choose(cells, at))
    largest = _largest(ground, seed)
    if not largest:
        raise RequestError(f"no warehouse fits {ground.region.name}")
    return largest


def _largest(ground: Ground, seed: int) -> tuple[Request, Layout] | None:
    largest: tuple[Request, Layout] | None = None
    if ground.free.sum() > WIDE:
        ground.shifts = sites.SHIFTS[::5]
    picks = proportioned(int(ground.free.sum()) // 2).belts
    finders: Sequence[Finder] = (sites.with_picking_alone, sites.with_bays, sites.with_lanes)
    for find in finders:
        least = largest[0].shelves * ENOUGH if largest else 0
        for count in sorted({picks, -(-picks // 2), -(-picks // 4), 1}, reverse=True):
            best = _best(find(ground, count), ground, seed, least)
            if best:
                largest = best
                break
    return largest


def _best(
    candidates: Iterable[Site], ground: Ground, seed: int, least: float
) -> tuple[Request, Layout] | None:
    """Returns Request and Layout of the Site with the most storage units; None if below `least`."""
    asked = [
        (proportioned(len(s.places), int(s.streets.sum()) // hall.STREETS_A_ROBOT, len(s.drops)), s)
        for s in candidates
    ]
    for request, site in sorted(asked, key=lambda candidate: -candidate[0].shelves):
        if request.shelves < max(least, 1):
            return None
        layout = _laid_out(ground, site, request, seed)
        if layout:
            return request, layout
    return None


def _refusal(request: Request, ground: Ground, most: int) -> str:
    text = (
        f"{request} don't fit: of {ground.free.sum()} free cells, {most} are left for robots and"
        f" storage units beside streets and stations, {ground.region.name}"
    )
    largest = _largest(ground, SEED)
    if not largest:
        return f"{text}; nothing else fits there"
    less = largest[0]
    return (
        f"{text}; {less.robots} robots, {less.shelves} storage units fit: size:=fit takes that,"
        " at:=x,y another place"
    )


def _laid_out(ground: Ground, site: Site, request: Request, seed: int) -> Layout | None:
    """Returns the Layout of a Request on a Site; None if it does not fit."""
    rng = chance(seed)
    count = request.shelves + request.robots
    if len(site.places) < count:
        return None
    drops = site.drops if site.has_plan else _ends(ground, site, request.belts, count)
    if drops is None:
        return None
    spare = min(len(site.places) - count, places_for(request.shelves) - request.shelves)
    places, robots = np.split(site.places[: count + spare], [request.shelves + spare])
    units = places[: request.shelves] if rng is None else rng.permutation(places)
    robots = robots if rng is None else rng.permutation(robots)
    item_unit, item_place = shelves.spread(request.items, request.shelves, rng)
    try:
        plan = _plan(ground, site, places, robots) if site.has_plan else None
    except FloorError:
        return None
    before, towards = ground.world(drops), np.reshape([STEPS[h] for h in site.headings], (-1, 2))
    yaws = [h * math.pi / 2 for h in site.headings]
    return Layout(
        floor=ground.cells.floor,
        robots=np.column_stack([ground.world(robots), [_yaw(site.streets, c) for c in robots]]),
        units=ground.world(units[: request.shelves]),
        places=ground.world(places),
        item_unit=item_unit,
        item_place=item_place,
        belts=np.column_stack([before + TO_BELT * towards, yaws]),
        drops=before,
        plan=plan,
        has_own_floor=False,
        where=ground.region.name,
    )


def _plan(ground: Ground, site: Site, places: np.ndarray, robots: np.ndarray) -> FloorPlan:
    """Returns the FloorPlan, whose arrays are (y, x). Raises FloorError if it is not safe."""
    storage, parking = (np.zeros_like(site.streets) for _ in range(2))
    storage[tuple(places.T)] = True
    parking[tuple(robots.T)] = True
    storage, parking, streets = map(ground.whole, (storage, parking, site.streets))
    passable = streets | storage | parking
    stations = list(_stations(site, ground.low, passable.shape[0]))
    plan = FloorPlan.laid_out(
        origin=(ground.cells.x, ground.cells.y),
        spacing=1.0,
        passable=passable.T | lane_mask(stations, passable.T.shape),
        storage=storage.T,
        parking=parking.T,
        exits=np.full(passable.T.shape, ALL_EXITS, np.uint8),
        stations=stations,
    )
    plan.check()
    return plan


def _stations(site: Site, low: np.ndarray, width: int) -> Iterator[Station]:
    for n, lane in enumerate(site.lanes):
        cells = np.array([(y + low[1]) * width + x + low[0] for x, y in lane], np.int32)
        service = len(cells) // 2
        k = n - len(site.drops)
        if k < 0:
            yield Station(f"pick{n + 1}", PICK, cells, service, f"conveyor_belt{n + 1}")
        else:
            yield Station(f"replenish{k + 1}", REPLENISH, cells, service)


def _ends(ground: Ground, site: Site, count: int, used: int) -> np.ndarray | None:
    """Returns cells of streets with room for a belt of two cells along x; None if too few.

    The first `used` places of the site are taken.
    """
    taken = site.places[:used]
    room = ground.free & ~site.streets
    room[tuple(taken.T)] = False
    ends = site.streets & shifted(room, (-1, 0)) & shifted(room, (-2, 0))
    drops = np.argwhere(ends)
    middle = taken.mean(0) if len(taken) else (0, 0)
    drops = drops[np.argsort(((drops - middle) ** 2).sum(1), kind="stable")][:count]
    return drops if len(drops) == count else None


def _yaw(streets: np.ndarray, cell: np.ndarray) -> float:
    """Returns the heading [rad] towards the street beside a cell."""
    for dx, dy in STEPS:
        i, j = cell[0] + dx, cell[1] + dy
        inside = 0 <= i < streets.shape[0] and 0 <= j < streets.shape[1]
        if inside and streets[i, j]:
            return np.arctan2(dy, dx)
    return 0.0
