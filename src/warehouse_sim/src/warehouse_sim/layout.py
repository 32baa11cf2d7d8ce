# SPDX-License-Identifier: Apache-2.0
"""Where everything stands: from a Request to the floor plan of a Kiva warehouse.

Seen from above, x to the right:

    ─────────────────────────────────   streets one cell wide; there is room to make them one-way,
    │ pp │ uuuu │ uuuu │ uuuu │ │       neighbours opposed and the outermost four going round
    │ pp │ uuuu │ uuuu │ uuuu │ │
    ──────────────────────────────d==   pp  parked robots, each facing its street
    │ pp │ uuuu │ uuuu │ uuuu │ │       uu  blocks of storage units, two deep: each has a street
    │ pp │ uuuu │ uuuu │ uuuu │ │       d== a drop point before a conveyor belt, at a street's end
    ─────────────────────────────────

All but the belts' centres lies on whole metres. A loaded robot leaves any unit's cell by the
street before it; one without a load may pass beneath the units as well.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from warehouse_sim import items as shelves

BLOCK_DEPTH = 2
BLOCK_LENGTH = 8  # at most
EMPTY_FLOOR = 101  # cells along x and y

# Along x, from the lane at the stations: the drop point, then a belt of 1.8 m that begins 0.1 m
# beyond the drop point's cell and fills two more.
DROP = 1
BELT = 2.5
LAST = 3


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
    item_unit: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # index into units
    item_place: np.ndarray = _none(3)  # x y z in the unit's frame
    belts: np.ndarray = _none(3)  # x y yaw
    drops: np.ndarray = _none(2)  # x y, before the belt of the same index
    has_own_floor: bool = True  # False: it stands on the floor of the world


SEED = 1  # of the regular layout, in which numbers and items follow the rows


def chance(seed):
    """What decides by chance where in a layout each stands; None for the regular one."""
    return None if seed == SEED else np.random.default_rng(seed)


def plan(request, seed=SEED):
    """The Layout of a resolved Request.

    The seed decides which robot parks where, where each unit stands and which items it holds;
    streets, blocks and belts are the same for all.
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

    @property
    def street_x(self):
        """Cells' x of the streets along y; the last is the stations' lane, right beside another."""
        return np.cumsum([0] + [n + 1 for n in self.parking + self.storage] + [1])

    @property
    def street_y(self):
        return np.arange(self.rows + 1) * (BLOCK_DEPTH + 1)

    @property
    def cells(self):
        """Of the whole floor, along x and y."""
        return int(self.street_x[-1]) + LAST + 1, int(self.street_y[-1]) + 1

    def cost(self):
        """Area, and half as much an area that is twice as long as wide."""
        width, height = self.cells
        return width * height * math.sqrt(max(width / height, height / width))


def _shapes(request):
    """Candidates: an odd number of rows lets the streets along x alternate and still go round."""
    slots = request.robots + request.shelves
    most = max(request.belts, math.ceil(math.sqrt(slots)))
    for rows in range(request.belts - 1 | 1, most + 3, 2):
        parking, storage = (
            _split(math.ceil(n / (rows * BLOCK_DEPTH))) for n in (request.robots, request.shelves)
        )
        yield _Shape(rows, parking, storage)


def _split(cells):
    """So many cells as blocks of nearly equal length."""
    blocks = math.ceil(cells / BLOCK_LENGTH)
    return tuple(cells // blocks + (i < cells % blocks) for i in range(blocks))


def _build(request, shape, rng):
    floor = _floor(*shape.cells)
    # From cells counted from the corner to metres in world.
    origin = np.array([floor.min_x + 0.5, floor.min_y + 0.5])
    robots, robot_yaw = _robots(request.robots, shape, rng)
    item_unit, item_place = shelves.spread(request.items, request.shelves, rng)
    drops = _drops(request.belts, shape)
    return Layout(
        floor=floor,
        robots=np.column_stack([robots + origin, robot_yaw]),
        units=_units(request.shelves, shape, rng) + origin,
        item_unit=item_unit,
        item_place=item_place,
        belts=np.pad(drops + (BELT - DROP, 0) + origin, ((0, 0), (0, 1))),
        drops=drops + origin,
    )


def _floor(width, height):
    """So many whole cells, centred about the origin as nearly as the grid permits."""
    west, south = -((width - 1) // 2) - 0.5, -((height - 1) // 2) - 0.5
    return Floor(west, west + width, south, south + height)


def _block_cells(shape, first, lengths):
    """All cells of the blocks whose first street along y has that index, (n, 2)."""
    starts = shape.street_x[first : first + len(lengths)] + 1
    xs = [x for start, length in zip(starts, lengths) for x in range(start, start + length)]
    ys = [y + 1 + i for y in shape.street_y[:-1] for i in range(BLOCK_DEPTH)]
    return np.array([(x, y) for x in xs for y in ys], float).reshape(-1, 2)


def _robots(count, shape, rng):
    """Cells and yaws of parked robots; the places nearest to the storage fill up first."""
    cells = _some(_block_cells(shape, 0, shape.parking), count, rng)
    upper = (cells[:, 1] - 1) % (BLOCK_DEPTH + 1) == BLOCK_DEPTH - 1
    return cells, np.where(upper, math.pi / 2, -math.pi / 2)


def _units(count, shape, rng):
    """Cells of storage units, numbered row by row; places left over are those near the parking."""
    return _some(_block_cells(shape, len(shape.parking), shape.storage), count, rng)


def _some(cells, count, rng):
    """So many of the cells: the last, row by row, or any in any order."""
    if rng is not None:
        return rng.permutation(cells)[:count]
    cells = cells[::-1][:count]
    return cells[np.lexsort((cells[:, 0], cells[:, 1]))]


def _drops(count, shape):
    """Drop points at the ends of streets along x, evenly spread over them."""
    streets = shape.rows + 1
    rows = ((np.arange(count) + 0.5) * streets / count - 0.5).astype(int)
    x = np.full(count, shape.street_x[-1] + DROP)
    return np.column_stack([x, shape.street_y[rows]]).astype(float)
