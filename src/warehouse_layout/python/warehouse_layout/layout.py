# SPDX-License-Identifier: Apache-2.0
"""Where everything stands: from a Request to the floor plan of a Kiva warehouse.

Seen from above, x to the right:

         x s q                      q  queue of a station, entered from the street beside it
         x   q                      s  its service cell, passed without turning
         x   q                      x  and the way back from there to the street
    ←─────────────────────────────
    ──────────────────────────────→ two streets or more along the stations, neighbours opposed
    │ pp │ uuuu │ uuuu │ uuuu │ │ x x x x
    │ pp │ uuuu │ uuuu │ uuuu │ │       s ==  PICK station before a conveyor belt
    ──────────────────────────────→ q q q q
    │ pp │ uuuu │ uuuu │ uuuu │ │
    │ pp │ uuuu │ uuuu │ uuuu │ │   pp  parked robots, each facing its street
    ──────────────────────────────  uu  blocks of storage places, two deep: each has a street

REPLENISH stations lie along y's upper edge. All but the belts' centres lies on whole metres.
Streets are one cell wide and one-way, neighbours opposed, and the outermost go round. A loaded
robot leaves any place's cell by the street before it; one without a load may pass beneath the
units as well, and cross streets.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from warehouse_layout import items as shelves
from warehouse_layout.floor_plan import ALL_EXITS, FloorPlan
from warehouse_layout.stations import PICK, REPLENISH, Station, lane_mask, neighbour

BLOCK_DEPTH = 2
BLOCK_LENGTH = 8  # at most
EMPTY_FLOOR = 101  # cells along x and y

# Cells of a lane before its service cell: the entry, four to wait in and the corner at the least.
# As many more as it takes to keep the station busy on a long way: at top speed one drives so many
# cells while two units are exchanged, one every 20 s.
QUEUE, WAIT, FETCH = 6, 4, 60
CROWDED = 20  # so many picking stations need a third street beside them

CHARGED = 0.2  # places to charge at a robot
FILLED = 0.85  # share of the storage places on which a unit stands
PICKS_TO_REPLENISH = 2  # stations of the one kind for each of the other

# Along x, from the street beside a lane of one cell, as where fit() puts them: the drop point, then
# a belt of 1.8 m that begins 0.1 m beyond the drop point's cell and fills two more.
DROP = 1
BELT = 2.5


@dataclass(frozen=True)
class Floor:
    """A rectangle along the axes of `world` [m]."""

    min_x: float
    max_x: float
    min_y: float
    max_y: float

    @property
    def size(self):
        return self.max_x - self.min_x, self.max_y - self.min_y

    @property
    def centre(self):
        return (self.min_x + self.max_x) / 2, (self.min_y + self.max_y) / 2


def _none(columns):
    return field(default_factory=lambda: np.zeros((0, columns)))


@dataclass(frozen=True)
class Layout:
    """Poses in `world` [m, rad]; entry i belongs to robot, unit, item or belt number i + 1."""

    floor: Floor
    robots: np.ndarray = _none(3)  # x y yaw
    units: np.ndarray = _none(2)  # x y
    places: np.ndarray = _none(2)  # x y of all storage places
    item_unit: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # index into units
    item_place: np.ndarray = _none(3)  # x y z in the unit's frame
    belts: np.ndarray = _none(3)  # x y yaw
    drops: np.ndarray = _none(2)  # x y, before the belt of the same index
    plan: FloorPlan = None  # streets and stations; None: nothing is marked on the floor
    has_own_floor: bool = True  # False: it stands on the floor of the world
    where: str = ""  # on which part of that, for a person


SEED = 1  # of the regular layout, in which numbers and items follow the rows


def chance(seed):
    """What decides by chance where in a layout each stands; None for the regular one."""
    return None if seed == SEED else np.random.default_rng(seed)


def plan(request, seed=SEED):
    """The Layout of a resolved Request.

    The seed decides which robot parks where, on which place each unit stands and which items it
    holds; streets, places, stations and belts are the same for all.
    """
    if not (request.robots or request.shelves):
        return Layout(_floor(EMPTY_FLOOR, EMPTY_FLOOR))
    shape = min(_shapes(request), key=_Shape.cost)
    return _build(request, shape, chance(seed))


@dataclass(frozen=True)
class _Shape:
    """Rows of blocks along y, and the blocks' lengths along x: first parking, then storage."""

    rows: int
    parking: tuple
    storage: tuple
    picks: int  # stations

    @property
    def street_x(self):
        """Cells' x of the streets along y; the last, at the stations, are side by side."""
        beside = [1] * (2 if self.picks >= CROWDED else 1)
        return np.cumsum([0] + [n + 1 for n in self.parking + self.storage] + beside)

    @property
    def street_y(self):
        """Cells' y of the streets along x; the last two likewise."""
        return np.append(np.arange(self.rows + 1) * (BLOCK_DEPTH + 1), self._top)

    @property
    def _top(self):
        return self.rows * (BLOCK_DEPTH + 1) + 1

    @property
    def queue(self):
        """Cells of a lane before its service cell."""
        return max(QUEUE, WAIT + math.ceil((self.street_x[-1] + self._top) / FETCH))

    @property
    def block_y(self):
        """Cells' y of the lowest places of each row of blocks."""
        return self.street_y[:-2] + 1

    @property
    def cells(self):
        """Of the whole floor, along x and y: lanes lie beyond the last streets."""
        lane = self.queue if self.picks else 0
        return int(self.street_x[-1]) + lane + (3 if lane else 1), self._top + lane + 1

    def cost(self):
        """Area, and half as much an area that is twice as long as wide."""
        width, height = self.cells
        return width * height * math.sqrt(max(width / height, height / width))


def _shapes(request):
    """Candidates: an even number of rows lets the streets along x alternate and still go round."""
    places = places_for(request.shelves)
    most = max(request.belts, math.ceil(math.sqrt(request.robots + places)), 2)
    for rows in range(max(2, request.belts + request.belts % 2), most + 3, 2):
        parking, storage = (
            _split(math.ceil(n / (rows * BLOCK_DEPTH))) for n in (request.robots, places)
        )
        yield _Shape(rows, parking, storage, request.belts)


def places_for(units):
    """How many storage places a warehouse of so many units has."""
    return math.ceil(units / FILLED - 1e-9)


def _split(cells):
    """So many cells as blocks of nearly equal length."""
    blocks = math.ceil(cells / BLOCK_LENGTH)
    return tuple(cells // blocks + (i < cells % blocks) for i in range(blocks))


def _build(request, shape, rng):
    floor = _floor(*shape.cells)
    # From cells counted from the corner to metres in world.
    origin = np.array([floor.min_x + 0.5, floor.min_y + 0.5])
    robots, robot_yaw = _robots(request.robots, shape, rng)
    places = _some(_storage(shape), places_for(request.shelves))
    units = _filled(places, request.shelves, rng)
    item_unit, item_place = shelves.spread(request.items, request.shelves, rng)
    drops = _drops(shape)
    belts = drops + (BELT - DROP, 0)
    return Layout(
        floor=floor,
        robots=np.column_stack([robots + origin, robot_yaw]),
        units=units + origin,
        places=places + origin,
        item_unit=item_unit,
        item_place=item_place,
        belts=np.pad(belts + origin, ((0, 0), (0, 1))),
        drops=drops + origin,
        plan=_marked(shape, places, drops, origin, _charging(request.robots, shape)),
    )


def _floor(width, height):
    """So many whole cells, centred about the origin as nearly as the grid permits."""
    west, south = -((width - 1) // 2) - 0.5, -((height - 1) // 2) - 0.5
    return Floor(west, west + width, south, south + height)


def _block_cells(shape, first, lengths):
    """All cells of the blocks whose first street along y has that index, (n, 2)."""
    starts = shape.street_x[first : first + len(lengths)] + 1
    xs = [x for start, length in zip(starts, lengths) for x in range(start, start + length)]
    ys = [y + i for y in shape.block_y for i in range(BLOCK_DEPTH)]
    return np.array([(x, y) for x in xs for y in ys], float).reshape(-1, 2)


def _parking(shape):
    return _block_cells(shape, 0, shape.parking)


def _storage(shape):
    return _block_cells(shape, len(shape.parking), shape.storage)


def _robots(count, shape, rng):
    """Cells and yaws of parked robots; the places nearest to the storage fill up first."""
    cells = _parking(shape)
    cells = _some(cells, count) if rng is None else rng.permutation(cells)[:count]
    upper = (cells[:, 1] - 1) % (BLOCK_DEPTH + 1) == BLOCK_DEPTH - 1
    return cells, np.where(upper, math.pi / 2, -math.pi / 2)


def _some(cells, count):
    """So many of the cells, the last; row by row."""
    cells = cells[::-1][:count]
    return cells[np.lexsort((cells[:, 0], cells[:, 1]))]


def _filled(places, count, rng):
    """So many of the places: evenly spread, or any in any order."""
    if rng is not None:
        return rng.permutation(places)[:count]
    return places[np.arange(count) * len(places) // max(count, 1)]


def _drops(shape):
    """Service cells before belts, evenly spread over the rows: queues go on from streets."""
    rows = _spread(shape.picks, shape.rows)
    x = np.full(shape.picks, shape.street_x[-1] + shape.queue)
    return np.column_stack([x, shape.street_y[rows] + 1]).astype(float)


def _spread(count, of):
    """So many of the numbers below `of`, evenly spread."""
    return ((np.arange(count) + 0.5) * of / max(count, 1)).astype(int)


# --- streets and stations


def _charging(robots, shape):
    """Cells of parking where robots are charged, evenly spread."""
    cells = _parking(shape)
    count = min(math.ceil(CHARGED * robots - 1e-9), len(cells))
    return cells[np.arange(count) * len(cells) // max(count, 1)]


def _marked(shape, places, drops, origin, charging):
    """The FloorPlan of a shape; all its arrays are (y, x)."""
    width, height = shape.cells
    right, top = shape.street_x[-1], shape.street_y[-1]
    blocks = [_mask(cells, shape) for cells in (_parking(shape), _storage(shape))]
    storage = _mask(places, shape)
    stations = [*_picks(shape, drops, width), *_replenishments(shape, width)]
    inside = np.zeros((height, width), bool)
    inside[: top + 1, : right + 1] = True
    streets = inside & ~blocks[0] & ~blocks[1]
    lane = lane_mask(stations, inside.shape)
    return FloorPlan.laid_out(
        origin=origin,
        spacing=1.0,
        passable=inside | lane,
        storage=storage,
        parking=(blocks[0] | blocks[1]) & ~storage,
        exits=_one_way(shape, streets, stations),
        stations=stations,
        charging=_mask(charging, shape),
    )


def _mask(cells, shape):
    """(h, w) of those cells (n, 2)."""
    width, height = shape.cells
    out = np.zeros((height, width), bool)
    x, y = cells.astype(int).T
    out[y, x] = True
    return out


def _picks(shape, drops, width):
    """There along a row, past the belt, and back: to the street where it has gone on by a bit."""
    x = int(shape.street_x[-1]) + 1 + np.arange(shape.queue)
    for i, y in enumerate(drops[:, 1].astype(int), start=1):
        lane = np.r_[(y - 1) * width + x, y * width + x[-1], (y + 1) * width + x[::-1]]
        yield Station(f"pick{i}", PICK, lane.astype(np.int32), shape.queue, f"conveyor_belt{i}")


def _replenishments(shape, width):
    """Likewise along columns, towards lower x."""
    y = int(shape.street_y[-1]) + 1 + np.arange(shape.queue)
    right = int(shape.street_x[-1])
    # Lanes are three cells wide; as long as there is room, they don't touch.
    count = min(math.ceil(shape.picks / PICKS_TO_REPLENISH), max(1, (right - 1) // 3))
    for i, x in enumerate(2 + _spread(count, right - 1), start=1):
        lane = np.r_[y * width + x, y[-1] * width + x - 1, y[::-1] * width + x - 2]
        yield Station(f"replenish{i}", REPLENISH, lane.astype(np.int32), shape.queue)


def _one_way(shape, streets, stations):
    """(h, w) uint8: streets are left ahead, into places and lanes, and across the other way at a
    lane's exit; all else as one likes."""
    leaves = [np.zeros_like(streets) for _ in range(4)]
    right, top = shape.street_x[-1], shape.street_y[-1]
    for k, y in enumerate(shape.street_y):
        leaves[2 * (k % 2)][y, : right + 1] = True
    for k, x in enumerate(shape.street_x[::-1]):
        leaves[3 if x == 0 else 1 + 2 * (k % 2)][: top + 1, x] = True
    # The street beside the lanes may be crossed: who leaves a lane chooses between both.
    for station in stations:
        y, x = divmod(int(station.cells[-1]), streets.shape[1])
        beside = (y, right) if station.kind == PICK else (top, x)
        leaves[2 if station.kind == PICK else 3][beside] = True
    out = np.full(streets.shape, ALL_EXITS, np.uint8)
    for heading in range(4):
        # Into what is no street: places, and lanes where they may be entered.
        leaves[heading] |= ~neighbour(streets, heading)
        out[streets & ~leaves[heading]] &= ~np.uint8(1 << heading)
    return out
