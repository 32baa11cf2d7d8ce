# SPDX-License-Identifier: Apache-2.0
"""A warehouse on the free cells of a floor that is not its own.

It stands in one Region of the floor (rooms.py). Seen from above, streets one cell wide run along
every third line of cells along x and every ninth along y; between them is room for blocks of eight
by two. Obstacles cut holes into this pattern: what still hangs together of the streets is used, and
of the cells beside them. Stations, for which streets must be without dead ends, take a block and
the street below it, where all of it is free:

    │ x x x x x x
    │           s ==        q  queue, s  service cell, x  the way back, ==  belt
    │ q q q q q

Where there is no room for that, stations are bays without a queue; see hall.py.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from warehouse_layout import hall, rooms
from warehouse_layout import items as shelves
from warehouse_layout.floor_plan import ALL_EXITS, FloorError, FloorPlan
from warehouse_layout.layout import (
    BELT,
    BLOCK_DEPTH,
    BLOCK_LENGTH,
    DROP,
    PICKS_TO_REPLENISH,
    QUEUE,
    SEED,
    Layout,
    chance,
    places_for,
)
from warehouse_layout.request import RequestError, proportioned
from warehouse_layout.stations import PICK, REPLENISH, STEPS, Station, lane_mask
from warehouse_layout.street_graph import without_dead_ends

ROW, COLUMN = BLOCK_DEPTH + 1, BLOCK_LENGTH + 1  # from street to street
SHIFTS = tuple(np.ndindex(COLUMN, ROW))
WIDE = 3000  # free cells, of which few shifts of the pattern are as good as all
ENOUGH = 0.5  # of the storage units that would fit without lanes: so many are enough with lanes


def fit(request, cells, seed=SEED, at=None):
    """The Layout of a resolved Request on free Cells, as layout.plan() makes it; it stands in the
    largest room, or where the point `at`, (x, y) [m], is.

    Where there is no room even for bays, the belts stand at the ends of streets, and the Layout has
    no plan. Raises RequestError if there are too few cells.
    """
    ground = _Ground(cells, rooms.choose(cells, at))
    most, tried = 0, (_with_lanes, _with_bays, _with_picking_alone, _with_dead_ends)
    if request.robots + request.shelves > ground.free.sum():
        tried = tried[-1:]  # it can't fit, and only the figures of the refusal are wanted
    for sites in tried:
        for site in sites(ground, request.belts):
            layout = _laid_out(ground, site, request, seed)
            if layout:
                return layout
            most = max(most, len(site.places))
    raise RequestError(_refusal(request, ground, most))


def fit_largest(cells, seed=SEED, at=None):
    """(Request, Layout) of the largest warehouse in sensible proportions that fits there.

    With lanes before its stations, unless without them more than twice as much fits. Raises
    RequestError where nothing does.
    """
    ground = _Ground(cells, rooms.choose(cells, at))
    found = _largest(ground, seed)
    if not found:
        raise RequestError(f"no warehouse fits {ground.region.name}")
    return found


def _largest(ground, seed):
    found = None
    if ground.free.sum() > WIDE:
        ground.shifts = SHIFTS[::5]
    picks = proportioned(int(ground.free.sum()) // 2).belts
    for sites in (_with_picking_alone, _with_bays, _with_lanes):
        least = found[0].shelves * ENOUGH if found else 0
        for count in sorted({picks, -(-picks // 2), -(-picks // 4), 1}, reverse=True):
            best = _best(sites(ground, count), ground, seed, least)
            if best:
                found = best
                break
    return found


def _best(sites, ground, seed, least):
    """(Request, Layout) of the Site with the most storage units, at least so many; or None."""
    asked = [
        (proportioned(len(s.places), int(s.streets.sum()) // hall.STREETS_A_ROBOT, len(s.drops)), s)
        for s in sites
    ]
    for request, site in sorted(asked, key=lambda one: -one[0].shelves):
        if request.shelves < max(least, 1):
            return None
        layout = _laid_out(ground, site, request, seed)
        if layout:
            return request, layout
    return None


def _refusal(request, ground, most):
    text = (
        f"{request} don't fit: of {ground.free.sum()} free cells, {most} are left for robots and"
        f" storage units beside streets and stations, {ground.region.name}"
    )
    found = _largest(ground, SEED)
    if not found:
        return f"{text}; nothing else fits there"
    less = found[0]
    return (
        f"{text}; {less.robots} robots, {less.shelves} storage units fit: size:=fit takes that,"
        " at:=x,y another place"
    )


class _Ground:
    """The cells of a Region, in the rectangle around them; cells are indices into `free`."""

    def __init__(self, cells, region):
        self.cells, self.region = cells, region
        box = region.box
        self.low = np.array([part.start for part in box])
        self.free = region.mask[box]
        self.middle = np.array(region.middle) - self.low
        self.shifts = SHIFTS

    def world(self, points):
        """Grid points in world [m]."""
        corner = self.low + (self.cells.x, self.cells.y)
        return np.reshape(points, (-1, 2)) + corner.astype(float)

    def nearest(self, points):
        """Cells (n, 2), the nearest to the middle first; equal ones in a fixed order."""
        far = ((points - self.middle) ** 2).sum(1)
        return points[np.argsort(far, kind="stable")]

    def whole(self, mask):
        """A mask over the whole floor."""
        out = np.zeros_like(self.cells.taken)
        out[self.region.box] = mask
        return out


@dataclass
class _Site:
    """Streets, and what may stand beside them."""

    streets: np.ndarray  # (nx, ny) bool
    places: np.ndarray  # (n, 2) cells for robots and storage units, the best first
    drops: list = field(default_factory=list)  # cells before belts
    headings: list = field(default_factory=list)  # from there to the belt
    lanes: list = field(default_factory=list)  # cells of stations: those with a belt first
    has_plan: bool = True


def _streets_of(ground, shift):
    i, j = np.indices(ground.free.shape)
    return ((i - shift[0]) % COLUMN == 0) | ((j - shift[1]) % ROW == 0)


def _stations_for(picks):
    """How many replenishing stations there shall be besides."""
    return math.ceil(picks / PICKS_TO_REPLENISH)


def _with_lanes(ground, picks):
    """Sites whose stations have lanes with queues."""
    wanted = picks + _stations_for(picks)
    for shift in ground.shifts if picks else ():
        is_street = _streets_of(ground, shift)
        lanes = _Lanes(is_street & ground.free, ground, shift)
        lanes.place(wanted)
        if len(lanes.corners) < wanted:
            continue
        room = ~is_street & ground.free & ~lanes.used
        drops = [(i + QUEUE, j + 1) for i, j in lanes.corners[:picks]]
        yield _Site(
            lanes.streets,
            _places(ground, room, lanes.streets),
            drops,
            [0] * picks,
            [_lane(*corner) for corner in lanes.corners],
        )


def _lane(i, j):
    there = [(i + k, j) for k in range(1, QUEUE + 1)]
    return [*there, (i + QUEUE, j + 1), *((x, y + 2) for x, y in there[::-1])]


def _with_bays(ground, picks):
    """Sites whose stations are bays."""
    return _sites_with_bays(ground, picks, _stations_for(picks))


def _with_picking_alone(ground, picks):
    """Sites with bays to pick at, and none to replenish."""
    return _sites_with_bays(ground, picks, 0)


def _sites_with_bays(ground, picks, replenishments):
    """Of small halls those carved to their shape, of others those in the regular pattern."""
    if not picks:
        return
    counts, patterns = (picks, replenishments), [_streets_of(ground, s) for s in ground.shifts]
    if ground.free.sum() <= hall.MOST_CELLS:
        halls = hall.carve(ground.free, *counts, patterns)
    else:
        halls = (hall.regular(ground.free, *counts, p, ground.middle) for p in patterns)
    for one in filter(None, halls):
        belts = [(cell, heading) for cell, heading in one.bays if heading is not None]
        yield _Site(
            one.streets,
            ground.nearest(np.argwhere(one.places)),
            [cell for cell, _ in belts],
            [heading for _, heading in belts],
            [[cell] for cell, _ in one.bays],
        )


def _with_dead_ends(ground, belts):
    """Sites without stations: people who command a few robots can do with dead ends."""
    for shift in ground.shifts:
        is_street = _streets_of(ground, shift)
        streets = _largest_part(is_street & ground.free)
        room = ~is_street & ground.free
        places = _places(ground, room, streets)
        yield _Site(streets, places, headings=[0] * belts, has_plan=False)


def _places(ground, room, streets):
    return ground.nearest(np.argwhere(room & hall.beside_of(streets)))


def _laid_out(ground, site, request, seed):
    """The Layout of a Request on a Site; None if it does not fit."""
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
    drops, towards = ground.world(drops), np.reshape([STEPS[h] for h in site.headings], (-1, 2))
    yaws = [h * math.pi / 2 for h in site.headings]
    return Layout(
        floor=ground.cells.floor,
        robots=np.column_stack([ground.world(robots), [_yaw(site.streets, c) for c in robots]]),
        units=ground.world(units[: request.shelves]),
        places=ground.world(places),
        item_unit=item_unit,
        item_place=item_place,
        belts=np.column_stack([drops + (BELT - DROP) * towards, yaws]),
        drops=drops,
        plan=plan,
        has_own_floor=False,
        where=ground.region.name,
    )


def _plan(ground, site, places, robots):
    """The FloorPlan, whose arrays are (y, x). Raises FloorError if it is not safe."""
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


def _stations(site, low, width):
    for n, lane in enumerate(site.lanes):
        cells = np.array([(y + low[1]) * width + x + low[0] for x, y in lane], np.int32)
        service = len(cells) // 2
        k = n - len(site.drops)
        if k < 0:
            yield Station(f"pick{n + 1}", PICK, cells, service, f"conveyor_belt{n + 1}")
        else:
            yield Station(f"replenish{k + 1}", REPLENISH, cells, service)


def _ends(ground, site, count, used):
    """Cells of streets with room for a belt of two cells along x; None if there are too few."""
    taken = site.places[:used]
    room = ground.free & ~site.streets
    room[tuple(taken.T)] = False
    found = site.streets & _shifted(room, (-1, 0)) & _shifted(room, (-2, 0))
    drops = np.argwhere(found)
    middle = taken.mean(0) if len(taken) else (0, 0)
    drops = drops[np.argsort(((drops - middle) ** 2).sum(1), kind="stable")][:count]
    return drops if len(drops) == count else None


def _yaw(streets, cell):
    """Towards the street beside a cell."""
    for dx, dy in STEPS:
        i, j = cell[0] + dx, cell[1] + dy
        inside = 0 <= i < streets.shape[0] and 0 <= j < streets.shape[1]
        if inside and streets[i, j]:
            return np.arctan2(dy, dx)
    return 0.0


def _shifted(mask, step):
    """The mask moved by that many cells along x and y; what leaves is lost."""
    moved = np.zeros_like(mask)
    (dx, dy), (nx, ny) = step, mask.shape
    moved[max(dx, 0) : nx + min(dx, 0), max(dy, 0) : ny + min(dy, 0)] = mask[
        max(-dx, 0) : nx + min(-dx, 0), max(-dy, 0) : ny + min(-dy, 0)
    ]
    return moved


def _largest_part(mask):
    """The cells that hang together with each other, of the largest such part."""
    left = {tuple(cell) for cell in np.argwhere(mask).tolist()}
    largest = []
    while len(left) > len(largest):
        part = [left.pop()]
        for x, y in part:  # grows meanwhile
            for dx, dy in STEPS:
                near = (x + dx, y + dy)
                if near in left:
                    left.remove(near)
                    part.append(near)
        largest = max(largest, part, key=len)
    out = np.zeros_like(mask)
    if largest:
        out[tuple(np.transpose(largest))] = True
    return out


class _Lanes:
    """Rooms for stations: where a block and the street below it are free, beside a street."""

    def __init__(self, streets, ground, shift):
        self._free, self._middle, self._shift = ground.free, ground.middle, shift
        self._whole = without_dead_ends(streets)
        self._cut_off = set()  # corners from which no way leads on
        self.corners, self.streets = [], self._whole

    @property
    def used(self):
        out = np.zeros_like(self._free)
        for corner in self.corners:
            out[_room(*corner)] = True
        return out

    def place(self, count):
        """So many, if there is room, the nearest to the middle first. `corners` are the cells of
        streets along y from which their lanes begin."""
        for _ in range(TRIES if count else 0):
            self.corners = self._free_rooms(count)
            self.streets = without_dead_ends(self._whole & ~self.used)
            wrong = [corner for corner in self.corners if not _joins(corner, self.streets)]
            if not wrong:
                return
            self._cut_off.update(wrong)
            self.corners = [corner for corner in self.corners if corner not in wrong]

    def _free_rooms(self, count):
        corners = [
            (i, j)
            for i in range(self._shift[0], self._free.shape[0] - BLOCK_LENGTH, COLUMN)
            for j in range(self._shift[1], self._free.shape[1] - BLOCK_DEPTH, ROW)
            if (i, j) not in self._cut_off
            and self._free[_room(i, j)].all()
            and _joins((i, j), self._whole)
        ]
        corners.sort(key=lambda corner: ((np.array(corner) - self._middle - 0.5) ** 2).sum())
        return corners[:count]


TRIES = 5  # to find rooms that leave each other's streets whole


def _room(i, j):
    return slice(i + 1, i + COLUMN), slice(j, j + ROW)


def _joins(corner, streets):
    """Whether a lane from there begins and ends at streets."""
    i, j = corner
    return streets[i, j] and streets[i, j + BLOCK_DEPTH]
