# SPDX-License-Identifier: Apache-2.0
"""Reads the FloorPlan of a world from the markings on its floor, its belts and its map."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.floor import floor_markings, lane_finder
from warehouse_layout.floor.floor_markings import Mark
from warehouse_layout.floor.floor_plan import ALL_EXITS, FloorPlan
from warehouse_layout.floor.interfaces import OccupancyGrid, Scenery, World

CONVEYOR = "conveyor_belt"  # the names of belts begin with it
UNIT, BELT = 50, 99  # values in the world's map: beneath a storage unit; a conveyor belt

Point = Sequence[float]  # x, y [m]


def of_world(world: World) -> FloorPlan:
    """Reads a kiva_plugin_cpp.World. Raises FloorError where markings contradict each other."""
    marks: list[Mark] = []
    belts: dict[str, Any] = {}  # x, y [m]
    for name in world.names:
        if floor_markings.is_name(name):
            marks += floor_markings.read(world.visuals(name), world.pose(name), name)
        elif name.startswith(CONVEYOR):
            belts[name] = world.pose(name)[:2]
    x, y, spacing, cells = world.occupancy()
    return of_parts(x, y, spacing, cells, marks, belts)


def of_messages(grid: OccupancyGrid, scenery: Scenery) -> FloorPlan:
    """Reads a nav_msgs/OccupancyGrid (/warehouse/map) and a Scenery.

    Raises FloorError where markings contradict each other.
    """
    corner, spacing = grid.info.origin.position, grid.info.resolution
    poses = np.reshape(scenery.pose, (-1, 7))
    belts = {n: p[:2] for n, p in zip(scenery.models, poses) if n.startswith(CONVEYOR)}
    marks = floor_markings.of_scenery(scenery)
    x, y = corner.x + spacing / 2, corner.y + spacing / 2
    return of_parts(x, y, spacing, occupancy_of(grid), marks, belts)


def of_parts(
    x: float,
    y: float,
    spacing: float,
    occupancy: ArrayLike,
    marks: Sequence[Mark],
    belts: Mapping[str, Point],
) -> FloorPlan:
    """Makes the FloorPlan of a world's map, (h, w) uint8 with cell (0, 0) at (x, y) [m].

    `spacing` is the edge of a cell [m], `marks` are those on the floor, `belts` is
    {name: (x, y)} [m]. Raises FloorError where markings contradict each other.
    """
    blank = _blank(x, y, spacing, np.asarray(occupancy))
    if marks:
        return floor_markings.applied(blank, marks, belts)
    return lane_finder.find(blank, belts, np.asarray(occupancy) == BELT)


def occupancy_of(grid: OccupancyGrid) -> np.ndarray:
    """Returns the cells of a nav_msgs/OccupancyGrid as World.occupancy() does, (h, w) uint8."""
    return np.array(grid.data, np.uint8).reshape(grid.info.height, grid.info.width)


def is_taken(occupancy: ArrayLike) -> np.ndarray:
    """Returns the cells of a map that are neither free nor beneath a storage unit, (h, w) bool."""
    return np.asarray(occupancy) >= BELT


def _blank(x: float, y: float, spacing: float, occupancy: np.ndarray) -> FloorPlan:
    """Returns the FloorPlan without markings: each unit's cell is storage."""
    free = ~is_taken(occupancy)
    none = np.zeros_like(free)
    exits = np.full(free.shape, ALL_EXITS, np.uint8)
    return FloorPlan.laid_out(
        origin=(x, y),
        spacing=spacing,
        passable=free,
        storage=occupancy == UNIT,
        parking=none,
        exits=exits,
        stations=(),
    )
