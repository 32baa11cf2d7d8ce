# SPDX-License-Identifier: Apache-2.0
"""The floor that a fleet drives on: streets, storage places, stations with lanes, cell by cell.

A FloorPlan is read from a world, never kept beside it: what is painted on the floor (see
floor_markings) and what stands there tell all of it.

    plan = FloorPlan.of_world(World.preset("huge"))
    planner = epibt(plan.floor(), Rules(following=False))
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from warehouse_layout import floor_markings, lane_finder
from warehouse_layout._core import Floor, FloorError, check_layout
from warehouse_layout.stations import PICK, REPLENISH, Station, lane_mask, with_lanes

__all__ = ["PICK", "REPLENISH", "FloorError", "FloorPlan", "Station"]

ALL_EXITS = 0b1111
CONVEYOR = "conveyor_belt"  # names of belts begin so
UNIT, BELT = 50, 99  # of a cell of the world's map: beneath a storage unit; a conveyor belt


@dataclass(frozen=True, eq=False)
class FloorPlan:
    """Arrays have a row for each y; cell (0, 0) is the one of the lowest x and y.

    Headings count quarter turns from +x towards +y.
    """

    origin: tuple  # x, y of the centre of cell (0, 0), in world [m]
    spacing: float  # edge of a cell [m]
    passable: np.ndarray  # (h, w) bool: where a robot without a load may drive
    storage: np.ndarray  # (h, w) bool: storage places
    parking: np.ndarray  # (h, w) bool: where robots without work stand; loaded ones keep out
    exits: np.ndarray  # (h, w) uint8, bit h: may be left towards heading h
    obstructed: np.ndarray  # (h, w) bool: passable, but for what stands there now
    stations: tuple = ()  # of Station
    without_lane: tuple = ()  # texts: which belts have no station, and why
    charging: np.ndarray = ()  # cells in which robots are charged, ascending

    @property
    def shape(self):
        """Cells along y and x."""
        return self.passable.shape

    @property
    def width(self):
        return self.passable.shape[1]

    @cached_property
    def lane(self):
        """(h, w) bool: cells of stations' lanes."""
        return lane_mask(self.stations, self.shape)

    def station(self, name):
        """The Station of that name. KeyError if there is none."""
        return {s.name: s for s in self.stations}[name]

    def cell_of(self, x, y):
        """The cell around a place in world [m]; -1 off the floor. Numbers, or arrays alike."""
        column = np.floor((np.asarray(x) - self.origin[0]) / self.spacing + 0.5).astype(np.int32)
        row = np.floor((np.asarray(y) - self.origin[1]) / self.spacing + 0.5).astype(np.int32)
        height, width = self.shape
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        cell = np.where(inside, row * width + column, -1).astype(np.int32)
        return cell if cell.ndim else int(cell)

    def point_of(self, cell):
        """(x, y) of the centres of cells, in world [m]."""
        row, column = np.divmod(cell, self.width)
        return self.origin[0] + column * self.spacing, self.origin[1] + row * self.spacing

    def beside(self, cells):
        """These cells and the four around each."""
        height, width = self.shape
        rows, columns = np.divmod(np.asarray(cells), width)
        rows = np.add.outer(rows, (0, 1, -1, 0, 0)).ravel()
        columns = np.add.outer(columns, (0, 0, 0, 1, -1)).ravel()
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        return np.unique(rows[inside] * width + columns[inside]).astype(np.int32)

    def floor(self, passable=None):
        """What planners drive on; obstructed cells are to be told them as closed. Loaded robots
        keep out of parking as they do of storage."""
        return Floor(
            self.passable if passable is None else passable,
            storage=self.storage | self.parking,
            lane=self.lane,
            exits=self.exits,
        )

    def check(self, obstructed=True):
        """Raises FloorError with the places [m], if a fleet could come to a deadlock here: with
        what stands in its way now, or as the floor is without it."""
        free = self.passable & ~self.obstructed if obstructed else self.passable
        faults = check_layout(self.floor(free), *self.origin, self.spacing)
        if faults:
            raise FloorError("; ".join([*faults, *self._in_the_way(free)]))

    def _in_the_way(self, free):
        """In a sentence, where something stands on the marked floor."""
        cells = np.flatnonzero(self.passable & ~free)
        points = ", ".join(f"({x:g}, {y:g})" for x, y in zip(*self.point_of(cells[:10])))
        return [f"something stands at {points}"] if points else []

    @classmethod
    def of_world(cls, world):
        """Of a kiva_plugin_cpp.World. FloorError where markings contradict each other."""
        marks, belts = [], {}
        for name in world.names:
            if floor_markings.is_name(name):
                marks += floor_markings.read(world.visuals(name), world.pose(name), name)
            elif name.startswith(CONVEYOR):
                belts[name] = world.pose(name)[:2]
        return cls.of_parts(*world.occupancy(), marks, belts)

    @classmethod
    def of_messages(cls, grid, scenery):
        """Of a nav_msgs/OccupancyGrid (/warehouse/map) and a Scenery. Raises FloorError."""
        corner, spacing = grid.info.origin.position, grid.info.resolution
        poses = np.reshape(scenery.pose, (-1, 7))
        belts = {n: p[:2] for n, p in zip(scenery.models, poses) if n.startswith(CONVEYOR)}
        marks = floor_markings.of_scenery(scenery)
        x, y = corner.x + spacing / 2, corner.y + spacing / 2
        return cls.of_parts(x, y, spacing, occupancy_of(grid), marks, belts)

    @classmethod
    def of_parts(cls, x, y, spacing, occupancy, marks, belts):
        """From the map of a world, (h, w) uint8 with the cell (0, 0) at (x, y) [m], the marks on
        its floor and its belts, {name: (x, y)}. Raises FloorError."""
        blank = _blank(x, y, spacing, np.asarray(occupancy))
        if marks:
            return floor_markings.applied(blank, marks, belts)
        return lane_finder.find(blank, belts, np.asarray(occupancy) == BELT)

    @classmethod
    def laid_out(
        cls,
        *,
        origin,
        spacing,
        passable,
        storage,
        parking,
        exits,
        stations,
        obstructed=None,
        charging=None,
    ):
        """With `exits` made whole: nobody leaves the floor or a lane, nor enters one but at its
        entry; places where nobody can drive are neither storage nor parking. `charging`, (h, w)
        bool, is parking as well."""
        charging = np.zeros_like(passable) if charging is None else charging & passable
        return cls(
            origin=tuple(map(float, origin)),
            spacing=float(spacing),
            passable=passable,
            storage=storage & passable,
            parking=(parking | charging) & ~storage & passable,
            exits=with_lanes(exits, passable, stations),
            obstructed=np.zeros_like(passable) if obstructed is None else obstructed & passable,
            stations=tuple(stations),
            charging=np.flatnonzero(charging & ~storage),
        )


def occupancy_of(grid):
    """The cells of a nav_msgs/OccupancyGrid, (h, w) uint8, as World.occupancy() has them."""
    return np.array(grid.data, np.uint8).reshape(grid.info.height, grid.info.width)


def is_taken(occupancy):
    """(h, w) bool: cells of a world's map that are neither free nor beneath a storage unit."""
    return np.asarray(occupancy) >= BELT


def _blank(x, y, spacing, occupancy):
    """A floor without markings: storage is where units stand."""
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
