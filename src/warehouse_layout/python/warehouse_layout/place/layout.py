# SPDX-License-Identifier: Apache-2.0
"""Lays out a Kiva warehouse: from a Request to the place of each model, and the floor plan.

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
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from warehouse_layout.file import items as shelves
from warehouse_layout.file.request import Request
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import lane_mask
from warehouse_layout.place import one_way
from warehouse_layout.place.blocks import (
    BLOCK_DEPTH,
    Shape,
    mask_of,
    parking_cells,
    places_for,
    shapes,
    storage_cells,
)

EMPTY_FLOOR = 101  # cells along x and y
CHARGED = 0.2  # places to charge at a robot

# Along x, from the street beside a lane of one cell, as where fit() puts them: the drop point, then
# a belt of 1.8 m that begins 0.1 m beyond the drop point's cell and fills two more.
DROP = 1
BELT = 2.5

SEED = 1  # of the regular layout, in which numbers and items follow the rows


@dataclass(frozen=True)
class Floor:
    """A rectangle along the axes of `world` [m]."""

    min_x: float
    max_x: float
    min_y: float
    max_y: float

    @property
    def size(self) -> tuple[float, float]:
        """Edges along x and y [m]."""
        return self.max_x - self.min_x, self.max_y - self.min_y

    @property
    def centre(self) -> tuple[float, float]:
        """The point x, y in the middle, in `world` [m]."""
        return (self.min_x + self.max_x) / 2, (self.min_y + self.max_y) / 2


def _none(columns: int) -> Callable[[], np.ndarray]:
    return lambda: np.zeros((0, columns))


@dataclass(frozen=True)
class Layout:
    """Poses in `world` [m, rad]; entry i belongs to robot, unit, item or belt number i + 1."""

    floor: Floor
    robots: np.ndarray = field(default_factory=_none(3))  # x y yaw
    units: np.ndarray = field(default_factory=_none(2))  # x y
    places: np.ndarray = field(default_factory=_none(2))  # x y of all storage places
    item_unit: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # index into units
    item_place: np.ndarray = field(default_factory=_none(3))  # x y z in the unit's frame
    belts: np.ndarray = field(default_factory=_none(3))  # x y yaw
    belt_lengths: np.ndarray | None = None  # [m]; None: each as its model is
    drops: np.ndarray = field(default_factory=_none(2))  # x y, before the belt of the same index
    plan: FloorPlan | None = None  # streets and stations; None: nothing is marked on the floor
    walls: np.ndarray = field(default_factory=_none(4))  # x y size_x size_y of boxes, a metre high
    has_own_floor: bool = True  # False: it uses the floor of the world
    where: str = ""  # the part of that floor, named for people


def chance(seed: int) -> np.random.Generator | None:
    """Returns the random generator that shuffles a layout; None for the regular one."""
    return None if seed == SEED else np.random.default_rng(seed)


def plan(request: Request, seed: int = SEED) -> Layout:
    """Returns the Layout of a resolved Request.

    The seed decides which robot parks where, on which place each unit stands and which items it
    holds; streets, places, stations and belts are the same for all.
    """
    if not (request.robots or request.shelves):
        return Layout(_floor(EMPTY_FLOOR, EMPTY_FLOOR))
    shape = min(shapes(request), key=Shape.cost)
    return _build(request, shape, chance(seed))


def _build(request: Request, shape: Shape, rng: np.random.Generator | None) -> Layout:
    floor = _floor(*shape.cells)
    # From cells counted from the corner to metres in world.
    origin = np.array([floor.min_x + 0.5, floor.min_y + 0.5])
    robots, robot_yaw = parked(request.robots, shape, rng)
    places = some(storage_cells(shape), places_for(request.shelves))
    units = _filled(places, request.shelves, rng)
    item_unit, item_place = shelves.spread(request.items, request.shelves, rng)
    drops = one_way.drops(shape)
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
        plan=_marked(shape, places, origin, charging(request.robots, shape)),
    )


def _floor(width: int, height: int) -> Floor:
    """Returns a floor of whole cells, centred about the origin as nearly as the grid permits."""
    west, south = -((width - 1) // 2) - 0.5, -((height - 1) // 2) - 0.5
    return Floor(west, west + width, south, south + height)


def parked(
    count: int, shape: Shape, rng: np.random.Generator | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Returns cells and yaws of parked robots; the places nearest to the storage fill up first."""
    cells = parking_cells(shape)
    cells = some(cells, count) if rng is None else rng.permutation(cells)[:count]
    upper = (cells[:, 1] - 1) % (BLOCK_DEPTH + 1) == BLOCK_DEPTH - 1
    return cells, np.where(upper, math.pi / 2, -math.pi / 2)


def some(cells: np.ndarray, count: int) -> np.ndarray:
    """Returns the last `count` of the cells, row by row."""
    cells = cells[::-1][:count]
    return cells[np.lexsort((cells[:, 0], cells[:, 1]))]


def _filled(places: np.ndarray, count: int, rng: np.random.Generator | None) -> np.ndarray:
    """Returns `count` of the places: evenly spread, or random ones in random order."""
    if rng is not None:
        return rng.permutation(places)[:count]
    return places[np.arange(count) * len(places) // max(count, 1)]


def charging(robots: int, shape: Shape) -> np.ndarray:
    """Returns the cells of parking where robots are charged, evenly spread, (n, 2)."""
    cells = parking_cells(shape)
    count = min(math.ceil(CHARGED * robots - 1e-9), len(cells))
    return cells[np.arange(count) * len(cells) // max(count, 1)]


def _marked(
    shape: Shape, places: np.ndarray, origin: np.ndarray, charging: np.ndarray
) -> FloorPlan:
    """Returns the FloorPlan of a shape; all its arrays are (y, x)."""
    width, height = shape.cells
    right, top = shape.street_x[-1], shape.street_y[-1]
    blocks = mask_of(parking_cells(shape), shape) | mask_of(storage_cells(shape), shape)
    storage = mask_of(places, shape)
    stations = one_way.stations(shape)
    inside = np.zeros((height, width), bool)
    inside[: top + 1, : right + 1] = True
    return FloorPlan.laid_out(
        origin=origin,
        spacing=1.0,
        passable=inside | lane_mask(stations, inside.shape),
        storage=storage,
        parking=blocks & ~storage,
        exits=one_way.exits(shape, inside & ~blocks, stations),
        stations=stations,
        charging=mask_of(charging, shape),
    )
