# SPDX-License-Identifier: Apache-2.0
"""The floor as cells: who may go where, and how far it is to what one may want.

A cell is a number, row * width + column, of a floor with a rim of `rim` cells that nobody can
enter: so every neighbourhood lies inside. Headings count quarter turns from +x towards +y.
"""

import numpy as np

from kiva_plugin_cpp._core import Cells
from warehouse_fleet.stations import PICK

BLOCKED, STORAGE, STATION = 1, 2, 4  # bits of a cell, numbered as fields.LAYERS
FAR = np.iinfo(np.int16).max  # no way leads there
UNLOADED, LOADED = range(2)


class Grid:
    """Of a warehouse_fleet FloorPlan. rim: cells around it, and how far robots see."""

    def __init__(self, plan, rim):
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
        self.is_station = np.zeros(self.cells, bool)
        self.is_station[self.stations] = True
        self.steps = np.array([1, self.width, -1, -self.width])
        self.places = np.flatnonzero(self.storage)
        self.longest = max(plan.shape)
        look = BLOCKED * ~self.passable | STORAGE * self.storage | STATION * self.is_station
        self.native = Cells(
            self.width, self.height, rim, rim, tuple(self.origin), self.spacing, look
        )
        self._far = np.full((16, self.cells), FAR, np.int16)
        self._far[0] = 0  # a goal that is none: nothing is nearer
        self._rows, self.nowhere = 1, 0
        self._row_of = {deck: np.full(self.cells, -1, np.int32) for deck in (UNLOADED, LOADED)}

    def _rimmed(self, mask):
        return np.pad(mask, self.rim).ravel()

    def locate(self, x, y, yaw):
        """(cells, headings) nearest to places in world [m, rad]: int32 and int8, of their shape."""
        return self.native.locate(x, y, yaw)

    def cell_of(self, x, y):
        """The cells around places in world [m]."""
        return self.locate(x, y, np.zeros(np.shape(x)))[0]

    def point_of(self, cell):
        """(x, y) of the centres of cells, in world [m]."""
        row, column = np.divmod(cell, self.width)
        return self.origin[0] + column * self.spacing, self.origin[1] + row * self.spacing

    def share_of(self, cell):
        """(…, 2): column and row of cells, each in 0…1 over the floor."""
        row, column = np.divmod(cell, self.width)
        last = np.array([self.width, self.height]) - 1 - 2 * self.rim
        at = np.stack([column, row], -1) - self.rim
        return at / np.maximum(last, 1)

    @property
    def far(self):
        """(rows, cells) int16: ways to goals in cells; a row by unloaded_to, loaded_to."""
        return self._far

    def unloaded_to(self, cells):
        """The rows of `far` for a robot without a load that goes there, (k,)."""
        return self._rows_to(UNLOADED, cells)

    def loaded_to(self, cells):
        """The rows of `far` for a robot with a load, which keeps out of storage but its goal."""
        return self._rows_to(LOADED, cells)

    def _rows_to(self, deck, cells):
        row_of = self._row_of[deck]
        rows = row_of[cells]
        if rows.min() < 0:  # measured when they are asked for at first
            free = self.passable & ~self.storage if deck == LOADED else self.passable
            for cell in np.unique(np.asarray(cells)[rows < 0]):
                row_of[cell] = self._add(self._measure(cell, free))
            rows = row_of[cells]
        return rows

    def _add(self, far):
        if self._rows == len(self._far):
            self._far = np.concatenate([self._far, np.full_like(self._far, FAR)])
        self._far[self._rows] = far
        self._rows += 1
        return self._rows - 1

    def _measure(self, goal, free):
        """(cells,) int16, wave by wave from the goal. One may begin in any passable cell."""
        far = np.full(self.cells, FAR, np.int16)
        far[goal] = distance = 0
        wave = np.array([goal])
        while len(wave):
            distance += 1
            wave = np.unique(wave[:, None] + self.steps)
            wave = wave[self.passable[wave] & (far[wave] == FAR)]
            far[wave] = distance
            wave = wave[free[wave]]  # others are not passed through
        return far
