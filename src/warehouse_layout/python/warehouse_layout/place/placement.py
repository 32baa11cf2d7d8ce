# SPDX-License-Identifier: Apache-2.0
"""Places everything that a layout file describes: from its drawing to the Layout of a warehouse."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from warehouse_layout.file import drawn_floor, station_lanes, stock_file, walls
from warehouse_layout.file import items as shelves
from warehouse_layout.file.drawn_floor import DrawnFloor
from warehouse_layout.file.item_weights import ItemWeights
from warehouse_layout.file.layout_file import Cell, LayoutFile, LayoutFileError
from warehouse_layout.file.sku_master import SkuMasterError
from warehouse_layout.file.stock_file import StockRow
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import PICK, STEPS, Station
from warehouse_layout.place.layout import SEED, Floor, Layout, chance

BELT_CELLS = 2  # of one conveyor belt; a longer one is several, one behind the other
OFF_GRID = 1e-4  # largest offset of a cell's centre from the grid [cells]
HEADINGS = (1, 3, 0, 2)  # in which parked robots face a street, the first that there is


def place(file: LayoutFile, seed: int = SEED, robots: int | None = None) -> Layout:
    """Returns the Layout of a file; `robots` replaces its number of robots.

    The seed decides which robot parks where, on which place each unit stands and which items it
    holds, where the file gives counts. Raises what place_by_chance() raises.
    """
    return place_by_chance(file, chance(seed), robots)


def place_by_chance(
    file: LayoutFile, rng: np.random.Generator | None, robots: int | None = None
) -> Layout:
    """Returns the Layout of a file, as place() does; `rng` None: the regular one.

    Raises LayoutFileError for a station without a lane, and
    where more is asked than there is room for. Whether a fleet can work there is not checked.
    """
    drawn = drawn_floor.areas(file.floor)
    _check_at(file)
    stations, faults = station_lanes.of_file(file, drawn)
    if faults:
        raise LayoutFileError(f"{file.path or file.title}: {faults[0].text}")
    return _Placement(file, drawn, rng).layout(stations, file.robots if robots is None else robots)


def plan_of(file: LayoutFile, drawn: DrawnFloor, stations: Sequence[Station]) -> FloorPlan:
    """Returns the FloorPlan of a drawing with these stations."""
    return FloorPlan.laid_out(
        origin=origin(file),
        spacing=file.spacing,
        passable=drawn.passable,
        storage=drawn.storage,
        parking=drawn.parking,
        exits=drawn_floor.exits(file.floor, drawn, list(stations)),
        stations=stations,
        charging=drawn.charging,
        elevators=[elevator.of_plan(file.shape[1]) for elevator in file.elevators],
    )


def origin(file: LayoutFile) -> tuple[float, float]:
    """Returns x and y of the centre of cell (0, 0) in `world` [m]: on the grid, and centred."""
    if file.at:
        return file.at
    height, width = file.shape
    return -((width - 1) // 2) * file.spacing, -((height - 1) // 2) * file.spacing


def stock_of(file: LayoutFile, units: int) -> list[StockRow]:
    """Returns the rows of a file's stock, one an item; [] without. Raises LayoutFileError."""
    try:
        return stock_file.read(file.beside_file(file.stock), units) if file.stock else []
    except stock_file.StockFileError as error:
        raise LayoutFileError(str(error)) from error


def weights_of(file: LayoutFile) -> ItemWeights | None:
    """Returns what items weigh by a file's SKU master; None without. Raises LayoutFileError."""
    try:
        return ItemWeights.read(file.beside_file(file.skus)) if file.skus else None
    except SkuMasterError as error:
        raise LayoutFileError(str(error)) from error


def _check_at(file: LayoutFile) -> None:
    """Raises LayoutFileError unless cells lie on the grid of `world`, on which robots stop."""
    cells = np.divide(file.at or (0.0, 0.0), file.spacing)
    if (np.abs(cells - np.round(cells)) > OFF_GRID).any():
        raise LayoutFileError(
            f"{file.path or file.title}: at is {list(file.at or ())}; whole multiples of the"
            f" spacing, {file.spacing:g} m, were expected"
        )


class _Placement:
    def __init__(
        self, file: LayoutFile, drawn: DrawnFloor, rng: np.random.Generator | None
    ) -> None:
        self._file, self._drawn, self._rng = file, drawn, rng

    def layout(self, stations: Sequence[Station], robots: int | tuple[Cell, ...]) -> Layout:
        file, drawn = self._file, self._drawn
        places = np.argwhere(drawn.storage)[:, ::-1]
        # The order of these is the order in which chance is asked: robots, units, items.
        parked = self._robots(robots)
        units = self._units(places)
        if len(parked) < (robots if isinstance(robots, int) else 0):
            parked = np.concatenate([parked, self._beneath(places, units, robots, len(parked))])
        item_unit, item_place = self._items(len(units))
        item_mass = self._masses(len(units))
        belts = list(_belts(drawn, stations))
        return Layout(
            floor=self._floor(),
            robots=np.column_stack([self._world(parked), [self._yaw(c) for c in parked.tolist()]]),
            units=self._world(units),
            places=self._world(places),
            item_unit=item_unit,
            item_place=item_place,
            item_mass=item_mass,
            belts=self._belt_poses(belts),
            belt_lengths=np.array([len(run) * file.spacing - 0.2 for run in belts]),
            drops=self._drops(stations),
            plan=plan_of(file, drawn, _with_belts(stations, belts, file.shape)),
            walls=self._walls(),
            has_own_floor=not file.building,
            where=f"as {file.title} is drawn" if file.building else "",
        )

    def _fail(self, text: str) -> LayoutFileError:
        return LayoutFileError(f"{self._file.path or self._file.title}: {text}")

    def _world(self, cells: np.ndarray) -> np.ndarray:
        """Returns x y in `world` [m] of cells (n, 2): column, row."""
        return np.reshape(cells, (-1, 2)) * self._file.spacing + origin(self._file)

    def _floor(self) -> Floor:
        (height, width), spacing = self._file.shape, self._file.spacing
        x, y = np.subtract(origin(self._file), spacing / 2).tolist()
        return Floor(x, x + width * spacing, y, y + height * spacing)

    def _robots(self, robots: int | tuple[Cell, ...]) -> np.ndarray:
        """Returns cells (n, 2) for robots: those named, or parking from the highest column on."""
        if isinstance(robots, tuple):
            return self._named(robots, self._drawn.passable, "a robot", "where no robot can stand")
        parking = np.argwhere(self._drawn.parking.T)
        if self._rng is not None:
            return self._rng.permutation(parking)[:robots]
        parking = parking[::-1][:robots]
        return parking[np.lexsort((parking[:, 0], parking[:, 1]))]

    def _units(self, places: np.ndarray) -> np.ndarray:
        """Returns cells (n, 2) for units: those named, or places evenly spread, or by chance."""
        asked = self._file.storage_units
        if isinstance(asked, tuple):
            storage = self._drawn.storage
            return self._named(asked, storage, "a storage unit", "which is not a storage place 's'")
        count = round(asked * len(places)) if isinstance(asked, float) else asked
        if count > len(places):
            raise self._fail(
                f"{count} storage units, but {len(places)} storage places 's' are drawn"
            )
        if self._rng is not None:
            return self._rng.permutation(places)[:count]
        return places[np.arange(count) * len(places) // max(count, 1)]

    def _beneath(
        self, places: np.ndarray, units: np.ndarray, robots: int | tuple[Cell, ...], parked: int
    ) -> np.ndarray:
        """Returns places (n, 2) beneath storage units for the robots that find no parking."""
        assert isinstance(robots, int)
        rng = self._rng or np.random.default_rng(SEED)
        chosen = rng.permutation(units if len(units) else places)[: robots - parked]
        if parked + len(chosen) < robots:
            raise self._fail(
                f"{robots:,} robots, but there is room for {parked + len(chosen):,}: {parked:,} on"
                f" parking 'p' and 'c', {len(chosen)} beneath storage units"
            )
        return chosen

    def _named(
        self, cells: tuple[Cell, ...], allowed: np.ndarray, what: str, otherwise: str
    ) -> np.ndarray:
        for column, row in cells:
            if not allowed[row, column]:
                raise self._fail(f"{what} is at [{column}, {row}], {otherwise}")
        return np.array(cells, int).reshape(-1, 2)

    def _items(self, units: int) -> tuple[np.ndarray, np.ndarray]:
        """Returns the unit of each item, an index, and its place there; by the stock file if one is
        named."""
        self._check_items(units)
        if not self._file.stock:
            return shelves.spread(self._file.items, units, self._rng)
        unit = np.array([row.unit - 1 for row in stock_of(self._file, units)], int)
        return unit, shelves.stacked(unit)

    def _masses(self, units: int) -> np.ndarray | None:
        """Returns the mass of each item [kg]; None without a SKU master."""
        weights = weights_of(self._file)
        if not weights:
            return None
        rows = stock_of(self._file, units)
        return np.array([weights.of(row.sku, row.quantity) for row in rows], float)

    def _check_items(self, units: int) -> None:
        most = units * shelves.CAPACITY
        if self._file.items > most:
            raise self._fail(
                f"{self._file.items} items, but {units} storage units hold {most}:"
                f" {shelves.CAPACITY} each"
            )

    def _yaw(self, cell: Sequence[int]) -> float:
        """Returns the heading [rad] towards a street beside a cell."""
        column, row = cell
        streets = drawn_floor.beside(self._drawn.streets, (column, row))
        heading = next((h for h in HEADINGS if h in streets), 0)
        return {0: 0.0, 1: math.pi / 2, 2: math.pi, 3: -math.pi / 2}[heading]

    def _belt_poses(self, belts: Sequence[list[Cell]]) -> np.ndarray:
        """Returns x y yaw of belts in `world` [m, rad], (n, 3); each leads away from its start."""
        rows = []
        for run in belts:
            x, y = self._world(np.array(run)).mean(axis=0)
            dx, dy = np.subtract(run[-1], run[0])
            rows.append((x, y, math.atan2(dy, dx)))
        return np.array(rows, float).reshape(-1, 3)

    def _drops(self, stations: Sequence[Station]) -> np.ndarray:
        """Returns the service cells of picking stations in `world` [m], (n, 2)."""
        width = self._file.shape[1]
        cells = [divmod(s.service_cell, width)[::-1] for s in stations if s.kind == PICK]
        return self._world(np.array(cells, float))

    def _walls(self) -> np.ndarray:
        """Returns x y size_x size_y [m] of the boxes of walls, (n, 4)."""
        shapes = walls.boxes(self._drawn.walls, self._file.spacing)
        return shapes + np.pad(origin(self._file), (0, 2))


def _with_belts(
    stations: Sequence[Station], belts: Sequence[list[Cell]], shape: tuple[int, int]
) -> list[Station]:
    """Returns the stations with the names of the belts that begin beside their service cells."""
    first = {run[0]: f"conveyor_belt{n}" for n, run in reversed(list(enumerate(belts, start=1)))}
    out = []
    for station in stations:
        row, column = divmod(station.service_cell, shape[1])
        near = [first.get((column + dx, row + dy), "") for dx, dy in STEPS]
        belt = next(filter(None, near), "") if station.kind == PICK else ""
        out.append(replace(station, belt=belt))
    return out


def _belts(drawn: DrawnFloor, stations: Sequence[Station]) -> Iterator[list[Cell]]:
    """Yields the cells of each conveyor belt in a row, the first beside a station if one is there.

    Belts at picking stations come first, in the order of the stations.
    """
    left = drawn.belts.copy()
    width = left.shape[1]
    runs: list[list[Cell]] = []
    for station in stations:
        if station.kind != PICK:
            continue
        row, column = divmod(station.service_cell, width)
        for heading in drawn_floor.beside(left, (column, row)):
            dx, dy = STEPS[heading]
            runs.append(_run(left, (column + dx, row + dy), heading))
    at_stations = [run[:BELT_CELLS] for run in runs]
    rest = [run[BELT_CELLS:] for run in runs if len(run) > BELT_CELLS]
    for row, column in np.argwhere(left).tolist():
        if left[row, column]:
            along = 0 if drawn_floor.beside(left, (column, row))[:1] != [1] else 1
            rest.append(_run(left, (column, row), along))
    yield from at_stations
    for run in rest:
        for i in range(0, len(run), BELT_CELLS):
            yield run[i : i + BELT_CELLS]


def _run(left: np.ndarray, cell: Cell, heading: int) -> list[Cell]:
    """Returns the cells of `left` from this one on in a heading, and takes them out of it."""
    (dx, dy), (column, row) = STEPS[heading], cell
    height, width = left.shape
    run = []
    while 0 <= column < width and 0 <= row < height and left[row, column]:
        left[row, column] = False
        run.append((column, row))
        column, row = column + dx, row + dy
    return run
