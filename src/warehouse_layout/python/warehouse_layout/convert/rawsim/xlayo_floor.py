# SPDX-License-Identifier: Apache-2.0
"""The floor that RAWSim-O's generator makes of its parameters.

Blocks of storage places, two deep, lie between aisles in both directions, and a ring way goes round
all of them. At each side with stations follow a hall and their buffers:

    ring   every cell leads on around, into blocks, and where an aisle or a hall's street leads away
    aisle  streets that lead there and back in turn
    hall   streets that continue the rows (or columns) of the storage, crossed by others: the two
           outermost in the kind Tim, all of them in the kind HighwayHallway
    buffer a queue that winds from its entry to the station, whose row leads back to the hall; each
           second row is entered from the hall as well, and from the deep end of the one before
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.floor.floor_plan import ALL_EXITS, FloorPlan
from warehouse_layout.floor.stations import PICK, REPLENISH, Station, lane_mask, neighbour

BLOCK_DEPTH = 2
EAST, SOUTH, WEST, NORTH = range(4)  # headings: rows are numbered from north to south
SIDES = {"East": EAST, "West": WEST, "North": NORTH, "South": SOUTH}  # in the order of building


@dataclass(frozen=True)
class Parameters:
    """Parameters of the generator; lengths in cells."""

    rows: int  # aisles along x
    columns: int  # aisles along y
    block: int  # length of a block along x
    hall: int  # depth of a hall
    buffer: int  # depth of a buffer
    turn: int  # cells from a station's entry to its exit
    two_way: bool
    single: bool  # aisles of one lane, not of two
    counter_clockwise: bool
    highways: bool  # halls of the kind HighwayHallway
    picks: Mapping[str, int]  # stations by side
    replenishments: Mapping[str, int]

    @property
    def lanes(self) -> int:
        """Cells across an aisle."""
        return 1 if self.single else 2

    @property
    def storage_shape(self) -> tuple[int, int]:
        """Cells along y and x of blocks, aisles and ring way."""
        return (
            (self.rows + 1) * BLOCK_DEPTH + self.rows * self.lanes + 2,
            (self.columns + 1) * self.block + self.columns * self.lanes + 2,
        )

    def count(self, side: str) -> int:
        """Returns the number of stations at a side."""
        return self.picks[side] + self.replenishments[side]

    def depth(self, side: str) -> int:
        """Returns the cells of hall and buffer at a side; 0 without stations."""
        return self.hall + self.buffer if self.count(side) else 0

    @property
    def corner(self) -> tuple[int, int]:
        """Row and column of the north-western corner of the ring way."""
        return self.depth("North"), self.depth("West")

    @property
    def shape(self) -> tuple[int, int]:
        """Cells of the whole floor along y and x."""
        height, width = self.storage_shape
        return (
            height + self.depth("North") + self.depth("South"),
            width + self.depth("West") + self.depth("East"),
        )


@dataclass(frozen=True, eq=False)
class GeneratedFloor:
    """The plan, and a drawing in which streets have no direction yet."""

    plan: FloorPlan
    drawing: np.ndarray  # (h, w) characters


def of(parameters: Parameters) -> GeneratedFloor:
    """Returns the floor of the parameters, which must be valid."""
    return _Floor(parameters).made()


class _Floor:
    def __init__(self, parameters: Parameters) -> None:
        self._p = parameters
        shape = parameters.shape
        self._storage, self._road, self._ring = (np.zeros(shape, bool) for _ in range(3))
        self._entries: set[tuple[int, int, int]] = set()  # row, column, heading into a buffer
        self._own = np.zeros(shape, np.uint8)  # bit h: the cell's street leads towards h

    def made(self) -> GeneratedFloor:
        stations = list(_numbered(s for side in SIDES for s in self._stations(side)))
        self._draw_storage()
        for side in SIDES:
            if self._p.count(side):
                self._draw_hall(side)
        lane = lane_mask(stations, self._own.shape)
        plan = FloorPlan.laid_out(
            origin=(0.0, 0.0),
            spacing=1.0,
            passable=self._road | self._storage | lane,
            storage=self._storage,
            parking=np.zeros_like(lane),
            exits=self._exits(lane),
            stations=stations,
        )
        drawing = np.full(lane.shape, lf.NO_FLOOR, "<U1")
        drawing[plan.passable] = lf.FLOOR
        drawing[plan.storage] = lf.STORAGE
        return GeneratedFloor(plan, drawing)

    # --- streets

    def _draw_storage(self) -> None:
        p = self._p
        (top, left), (height, width) = p.corner, p.storage_shape
        inside = (slice(top + 1, top + height - 1), slice(left + 1, left + width - 1))
        across, along = (
            _aisles(p.rows, BLOCK_DEPTH, p.lanes),
            _aisles(p.columns, p.block, p.lanes),
        )
        self._storage[inside] = ~(across[:, None] | along)
        area = (slice(top, top + height), slice(left, left + width))
        self._road[area] = ~self._storage[area]
        self._ring[area] = True
        self._ring[inside] = False
        self._lead(inside[0], inside[1], across, WEST, by_row=True)
        self._lead(inside[0], inside[1], along, SOUTH, by_row=False)
        self._lead_round(top, left, height, width)

    def _lead(
        self, rows: slice, columns: slice, chosen: np.ndarray, first: int, by_row: bool
    ) -> None:
        """Makes the chosen rows or columns of a part streets, opposed in turn."""
        if not self._p.counter_clockwise:
            first = (first + 2) % 4
        for turn, index in enumerate(np.flatnonzero(chosen).tolist()):
            heading = first if turn % 2 == 0 else (first + 2) % 4
            where = (rows.start + index, columns) if by_row else (rows, columns.start + index)
            self._own[where] |= np.uint8(1 << heading)

    def _lead_round(self, top: int, left: int, height: int, width: int) -> None:
        bottom, right = top + height - 1, left + width - 1
        headings = [EAST, SOUTH, WEST, NORTH]
        corners = [(top, left), (top, right), (bottom, right), (bottom, left)]
        if not self._p.counter_clockwise:
            headings, corners = [SOUTH, EAST, NORTH, WEST], [corners[i] for i in (0, 3, 2, 1)]
        for heading, a, b in zip(headings, corners, corners[1:] + corners[:1]):
            rows = slice(min(a[0], b[0]), max(a[0], b[0]) + 1)
            columns = slice(min(a[1], b[1]), max(a[1], b[1]) + 1)
            # A corner leads on along the side that begins there.
            side = np.zeros_like(self._ring)
            side[rows, columns] = True
            side[b] = False
            self._own[side] |= np.uint8(1 << heading)

    def _draw_hall(self, side: str) -> None:
        """Draws the streets of a hall: those that lead to the storage, and those across.

        The streets beside the buffers lead as the ring way does at that side.
        """
        rows, columns = self._hall(side)
        self._road[rows, columns] = True
        lengths = rows.stop - rows.start, columns.stop - columns.start
        by_row = side in ("East", "West")
        across = np.full(lengths[1 if by_row else 0], self._p.highways)
        across[slice(-2, None) if side in ("East", "South") else slice(2)] = True
        on = np.ones(lengths[0 if by_row else 1], bool)
        # Those in the west and south are counted from the other end.
        turned = side in ("West", "South") and len(on) % 2 == 1
        first = EAST if by_row else NORTH
        self._lead(rows, columns, on, (first + 2 * turned) % 4, by_row)
        self._lead(rows, columns, across, NORTH if by_row else EAST, not by_row)

    def _hall(self, side: str) -> tuple[slice, slice]:
        """Returns rows and columns of a hall; those of the kind HighwayHallway meet at corners."""
        p = self._p
        (top, left), (height, width) = p.corner, p.storage_shape
        bottom, right = top + height, left + width
        more = {s: p.hall if p.highways and p.count(s) else 0 for s in SIDES}
        return {
            "East": (slice(top, bottom + more["South"]), slice(right, right + p.hall)),
            "West": (slice(top - more["North"], bottom), slice(left - p.hall, left)),
            "North": (slice(top - p.hall, top), slice(left, right + more["East"])),
            "South": (slice(bottom, bottom + p.hall), slice(left - more["West"], right)),
        }[side]

    def _exits(self, lane: np.ndarray) -> np.ndarray:
        """Returns by which headings cells may be left, (h, w) uint8."""
        out = np.zeros_like(self._own)
        open_ = self._open()
        for heading in range(4):
            leads = self._own >> heading & 1 == 1
            leads |= self._ring & neighbour(leads, heading)
            leads |= open_ & neighbour(open_, heading)
            to_road = leads & neighbour(self._road, heading)
            out[to_road | neighbour(self._storage, heading)] |= np.uint8(1 << heading)
        for row, column, heading in self._entries:
            if self._road[row, column]:
                out[row, column] |= np.uint8(1 << heading)
        out[self._storage | lane] = ALL_EXITS
        return np.where(self._road | self._storage | lane, out, 0).astype(np.uint8)

    def _open(self) -> np.ndarray:
        """Returns the streets without a direction, (h, w) bool."""
        if not self._p.two_way:
            return np.zeros_like(self._road)
        if not self._p.highways:
            return self._road
        (top, left), (height, width) = self._p.corner, self._p.storage_shape
        out = np.zeros_like(self._road)
        out[top : top + height, left : left + width] = True
        return out & self._road

    # --- stations

    def _stations(self, side: str) -> Iterator[Station]:
        """Yields the stations at a side, without names."""
        count = self._p.count(side)
        for i, exit_ in enumerate(self._exit_places(side)[:count]):
            cells = self._lane(side, exit_)
            width = self._p.shape[1]
            numbers = np.array([row * width + column for row, column in cells], np.int32)
            kind = PICK if i < self._p.picks[side] else REPLENISH
            cuts = tuple(self._short_cuts(side, exit_, numbers))
            yield Station("", kind, numbers, len(cells) - self._p.buffer, short_cuts=cuts)

    def _short_cuts(self, side: str, exit_: int, cells: np.ndarray) -> Iterator[tuple[int, int]]:
        """Yields the steps into each second row of a buffer, but for the first: from the hall, and
        from the deep end of the row before, which is where that begins."""
        p = self._p
        step = 1 if side in ("East", "North") else -1
        step = step if p.counter_clockwise else -step
        for k in range(2, p.turn, 2):
            row, column = self._place(side, exit_ + step * (p.turn - k), -1)
            yield row * p.shape[1] + column, int(cells[k * p.buffer])
            if p.buffer > 1:
                yield int(cells[(k - 1) * p.buffer]), int(cells[(k + 1) * p.buffer - 1])

    def _exit_places(self, side: str) -> list[int]:
        """Returns the rows or columns of stations' exits, those in the middle of a side."""
        p = self._p
        vertical = side in ("East", "West")
        aisles, block = (p.rows, BLOCK_DEPTH) if vertical else (p.columns, p.block)
        against = (side in ("East", "North")) != p.counter_clockwise
        second = against and not p.two_way
        first = p.corner[0 if vertical else 1] + 1 + block
        first += (block + p.lanes if second else 0) + (1 if second and not p.single else 0)
        close = p.two_way and p.turn < BLOCK_DEPTH + p.lanes
        room = aisles if close else aisles // 2
        # Where the generator counts on more room than there is, those that fit are taken.
        begin = min((room - p.count(side)) // 2, aisles // 2 - p.count(side))
        return [first + 2 * (block + p.lanes) * i for i in range(begin, room)]

    def _lane(self, side: str, exit_: int) -> list[tuple[int, int]]:
        """Returns rows and columns of a lane in driving order: there, and back, until the exit."""
        p, cells = self._p, []
        towards = SIDES[side]
        step = 1 if side in ("East", "North") else -1
        step = step if p.counter_clockwise else -step
        for k in range(p.turn + 1):
            at = exit_ + step * (p.turn - k)
            depths = range(p.buffer) if k % 2 == 0 else range(p.buffer)[::-1]
            cells += [self._place(side, at, depth) for depth in depths]
        row, column = self._place(side, exit_ + step * p.turn, -1)
        self._entries.add((row, column, towards))
        return cells

    def _place(self, side: str, at: int, depth: int) -> tuple[int, int]:
        """Returns the cell of a buffer in a row or column, so deep from the hall."""
        height, width = self._p.shape
        inner = self._p.buffer - 1 - depth
        return {
            "East": (at, width - 1 - inner),
            "West": (at, inner),
            "North": (inner, at),
            "South": (height - 1 - inner, at),
        }[side]


def _aisles(count: int, block: int, lanes: int) -> np.ndarray:
    """Returns which rows or columns within the ring way are aisles, (n,) bool."""
    once = [False] * block + [True] * lanes
    return np.array(once * count + [False] * block)


def _numbered(stations: Iterable[Station]) -> Iterator[Station]:
    counts = {PICK: 0, REPLENISH: 0}
    for station in stations:
        counts[station.kind] += 1
        yield replace(station, name=f"{station.kind.lower()}{counts[station.kind]}")
