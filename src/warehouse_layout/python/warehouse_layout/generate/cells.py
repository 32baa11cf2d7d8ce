# SPDX-License-Identifier: Apache-2.0
"""The floor of a world cell by cell, as its map has it."""

from dataclasses import dataclass

import numpy as np

from warehouse_layout.file.request import RequestError
from warehouse_layout.floor.interfaces import OccupancyGrid
from warehouse_layout.place.layout import Floor


@dataclass(frozen=True)
class Cells:
    """`taken[i, j]` is whether an obstacle is at the grid point (x + i, y + j) [m]."""

    x: int
    y: int
    taken: np.ndarray

    @classmethod
    def of_map(cls, grid: OccupancyGrid) -> "Cells":
        """Reads a nav_msgs/OccupancyGrid with one cell a grid point. Raises RequestError.

        Belts (99) and storage units (50) are no obstacles here: they go with their warehouse.
        """
        if abs(grid.info.resolution - 1) > 1e-6:
            raise RequestError(
                f"the world's grid points are {grid.info.resolution:g} m apart;"
                " a warehouse is laid out on points 1 m apart"
            )
        corner = grid.info.origin.position
        rows = np.array(grid.data, np.int8).reshape(grid.info.height, grid.info.width)
        return cls(round(corner.x + 0.5), round(corner.y + 0.5), rows.T >= 100)

    @property
    def floor(self) -> Floor:
        """The rectangle that the cells cover."""
        x, y = self.x - 0.5, self.y - 0.5
        return Floor(x, x + self.taken.shape[0], y, y + self.taken.shape[1])

    def points(self) -> set[tuple[int, int]]:
        """Returns the grid points (x, y) [m] at which there are obstacles."""
        return {(int(i) + self.x, int(j) + self.y) for i, j in np.argwhere(self.taken)}
