# SPDX-License-Identifier: Apache-2.0
"""The floor of an ideal fleet: where units stand, which places are free, lanes of stations."""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from warehouse_fleet.transports.transport_book import Transport
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_operations.stock.travel import Travel


@dataclass(eq=False)
class Lane:
    """A station's service cell and the transports before it."""

    station: Any  # a stations.Station of the FloorPlan
    queue: deque[Transport] = field(default_factory=deque)
    serving: Transport | None = None  # in the service cell, or on the last metre to it
    free_from: float = 0.0  # when the service cell is free again [s]
    waited: float = 0.0  # by all transports [s]


class IdealFloor:
    """Cells of a FloorPlan and what stands in them.

    units: the cell of each unit that is not carried, by id. free: whether each cell is a free
    storage place, (cells,). lanes: by station name.
    """

    def __init__(self, plan: FloorPlan, units: Mapping[int, int], travel: Travel) -> None:
        self.plan, self.travel = plan, travel
        self.units = {number: int(cell) for number, cell in sorted(units.items())}
        self.lanes = {station.name: Lane(station) for station in plan.stations}
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
