# SPDX-License-Identifier: Apache-2.0
"""Sites for a warehouse on free cells: streets, and what may stand beside them.

Streets one cell wide run along every third line of cells along x and every ninth along y; between
them is room for blocks of eight by two. Obstacles cut holes into this pattern: the parts of the
streets that are still connected are used, and the cells beside them.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from warehouse_layout.floor.masks import beside_of, largest_part
from warehouse_layout.floor.street_graph import without_dead_ends
from warehouse_layout.generate import hall
from warehouse_layout.generate.blocks import BLOCK_DEPTH, BLOCK_LENGTH, QUEUE
from warehouse_layout.generate.cells import Cells
from warehouse_layout.generate.one_way import PICKS_TO_REPLENISH
from warehouse_layout.generate.rooms import Region

ROW, COLUMN = BLOCK_DEPTH + 1, BLOCK_LENGTH + 1  # from street to street
SHIFTS = tuple(np.ndindex(COLUMN, ROW))
TRIES = 5  # searches for rooms that leave each other's streets whole

Cell = tuple[int, ...]  # i, j


class Ground:
    """The cells of a Region, in the rectangle around them; cells are indices into `free`."""

    def __init__(self, cells: Cells, region: Region) -> None:
        self.cells, self.region = cells, region
        box = region.box
        self.low = np.array([part.start for part in box])
        self.free = region.mask[box]
        self.middle = np.array(region.middle) - self.low
        self.shifts: Sequence[tuple[int, ...]] = SHIFTS  # of the pattern of streets, to be tried

    def world(self, points: Sequence[Cell] | np.ndarray) -> np.ndarray:
        """Returns the centres of cells in `world` [m], (n, 2)."""
        corner = self.low + (self.cells.x, self.cells.y)
        return np.reshape(points, (-1, 2)) + corner.astype(float)

    def nearest(self, points: np.ndarray) -> np.ndarray:
        """Returns cells (n, 2) sorted by distance from the middle; equal ones keep their order."""
        far = ((points - self.middle) ** 2).sum(1)
        return points[np.argsort(far, kind="stable")]

    def whole(self, mask: np.ndarray) -> np.ndarray:
        """Returns a mask of the rectangle as one of the whole floor."""
        out = np.zeros_like(self.cells.taken)
        out[self.region.box] = mask
        return out


@dataclass
class Site:
    """Streets, and what may stand beside them."""

    streets: np.ndarray  # (nx, ny) bool
    places: np.ndarray  # (n, 2) cells for robots and storage units, the best first
    drops: Sequence[Cell] = field(default_factory=list)  # cells before belts
    headings: Sequence[int] = field(default_factory=list)  # from there to the belt
    lanes: Sequence[Sequence[Cell]] = field(default_factory=list)  # those with a belt first
    has_plan: bool = True


def _streets_of(ground: Ground, shift: tuple[int, ...]) -> np.ndarray:
    i, j = np.indices(ground.free.shape)
    return ((i - shift[0]) % COLUMN == 0) | ((j - shift[1]) % ROW == 0)


def _stations_for(picks: int) -> int:
    """Returns how many replenishing stations belong to `picks` picking stations."""
    return math.ceil(picks / PICKS_TO_REPLENISH)


def with_lanes(ground: Ground, picks: int, replenish: int | None = None) -> Iterator[Site]:
    """Yields sites whose stations have lanes with queues. replenish: None: as picks take."""
    stations = picks + (_stations_for(picks) if replenish is None else replenish)
    for shift in ground.shifts if picks else ():
        is_street = _streets_of(ground, shift)
        lanes = _Lanes(is_street & ground.free, ground, shift)
        lanes.place(stations)
        if len(lanes.corners) < stations:
            continue
        room = ~is_street & ground.free & ~lanes.used
        drops = [(i + QUEUE, j + 1) for i, j in lanes.corners[:picks]]
        yield Site(
            lanes.streets,
            _places(ground, room, lanes.streets),
            drops,
            [0] * picks,
            [_lane(*corner) for corner in lanes.corners],
        )


def _lane(i: int, j: int) -> Sequence[Cell]:
    there = [(i + k, j) for k in range(1, QUEUE + 1)]
    return [*there, (i + QUEUE, j + 1), *((x, y + 2) for x, y in there[::-1])]


def with_bays(ground: Ground, picks: int) -> Iterator[Site]:
    """Yields sites whose stations are bays."""
    return _sites_with_bays(ground, picks, _stations_for(picks))


def with_picking_alone(ground: Ground, picks: int) -> Iterator[Site]:
    """Yields sites with bays to pick at, and none to replenish."""
    return _sites_with_bays(ground, picks, 0)


def _sites_with_bays(ground: Ground, picks: int, replenishments: int) -> Iterator[Site]:
    """Yields sites carved to the shape of a small hall; in a large one, regular sites."""
    if not picks:
        return
    free, counts = ground.free, (picks, replenishments)
    patterns = [_streets_of(ground, shift) for shift in ground.shifts]
    halls: Iterator[hall.Hall | None]
    if free.sum() <= hall.MOST_CELLS:
        halls = hall.carve(free, *counts, patterns)
    else:
        halls = (hall.regular(free, *counts, p, ground.middle) for p in patterns)
    for candidate in filter(None, halls):
        belts = [(cell, heading) for cell, heading in candidate.bays if heading is not None]
        yield Site(
            candidate.streets,
            ground.nearest(np.argwhere(candidate.places)),
            [cell for cell, _ in belts],
            [heading for _, heading in belts],
            [[cell] for cell, _ in candidate.bays],
        )


def with_dead_ends(ground: Ground, belts: int) -> Iterator[Site]:
    """Yields sites without stations: for a few robots, driven by hand, dead ends are no harm."""
    for shift in ground.shifts:
        is_street = _streets_of(ground, shift)
        streets = largest_part(is_street & ground.free)
        room = ~is_street & ground.free
        places = _places(ground, room, streets)
        yield Site(streets, places, headings=[0] * belts, has_plan=False)


def _places(ground: Ground, room: np.ndarray, streets: np.ndarray) -> np.ndarray:
    return ground.nearest(np.argwhere(room & beside_of(streets)))


class _Lanes:
    """Rooms for stations: where a block and the street below it are free, beside a street.

    `corners` are the cells of streets along y from which their lanes begin.
    """

    def __init__(self, streets: np.ndarray, ground: Ground, shift: tuple[int, ...]) -> None:
        self._free, self._middle, self._shift = ground.free, ground.middle, shift
        self._whole = without_dead_ends(streets)
        self._cut_off: set[Cell] = set()  # corners from which no way leads on
        self.corners: list[Cell] = []
        self.streets = self._whole

    @property
    def used(self) -> np.ndarray:
        """The cells of the rooms, (nx, ny) bool."""
        out = np.zeros_like(self._free)
        for corner in self.corners:
            out[_room(*corner)] = True
        return out

    def place(self, count: int) -> None:
        """Takes up to `count` rooms, the nearest to the middle first."""
        for _ in range(TRIES if count else 0):
            self.corners = self._free_rooms(count)
            self.streets = without_dead_ends(self._whole & ~self.used)
            wrong = [corner for corner in self.corners if not _joins(corner, self.streets)]
            if not wrong:
                return
            self._cut_off.update(wrong)
            self.corners = [corner for corner in self.corners if corner not in wrong]

    def _free_rooms(self, count: int) -> list[Cell]:
        corners: list[Cell] = [
            (i, j)
            for i in range(self._shift[0], self._free.shape[0] - BLOCK_LENGTH, COLUMN)
            for j in range(self._shift[1], self._free.shape[1] - BLOCK_DEPTH, ROW)
            if (i, j) not in self._cut_off
            and self._free[_room(i, j)].all()
            and _joins((i, j), self._whole)
        ]
        corners.sort(key=lambda corner: ((np.array(corner) - self._middle - 0.5) ** 2).sum())
        return corners[:count]


def _room(i: int, j: int) -> tuple[slice, slice]:
    return slice(i + 1, i + COLUMN), slice(j, j + ROW)


def _joins(corner: Cell, streets: np.ndarray) -> bool:
    """Returns whether a lane from that corner begins and ends at streets."""
    i, j = corner
    return bool(streets[i, j] and streets[i, j + BLOCK_DEPTH])
