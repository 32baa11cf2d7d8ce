# SPDX-License-Identifier: Apache-2.0
"""The floor that a fleet drives on: streets, storage places, stations with lanes, cell by cell.

A FloorPlan is read from a world, never kept beside it: plan_reader.

    plan = plan_reader.of_world(World.preset("huge"))
    planner = epibt(plan.floor(), Rules(following=False))
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout._core import Floor, FloorError, check_layout
from warehouse_layout.floor.elevators import Elevator, tiers
from warehouse_layout.floor.lane_ways import with_ways
from warehouse_layout.floor.stations import PICK, REPLENISH, Station, lane_mask, with_lanes

__all__ = ["PICK", "REPLENISH", "FloorError", "FloorPlan", "Station"]

ALL_EXITS = 0b1111


@dataclass(frozen=True, eq=False)
class FloorPlan:
    """The floor of a warehouse. Arrays have a row for each y, cell (0, 0) has the lowest x and y.

    A cell is also a number, y * width + x. Headings count quarter turns from +x towards +y.
    """

    origin: tuple[float, float]  # x, y of the centre of cell (0, 0), in world [m]
    spacing: float  # edge of a cell [m]
    passable: np.ndarray  # (h, w) bool: where a robot without a load may drive
    storage: np.ndarray  # (h, w) bool: storage places
    parking: np.ndarray  # (h, w) bool: where idle robots stand; loaded ones keep out
    exits: np.ndarray  # (h, w) uint8, bit h: may be left towards heading h
    obstructed: np.ndarray  # (h, w) bool: passable, but obstructed now
    stations: tuple[Station, ...] = ()
    without_lane: tuple[str, ...] = ()  # texts: which belts have no station, and why
    charging: Sequence[int] | np.ndarray = ()  # cells in which robots are charged, ascending
    elevators: tuple[Elevator, ...] = ()  # between tiers, which lie side by side

    @property
    def shape(self) -> tuple[int, int]:
        """Cells along y and x."""
        height, width = self.passable.shape
        return height, width

    @property
    def width(self) -> int:
        """Cells along x."""
        return self.passable.shape[1]

    @cached_property
    def lane(self) -> np.ndarray:
        """(h, w) bool: cells of stations' lanes, and of the streets that lead only into them or out
        of them."""
        lane = lane_mask(self.stations, self.shape)
        return with_ways(lane, self.passable, self.storage | self.parking, self.exits)

    @cached_property
    def tier(self) -> np.ndarray:
        """(h, w) int: the number of each cell's tier, from 0; -1 where no robot drives."""
        return tiers(self.passable, self.elevators)

    def station(self, name: str) -> Station:
        """Returns the Station of that name. Raises KeyError if there is none."""
        return {s.name: s for s in self.stations}[name]

    def cell_of(self, x: ArrayLike, y: ArrayLike) -> Any:
        """Returns the cell that holds the point x, y in `world` [m]; -1 off the floor.

        Numbers give an int, arrays an int32 array of the same shape.
        """
        column = np.floor((np.asarray(x) - self.origin[0]) / self.spacing + 0.5).astype(np.int32)
        row = np.floor((np.asarray(y) - self.origin[1]) / self.spacing + 0.5).astype(np.int32)
        height, width = self.shape
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        cell = np.where(inside, row * width + column, -1).astype(np.int32)
        return cell if cell.ndim else int(cell)

    def point_of(self, cell: Any) -> tuple[Any, Any]:
        """Returns x and y of the centres of cells in `world` [m]; numbers, or arrays of a shape."""
        row, column = np.divmod(cell, self.width)
        return self.origin[0] + column * self.spacing, self.origin[1] + row * self.spacing

    def beside(self, cells: ArrayLike) -> np.ndarray:
        """Returns these cells and the four around each, ascending, (n,) int32."""
        height, width = self.shape
        rows, columns = np.divmod(np.asarray(cells), width)
        rows = np.add.outer(rows, (0, 1, -1, 0, 0)).ravel()
        columns = np.add.outer(columns, (0, 0, 0, 1, -1)).ravel()
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        return np.unique(rows[inside] * width + columns[inside]).astype(np.int32)

    def floor(self, passable: np.ndarray | None = None, lane: np.ndarray | None = None) -> Floor:
        """Returns the Floor for planners; obstructed cells must be given to them as closed.

        Loaded robots keep out of parking as they do of storage. `passable` and `lane`, (h, w) bool,
        replace those of the plan.
        """
        return Floor(
            self.passable if passable is None else passable,
            storage=self.storage,
            parking=self.parking,
            lane=self.lane if lane is None else lane,
            exits=self.exits,
        )

    def check(self, obstructed: bool = True) -> None:
        """Raises FloorError with the places [m] where a fleet could come to a deadlock.

        Checks the floor with the present obstacles, or without them if `obstructed` is False.
        """
        free = self.passable & ~self.obstructed if obstructed else self.passable
        for floor in self.floors(free):
            if faults := check_layout(floor, *self.origin, self.spacing):
                raise FloorError("; ".join([*faults, *self._in_the_way(free)]))

    def floors(self, passable: np.ndarray | None = None) -> Iterator[Floor]:
        """Yields the Floor of each tier: a fleet must be able to work on each by itself, as robots
        that ride come back with others. `passable` (h, w) bool replaces that of the plan."""
        passable = self.passable if passable is None else passable
        for tier in range(self.tier.max(initial=0) + 1):
            yield self.floor(passable & (self.tier == tier) if self.elevators else passable)

    def _in_the_way(self, free: np.ndarray) -> list[str]:
        """Returns a sentence about the obstacles on the marked floor, if there are any."""
        cells = np.flatnonzero(self.passable & ~free)
        points = ", ".join(f"({x:g}, {y:g})" for x, y in zip(*self.point_of(cells[:10])))
        return [f"something stands at {points}"] if points else []

    @classmethod
    def laid_out(
        cls,
        *,
        origin: Iterable[float],
        spacing: float,
        passable: np.ndarray,
        storage: np.ndarray,
        parking: np.ndarray,
        exits: np.ndarray,
        stations: Iterable[Station],
        obstructed: np.ndarray | None = None,
        charging: np.ndarray | None = None,
        elevators: Iterable[Elevator] = (),
    ) -> "FloorPlan":
        """Makes a FloorPlan whose arrays agree with each other.

        `exits` are restricted so that none leaves the floor or a lane, or enters a lane except at
        its entry. Impassable cells are neither storage nor parking. `charging`, (h, w) bool, is
        parking as well.
        """
        stations = tuple(stations)
        x, y = map(float, origin)
        charging = np.zeros_like(passable) if charging is None else charging & passable
        return cls(
            origin=(x, y),
            spacing=float(spacing),
            passable=passable,
            storage=storage & passable,
            parking=(parking | charging) & ~storage & passable,
            exits=with_lanes(exits, passable, stations),
            obstructed=np.zeros_like(passable) if obstructed is None else obstructed & passable,
            stations=stations,
            charging=np.flatnonzero(charging & ~storage),
            elevators=tuple(elevators),
        )
