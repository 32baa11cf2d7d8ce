# SPDX-License-Identifier: Apache-2.0
"""The floor as cells: who may go where.

A cell is a number, row * width + column, of a floor with a rim of `rim` cells that no robot can
enter: so every neighbourhood lies inside. Headings count quarter turns from +x towards +y.
"""

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import PICK
from warehouse_learning._core import Floor


class Grid:
    """The grid of a FloorPlan. rim: cells around it, and how far robots see."""

    def __init__(self, plan: FloorPlan, rim: int) -> None:
        self.spacing = plan.spacing
        self.height, self.width = (edge + 2 * rim for edge in plan.shape)
        self.rim, self.cells = rim, self.height * self.width
        self.origin = np.array(plan.origin) - rim * plan.spacing  # of cell 0, in world [m]
        self.passable = self._rimmed(plan.passable)
        self.storage = self._rimmed(plan.storage)
        lane = self._rimmed(plan.lane)
        self.street = self.passable & ~self.storage & ~self._rimmed(plan.parking) & ~lane
        row, column = np.divmod(
            [s.service_cell for s in plan.stations if s.kind == PICK], plan.width
        )
        self.stations = (row + rim) * self.width + column + rim
        self.steps = np.array([1, self.width, -1, -self.width])
        row, column = np.divmod(np.arange(self.cells), self.width)
        self._points = (
            self.origin[0] + column * self.spacing,
            self.origin[1] + row * self.spacing,
        )
        self.native = Floor(
            self.width,
            self.height,
            rim,
            tuple(self.origin),
            self.spacing,
            self.passable,
            self.storage,
            self.stations,
        )

    def _rimmed(self, mask: np.ndarray) -> np.ndarray:
        return np.pad(mask, self.rim).ravel()

    def locate(self, x: ArrayLike, y: ArrayLike, yaw: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Returns (cells, headings), int32 and int8, nearest to places in world [m, rad]."""
        cells, headings = self.native.locate(x, y, yaw)
        return cells, headings

    def cell_of(self, x: ArrayLike, y: ArrayLike) -> np.ndarray:
        """Returns the cells around places in world [m]."""
        return self.locate(x, y, np.zeros(np.shape(x)))[0]

    def point_of(self, cell: np.ndarray | int) -> tuple[np.ndarray, np.ndarray]:
        """Returns (x, y) of the centres of cells, in world [m]."""
        x, y = self._points
        return x[cell], y[cell]

    def share_of(self, cell: np.ndarray) -> np.ndarray:
        """Returns (…, 2): column and row of cells, each in 0…1 over the floor."""
        row, column = np.divmod(cell, self.width)
        last = np.array([self.width, self.height]) - 1 - 2 * self.rim
        at = np.stack([column, row], -1) - self.rim
        return at / np.maximum(last, 1)
