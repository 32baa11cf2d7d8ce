# SPDX-License-Identifier: Apache-2.0
"""A warehouse on the free cells of a floor that is not its own.

Seen from above, streets one cell wide run along every third line of cells along x and every ninth
along y; between them is room for blocks of eight by two. Obstacles cut holes into this pattern:
what still hangs together of the streets is used, and of the cells beside them. Stations, for which
streets must be without dead ends, take a block and the street below it, where all of it is free:

    │ x x x x x x
    │           s ==        q  queue, s  service cell, x  the way back, ==  belt
    │ q q q q q q
"""

import math

import numpy as np

from warehouse_fleet.floor_plan import ALL_EXITS, FloorError, FloorPlan
from warehouse_fleet.stations import PICK, REPLENISH, STEPS, Station, lane_mask
from warehouse_fleet.street_graph import without_dead_ends
from warehouse_sim import items as shelves
from warehouse_sim.layout import (
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
from warehouse_sim.request import RequestError

ROW, COLUMN = BLOCK_DEPTH + 1, BLOCK_LENGTH + 1  # from street to street


def fit(request, cells, seed=SEED):
    """The Layout of a resolved Request on free Cells, as layout.plan() makes it.

    Where there is no room for stations the belts stand at the ends of streets, and the Layout has
    no plan. Raises RequestError if there are too few cells.
    """
    most = 0
    for with_stations in (True, False):
        for shift in np.ndindex(COLUMN, ROW):
            pattern = _Pattern(cells, shift, request.belts if with_stations else 0)
            layout = pattern.layout(request, chance(seed))
            if layout:
                return layout
            most = max(most, len(pattern.places))
    raise RequestError(
        f"{request} don't fit: of {(~cells.taken).sum()} free cells, {most} lie beside streets"
        f" that hang together; robots and storage units together, {most} at the most, would fit"
    )


class _Pattern:
    """Streets and places on the free cells; cells are indices into `taken`."""

    def __init__(self, cells, shift, picks):
        """With so many picking stations, or as many as there is room for."""
        self._cells = cells
        free = ~cells.taken
        i, j = np.indices(free.shape)
        is_street = ((i - shift[0]) % COLUMN == 0) | ((j - shift[1]) % ROW == 0)
        self._picks, self._stations_wanted = picks, picks + math.ceil(picks / PICKS_TO_REPLENISH)
        self._lanes = _Lanes(is_street & free, free, shift)
        self._lanes.place(self._stations_wanted)
        # People who command a few robots can do with dead ends; a fleet can't.
        self._streets = self._lanes.streets if picks else _largest_part(is_street & free)
        self._rooms = ~is_street & free & ~self._lanes.used
        beside = np.zeros_like(self._rooms)
        for step in STEPS:
            beside |= _shifted(self._streets, step)
        # The nearest to the middle first; equal ones in a fixed order.
        middle = np.array(free.shape) / 2 - 0.5
        places = np.argwhere(self._rooms & beside)
        self.places = places[np.argsort(((places - middle) ** 2).sum(1), kind="stable")]

    def layout(self, request, rng):
        """None if it does not fit."""
        count = request.shelves + request.robots
        drops = self._served() if self._picks else self._drops(request.belts, self.places[:count])
        if len(self.places) < count or drops is None:
            return None
        spare = min(len(self.places) - count, places_for(request.shelves) - request.shelves)
        places, robots = np.split(self.places[: count + spare], [request.shelves + spare])
        units = places[: request.shelves] if rng is None else rng.permutation(places)
        robots = robots if rng is None else rng.permutation(robots)
        item_unit, item_place = shelves.spread(request.items, request.shelves, rng)
        try:
            plan = self._plan(places, robots) if self._picks else None
        except FloorError:
            return None
        drops = self._world(drops)
        return Layout(
            floor=self._cells.floor,
            robots=np.column_stack([self._world(robots), [self._yaw(cell) for cell in robots]]),
            units=self._world(units[: request.shelves]),
            places=self._world(places),
            item_unit=item_unit,
            item_place=item_place,
            belts=np.pad(drops + (BELT - DROP, 0), ((0, 0), (0, 1))),
            drops=drops,
            plan=plan,
            has_own_floor=False,
        )

    def _served(self):
        """Cells before belts, in stations; None if there are too few."""
        found = self._lanes.corners
        if len(found) < self._stations_wanted:
            return None
        return np.array(found[: self._picks]) + (QUEUE, 1)

    def _plan(self, places, robots):
        """The FloorPlan, whose arrays are (y, x). Raises FloorError if it is not safe."""
        storage, parking = (np.zeros_like(self._streets) for _ in range(2))
        storage[tuple(places.T)] = True
        parking[tuple(robots.T)] = True
        passable = self._streets | storage | parking
        stations = list(self._stations(passable.shape[0]))
        plan = FloorPlan.laid_out(
            origin=(self._cells.x, self._cells.y),
            spacing=1.0,
            passable=passable.T | lane_mask(stations, passable.T.shape),
            storage=storage.T,
            parking=parking.T,
            exits=np.full(passable.T.shape, ALL_EXITS, np.uint8),
            stations=stations,
        )
        plan.check()
        return plan

    def _stations(self, width):
        for n, (i, j) in enumerate(self._lanes.corners):
            there = [(i + k, j) for k in range(1, QUEUE + 1)]
            lane = [*there, (i + QUEUE, j + 1), *((x, y + 2) for x, y in there[::-1])]
            cells = np.array([y * width + x for x, y in lane], np.int32)
            k = n - self._picks
            if k < 0:
                yield Station(f"pick{n + 1}", PICK, cells, QUEUE, f"conveyor_belt{n + 1}")
            else:
                yield Station(f"replenish{k + 1}", REPLENISH, cells, QUEUE)

    def _drops(self, count, taken):
        """Cells of streets with room for a belt of two cells along x; None if there are too few."""
        rooms = self._rooms.copy()
        rooms[tuple(taken.T)] = False
        found = self._streets & _shifted(rooms, (-1, 0)) & _shifted(rooms, (-2, 0))
        drops = np.argwhere(found)
        middle = self.places[: len(taken)].mean(0) if len(taken) else (0, 0)
        drops = drops[np.argsort(((drops - middle) ** 2).sum(1), kind="stable")][:count]
        return drops if len(drops) == count else None

    def _yaw(self, cell):
        """Towards the street beside a cell."""
        for dx, dy in STEPS:
            i, j = cell[0] + dx, cell[1] + dy
            inside = 0 <= i < self._streets.shape[0] and 0 <= j < self._streets.shape[1]
            if inside and self._streets[i, j]:
                return np.arctan2(dy, dx)
        return 0.0

    def _world(self, cells):
        """Grid points in world [m]."""
        return np.reshape(cells, (-1, 2)) + (float(self._cells.x), float(self._cells.y))


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

    def __init__(self, streets, free, shift):
        self._free, self._shift = free, shift
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
        middle = np.array(self._free.shape) / 2
        corners = [
            (i, j)
            for i in range(self._shift[0], self._free.shape[0] - BLOCK_LENGTH, COLUMN)
            for j in range(self._shift[1], self._free.shape[1] - BLOCK_DEPTH, ROW)
            if (i, j) not in self._cut_off
            and self._free[_room(i, j)].all()
            and _joins((i, j), self._whole)
        ]
        corners.sort(key=lambda corner: ((np.array(corner) - middle) ** 2).sum())
        return corners[:count]


TRIES = 5  # to find rooms that leave each other's streets whole


def _room(i, j):
    return slice(i + 1, i + COLUMN), slice(j, j + ROW)


def _joins(corner, streets):
    """Whether a lane from there begins and ends at streets."""
    i, j = corner
    return streets[i, j] and streets[i, j + BLOCK_DEPTH]
