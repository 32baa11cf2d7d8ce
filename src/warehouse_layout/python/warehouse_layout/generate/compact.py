# SPDX-License-Identifier: Apache-2.0
"""Generates compact floors: blocks of storage between streets, stations on one side to four.

v < < < < < < <         one-way: neighboured streets are opposed, and the outermost go round
v s s ^ s s v ^ q q     two-way: every street is driven any way
v s s ^ s s v ^ x A = =
> > > > > > > ^ x x     a side with stations has two streets along it
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import Cell, LayoutFile, StationEntry
from warehouse_layout.file.request import Request, RequestError, check_stations
from warehouse_layout.floor.stations import STEPS
from warehouse_layout.generate.blocks import FETCH, QUEUE, WAIT, places_for
from warehouse_layout.generate.generator import CHARGED

SIDES = (0, 2, 1, 3)  # headings of the sides that get stations: +x, -x, +y, -y
LANE = 3  # cells of a side that the lane of a station takes
APART = 1  # free cells between them where stations are on several sides: many share a street
LEAST_QUEUE = 3  # cells of a lane before its service cell
BELT_CELLS = 2
BELTED = {"pick", "both"}  # kinds of stations that have a belt
MOST_EDGE = 100  # of a block, in cells


@dataclass(frozen=True)
class Style:
    """How a compact floor is laid out."""

    sides: int = 1  # with stations
    block: tuple[int, int] = (2, 8)  # storage places along y and x
    is_one_way: bool = True
    first_side: int = 0  # heading of the side that gets the first station
    more_queue: int = 0  # cells by which lanes are longer, or shorter, than they would be
    parks_near: bool = False  # whether robots park between stations and storage, or behind it
    aspect: float = 1.0  # length along x over that along y that is aimed at
    pick_kind: str = "pick"  # of the picking stations; "both": bundles are put in there as well

    @property
    def headings(self) -> tuple[int, ...]:
        """The sides that get stations, by their headings."""
        return tuple((side + self.first_side) % len(SIDES) for side in SIDES[: self.sides])

    def check(self) -> None:
        """Raises RequestError where robots with units couldn't come to every place."""
        if not 1 <= self.sides <= len(SIDES):
            raise RequestError(f"sides is {self.sides}; 1 to {len(SIDES)} were expected")
        low, high = sorted(self.block)
        if low < 1 or high > MOST_EDGE:
            raise RequestError(
                f"a block of {self.block[0]}x{self.block[1]} places; 1 to {MOST_EDGE} were expected"
            )
        if low > 2:
            raise RequestError(
                f"a block of {self.block[0]}x{self.block[1]} places has some without a street"
                " beside them; one of its edges must be 1 or 2"
            )


def of_request(request: Request, replenish: int, style: Style, name: str = "") -> LayoutFile:
    """Returns the file of a compact warehouse with `request.belts` picking stations.

    Raises RequestError for counts and styles of which no fleet could make use.
    """
    style.check()
    check_stations(request.belts, replenish)
    return min(_plans(request, replenish, style), key=_Plan.cost).file(request, name)


def fitting(
    request: Request, replenish: int, style: Style, width: int, height: int, most: int = 3
) -> Iterator[LayoutFile]:
    """Yields the files of compact warehouses that fit a count of cells, the smallest first, up to
    `most` of them. Raises RequestError as of_request() does."""
    style.check()
    check_stations(request.belts, replenish)
    plans = [plan for plan in _plans(request, replenish, style) if plan.fits(width, height)]
    for plan in sorted(plans, key=_Plan.cost)[:most]:
        yield plan.file(request)


@dataclass(frozen=True)
class _Kind:
    """A station to be placed."""

    kind: str
    name: str


def _kinds(picks: int, replenish: int, style: Style) -> dict[int, list[_Kind]]:
    """Returns the stations of each side, by its heading: picking and replenishing spread alike."""
    sides = style.headings
    out: dict[int, list[_Kind]] = {side: [] for side in sides}
    for i in range(picks):
        out[sides[i % len(sides)]].append(_Kind(style.pick_kind, f"pick{i + 1}"))
    for i in range(replenish):
        out[sides[(picks + i) % len(sides)]].append(_Kind("replenish", f"replenish{i + 1}"))
    return out


def _plans(request: Request, replenish: int, style: Style) -> Iterator["_Plan"]:
    """Yields candidates: rows of blocks, and as many columns as that needs."""
    kinds = _kinds(request.belts, replenish, style)
    places = places_for(request.shelves)
    blocks = math.ceil(max(request.robots + places, 1) / math.prod(style.block))
    for rows in _row_counts(blocks, kinds, style):
        columns = math.ceil(blocks / rows)
        plan = _Plan(request, style, kinds, rows, columns)
        least = _pitch(style) * max(len(kinds.get(1, ())), len(kinds.get(3, ())))
        missing = least - len(plan.street_x) - plan.columns * style.block[1]
        if missing > 0:
            columns += math.ceil(missing / (style.block[1] + 1))
        yield _Plan(request, style, kinds, rows, columns)


def _pitch(style: Style) -> int:
    """Returns how many cells of a side each station has at least."""
    return LANE + (APART if style.sides > 1 else 0)


def _row_counts(blocks: int, kinds: dict[int, list[_Kind]], style: Style) -> Iterator[int]:
    """Yields numbers of rows of blocks with which the lanes at both ends have room."""
    depth = style.block[0]
    least = _pitch(style) * max(len(kinds.get(0, ())), len(kinds.get(2, ())))
    first = max(1, math.ceil((least - 1) / (depth + 1)))
    most = max(first, math.ceil(math.sqrt(blocks) * (style.block[1] + 1)))
    return iter(range(first, most + 1))


@dataclass(frozen=True)
class _Plan:
    """A floor of rows and columns of blocks. Cells are counted from the corner of its streets."""

    request: Request
    style: Style
    kinds: dict[int, list[_Kind]]
    rows: int
    columns: int

    @cached_property
    def street_x(self) -> np.ndarray:
        """Columns of the streets along y."""
        return self._streets(self.columns, self.style.block[1], self._doubled(2), self._doubled(0))

    @cached_property
    def street_y(self) -> np.ndarray:
        """Rows of the streets along x."""
        return self._streets(self.rows, self.style.block[0], self._doubled(3), self._doubled(1))

    def _doubled(self, side: int) -> bool:
        return bool(self.kinds.get(side))

    @staticmethod
    def _streets(blocks: int, length: int, first_twice: bool, last_twice: bool) -> np.ndarray:
        at = np.arange(blocks + 1) * (length + 1) + first_twice
        before = [0] if first_twice else []
        return np.r_[before, at, [at[-1] + 1] if last_twice else []].astype(int)

    @cached_property
    def queue(self) -> int:
        """Cells of a lane before its service cell: more of them where ways are long."""
        most = max(QUEUE, WAIT + math.ceil((self.street_x[-1] + self.street_y[-1]) / FETCH))
        return max(most + self.style.more_queue, LEAST_QUEUE)

    @cached_property
    def corner(self) -> tuple[int, int]:
        """The cell of the drawing at which the streets begin: lanes and belts lie outside."""
        return self._margin(2), self._margin(3)

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Cells along y and x."""
        column, row = self.corner
        width = column + int(self.street_x[-1]) + 1 + self._margin(0)
        return row + int(self.street_y[-1]) + 1 + self._margin(1), width

    def _margin(self, side: int) -> int:
        kinds = [station.kind for station in self.kinds.get(side, ())]
        return (self.queue if kinds else 0) + (BELT_CELLS if set(kinds) & BELTED else 0)

    def fits(self, width: int, height: int) -> bool:
        """Returns whether a count of cells has room for it."""
        rows, columns = self.shape
        return rows <= height and columns <= width

    def cost(self) -> float:
        """Returns the area in cells, times the square root of how far from its aspect it is."""
        height, width = self.shape
        ratio = width / height / self.style.aspect
        return width * height * math.sqrt(max(ratio, 1 / ratio))

    # --- drawing

    def file(self, request: Request, name: str = "") -> LayoutFile:
        """Returns the layout file of the plan."""
        floor, stations = self.drawn()
        return LayoutFile(
            floor=floor,
            name=name,
            stations=stations,
            storage_units=request.shelves,
            robots=request.robots,
            items=request.items,
        )

    def drawn(self) -> tuple[np.ndarray, tuple[StationEntry, ...]]:
        """Returns the floor, (h, w) characters, and its stations."""
        floor = np.full(self.shape, lf.NO_FLOOR, "<U1")
        column, row = self.corner
        inside = floor[row:, column:][: self.street_y[-1] + 1, : self.street_x[-1] + 1]
        self._draw_streets(inside)
        self._draw_places(inside)
        stations = [s for side in self.kinds for s in self._stations(side)]
        letters = lf.SERVICE if len(stations) <= len(lf.SERVICE) else ""
        for i, station in enumerate(stations):
            self._draw_lane(floor, station)
            if letters:
                x, y = station.service
                floor[y, x] = letters[i]
        return floor, tuple(_keyed(stations, letters))

    def _draw_streets(self, inside: np.ndarray) -> None:
        if not self.style.is_one_way:
            inside[self.street_y] = lf.FLOOR
            inside[:, self.street_x] = lf.FLOOR
            return
        right, up, left, down = list(lf.ONE_WAY)
        rows = set(self.street_y.tolist())
        for y, is_ahead in zip(self.street_y, _directions(len(self.street_y), True)):
            inside[y] = right if is_ahead else left
        for x, is_ahead in zip(self.street_x, _directions(len(self.street_x), False)):
            step = 1 if is_ahead else -1
            for y in range(len(inside)):
                # Where streets cross, the row's arrow shows, unless another row follows.
                if y not in rows or y + step in rows:
                    inside[y, x] = up if is_ahead else down

    def _draw_places(self, inside: np.ndarray) -> None:
        """Draws storage in the blocks nearest to the stations, and parking behind it or before.

        Stations on several sides need a longer edge than storage needs room: what no robot parks
        on in the middle is not a floor then.
        """
        blocks = np.ones(inside.shape, bool)
        blocks[self.street_y] = blocks[:, self.street_x] = False
        cells = np.argwhere(blocks.T)[:, ::-1]
        cells = cells[np.argsort(-self._far(*cells.T), kind="stable")]
        robots = self.request.robots
        near = robots if self.style.parks_near else 0
        ends = [near, near + places_for(self.request.shelves)]
        front, storage, others = np.split(cells[::-1], ends)
        behind = others if self.style.sides == 1 else others[: robots - near]
        parking = np.concatenate([behind[::-1], front])
        inside[tuple(storage.T)] = lf.STORAGE
        inside[tuple(parking.T)] = lf.PARKING
        count = min(math.ceil(CHARGED * self.request.robots - 1e-9), len(parking))
        charging = parking[np.arange(count) * len(parking) // max(count, 1)]
        inside[tuple(charging.T)] = lf.CHARGING
        if len(behind) < len(others):
            used = np.concatenate([storage, parking])
            self._draw_hole(inside, int(self._far(*used.T).max()))

    def _far(self, y: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Returns how many cells lie between cells and the nearest side with stations."""
        ends = self.street_x[-1] - x, self.street_y[-1] - y, x, y
        return np.min([ends[side] for side in self.style.headings], axis=0)

    def _draw_hole(self, inside: np.ndarray, depth: int) -> None:
        """Leaves out the streets that are more than `depth` cells away from all stations."""
        y, x = np.ogrid[: inside.shape[0], : inside.shape[1]]
        rows, columns = np.nonzero(self._far(*np.broadcast_arrays(y, x)) > depth)
        within_y = self.street_y[np.isin(self.street_y, rows)]
        within_x = self.street_x[np.isin(self.street_x, columns)]
        if len(within_y) and len(within_x):
            inside[within_y[0] + 1 : within_y[-1], within_x[0] + 1 : within_x[-1]] = lf.NO_FLOOR

    def _stations(self, side: int) -> Iterator[StationEntry]:
        """Yields the stations of a side, evenly spread along it."""
        along = STEPS[(side + 1) % 4]  # as the outermost street leads
        length = int((self.street_y if side % 2 == 0 else self.street_x)[-1]) + 1
        count = len(self.kinds[side])
        for i, station in enumerate(self.kinds[side]):
            middle = int((i + 0.5) * length / count)
            if sum(along) < 0:
                middle = length - 1 - middle
            yield self._station(side, middle, station)

    def _station(self, side: int, middle: int, station: _Kind) -> StationEntry:
        """Returns a station whose lane leads away from a side's street, turns and comes back."""
        out, along = np.array(STEPS[side]), np.array(STEPS[(side + 1) % 4])
        base = self._street_cell(side, middle)
        there = [base - along + (i + 1) * out for i in range(self.queue)]
        back = [cell + 2 * along for cell in there[::-1]]
        return StationEntry(
            key=station.name,
            name=station.name,
            kind=station.kind,
            service=_cell(there[-1] + along),
            queue=tuple(map(_cell, there)),
            exit=tuple(map(_cell, back)),
        )

    def _street_cell(self, side: int, middle: int) -> np.ndarray:
        """Returns the cell of the outermost street of a side, `middle` cells from its begin."""
        ends = {0: self.street_x[-1], 1: self.street_y[-1], 2: 0, 3: 0}
        at = (ends[side], middle) if side % 2 == 0 else (middle, ends[side])
        return np.add(self.corner, at)

    def _draw_lane(self, floor: np.ndarray, station: StationEntry) -> None:
        for x, y in (*station.queue, station.service, *station.exit):
            floor[y, x] = lf.FLOOR
        out = np.subtract(station.queue[-1], station.queue[-2])
        along = np.subtract(station.service, station.queue[-1])
        if station.kind in BELTED:
            for i in range(BELT_CELLS):
                x, y = station.service + (i + 1) * out
                floor[y, x] = lf.BELT
        self._open_exit(floor, station.exit[-1] - out, along)

    @staticmethod
    def _open_exit(floor: np.ndarray, cell: np.ndarray, along: np.ndarray) -> None:
        """Lets robots that leave a lane choose between the two streets beside it."""
        arrow = lf.ONE_WAY[STEPS.index((int(along[0]), int(along[1])))]
        (x, y), (before_x, before_y) = cell, cell - along
        if floor[y, x] == arrow == floor[before_y, before_x]:
            floor[y, x] = lf.FLOOR


def _keyed(stations: Sequence[StationEntry], letters: str) -> Iterator[StationEntry]:
    for i, station in enumerate(stations):
        yield replace(station, key=letters[i]) if letters else station


def _directions(count: int, first: bool) -> list[bool]:
    """Returns which streets lead ahead: neighbours are opposed, and the last to the first."""
    out = [first == (i % 2 == 0) for i in range(count)]
    if count > 2 and out[-1] == first:
        # An odd number: the one before the last leads as its neighbour.
        out[-2:] = [first, not first]
    return out


def _cell(point: np.ndarray) -> Cell:
    return int(point[0]), int(point[1])
