# SPDX-License-Identifier: Apache-2.0
"""The floor of an ideal fleet: where units stand, which places are free, lanes of stations."""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_layout.floor_plan import FloorPlan
from warehouse_operations.travel import Travel

if TYPE_CHECKING:
    from warehouse_operations.ideal_trips import Transport


@dataclass(eq=False)
class Lane:
    """A station's service cell and the transports before it."""

    station: Any  # a stations.Station of the FloorPlan
    is_open: bool = True
    inbound: int = 0  # units in the lane or on their way to it
    queue: deque["Transport"] = field(default_factory=deque)
    serving: "Transport | None" = None  # in the service cell, or on the last metre to it
    free_from: float = 0.0  # when the service cell has been left [s]
    waited: float = 0.0  # by all transports [s]

    @property
    def name(self) -> str:
        """The station's name."""
        return self.station.name

    @property
    def cell(self) -> int:
        """The service cell."""
        return int(self.station.cells[self.station.service])


class UnreachableError(ValueError):
    """A unit can't be brought to a target; the text says why."""


class IdealFloor:
    """Cells of a FloorPlan and what stands in them.

    units: the cell of each unit that is not carried, by id. busy: ids of units on transports.
    free: whether each cell is a free storage place, (cells,). lanes: by station name.
    """

    def __init__(self, plan: FloorPlan, units: Mapping[int, int], travel: Travel) -> None:
        self.plan, self.travel = plan, travel
        self.units = {number: int(cell) for number, cell in sorted(units.items())}
        self.busy: set[int] = set()
        self.lanes = {one.name: Lane(one) for one in plan.stations}
        self.free = np.asarray(plan.storage, bool).ravel().copy()
        for shelf_id, cell in self.units.items():
            if not self.free[cell]:
                raise ValueError(
                    f"storage unit {shelf_id} stands in cell {cell}: no storage place, or not free"
                )
            self.free[cell] = False

    def clear(self, cell: int) -> None:
        """Makes a cell free again, if it is a storage place."""
        self.free[cell] = self.plan.storage.flat[cell]

    def target(
        self, shelf_id: int, station: str, x: float | None, y: float | None
    ) -> tuple[Lane | None, int]:
        """Returns (lane or None, cell) to which a unit is to be brought; x, y in world [m].

        Raises UnreachableError.
        """
        if shelf_id in self.busy:
            raise UnreachableError(f"storage unit {shelf_id} is on a transport")
        if shelf_id not in self.units:
            raise UnreachableError(f"there is no storage unit {shelf_id}")
        if station:
            lane = self._open_lane(station)
            self._check_way(shelf_id, lane.cell, station)
            return lane, lane.cell
        if x is None or y is None:
            raise UnreachableError("a station, or x and y, was expected")
        cell = int(self.plan.cell_of(x, y))
        if not 0 <= cell < self.plan.passable.size or not self.plan.passable.flat[cell]:
            raise UnreachableError(f"({x}, {y}) is not a cell to drive to")
        if self.plan.storage.flat[cell] and not self.free[cell]:
            raise UnreachableError(f"the storage place at ({x}, {y}) is taken")
        self._check_way(shelf_id, cell, f"({x}, {y})")
        return None, cell

    def _open_lane(self, station: str) -> Lane:
        lane = self.lanes.get(station)
        if not lane:
            raise UnreachableError(f"there is no station '{station}'")
        if not lane.is_open:
            raise UnreachableError(f"station {station} is closed")
        return lane

    def _check_way(self, shelf_id: int, cell: int, name: str) -> None:
        if not np.isfinite(self.travel.loaded_to(cell).seconds[self.units[shelf_id]]):
            raise UnreachableError(f"no way leads from the unit to {name}")
