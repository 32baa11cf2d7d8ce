# SPDX-License-Identifier: Apache-2.0
"""What each robot had better go for: hints to learn by, nobody is bound by them.

A robot without a load: the nearest requested unit that is nobody else's goal. One with a requested
unit: the nearest station. One with another unit: the nearest free storage place that is nobody
else's goal.
"""

import numpy as np

from warehouse_learning.grid import FAR


class Goals:
    """Of the robots of `warehouses`; kept until they are reached or no more to be had."""

    def __init__(self, warehouses):
        self._in = warehouses
        shape = (warehouses.n, warehouses.robots)
        self.cell = np.zeros(shape, np.int32)  # its own: none
        self.row = np.full(shape, warehouses.grid.nowhere, np.int32)  # of Grid.far
        self.aim = np.full(shape, -1, np.int32)  # unit, or cell of a storage place; -1 = none

    def begin(self, which):
        """Finds goals anew in those worlds."""
        self.aim[which] = -1
        self.row[which] = self._in.grid.nowhere
        self.cell[which] = self._in.cell[which]
        self._find([(w, r) for w in which for r in range(self._in.robots)])

    def end(self, w, robot):
        """A robot has lifted, delivered or put down."""
        self.aim[w, robot] = -1
        self.row[w, robot] = self._in.grid.nowhere

    def renew(self):
        """Finds goals for those whose own is gone."""
        see, grid = self._in, self._in.grid
        loaded = see.load >= 0
        aim = self.aim
        unit = np.where(aim < see.units, aim, 0)
        w = np.arange(see.n)[:, None]
        gone = ~loaded & (aim >= 0) & ((see.unit_cell[w, unit] < 0) | ~see.requested[w, unit])
        served = loaded & ~see.requested[w, np.maximum(see.load, 0)]
        gone |= served & (aim >= 0) & (see.unit_at[w, np.maximum(aim, 0)] >= 0)
        if gone.any():
            aim[gone], self.row[gone] = -1, grid.nowhere
        lacks = self.row == grid.nowhere
        if lacks.any():
            self.cell[lacks] = see.cell[lacks]
            self._find(np.argwhere(lacks))

    def distance(self):
        """(n, robots) cells to go; 0 where there is no goal or no way."""
        far = self._in.grid.far[self.row, self._in.cell]
        return np.where(far == FAR, 0, far)

    def _find(self, pairs):
        for w, robot in pairs:
            load = self._in.load[w, robot]
            if load < 0:
                self._find_unit(w, robot)
            elif self._in.requested[w, load]:
                self._choose(w, robot, self._in.grid.stations, self._in.grid.loaded_to, -1)
            else:
                self._find_place(w, robot)

    def _find_unit(self, w, robot):
        see = self._in
        wanted = see.requested[w] & (see.unit_cell[w] >= 0)
        others = self.aim[w, see.load[w] < 0]
        wanted[others[others >= 0]] = False
        units = np.flatnonzero(wanted)
        if len(units):
            self._choose(w, robot, see.unit_cell[w, units], see.grid.unloaded_to, units)

    def _find_place(self, w, robot):
        see = self._in
        places = see.grid.places[see.unit_at[w, see.grid.places] < 0]
        others = self.aim[w, see.load[w] >= 0]
        places = places[~np.isin(places, others)]
        if not len(places):
            return
        # Only the nearest as the crow flies are measured.
        row, column = np.divmod(places, see.grid.width)
        own = divmod(int(see.cell[w, robot]), see.grid.width)
        near = np.argsort(np.abs(row - own[0]) + np.abs(column - own[1]), kind="stable")[:6]
        self._choose(w, robot, places[near], see.grid.loaded_to, places[near])

    def _choose(self, w, robot, cells, row_to, aims):
        grid = self._in.grid
        rows = np.array([row_to(cell) for cell in cells])
        nearest = int(grid.far[rows, self._in.cell[w, robot]].argmin())
        self.cell[w, robot], self.row[w, robot] = cells[nearest], rows[nearest]
        self.aim[w, robot] = -1 if isinstance(aims, int) else aims[nearest]
