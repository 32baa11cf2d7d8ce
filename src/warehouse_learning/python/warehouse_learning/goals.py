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
        self._news = np.ones(warehouses.n, bool)  # there may be other goals than before

    def begin(self, which):
        """Finds goals anew in those worlds."""
        self.aim[which] = -1
        self.row[which] = self._in.grid.nowhere
        self._news[which] = True
        self._find()

    def end(self, w, robot):
        """A robot has lifted, delivered or put down."""
        self.aim[w, robot] = -1
        self.row[w, robot] = self._in.grid.nowhere
        self._news[w] = True

    def changed(self, w):
        """Units of that world stand elsewhere."""
        self._news[w] = True

    def renew(self):
        """Finds goals for those whose own is gone, which it can be only where there are news."""
        see, grid = self._in, self._in.grid
        which = self._news.nonzero()[0]
        if len(which):
            w = which[:, None]
            aim, load = self.aim[which], see.load[which]
            unit = np.where(aim < see.units, aim, 0)
            gone = (load < 0) & (aim >= 0)
            gone &= (see.unit_cell[w, unit] < 0) | ~see.requested[w, unit]
            served = (load >= 0) & ~see.requested[w, np.maximum(load, 0)]
            gone |= served & (aim >= 0) & (see.unit_at[w, np.maximum(aim, 0)] >= 0)
            self.aim[which] = np.where(gone, -1, aim)
            self.row[which] = np.where(gone, grid.nowhere, self.row[which])
        self._find()

    def distance(self):
        """(n, robots) cells to go; 0 where there is no goal or no way."""
        far = self._in.grid.far[self.row, self._in.cell]
        return np.where(far == FAR, 0, far)

    def _find(self):
        see = self._in
        lacks = self.row == see.grid.nowhere
        np.copyto(self.cell, see.cell, where=lacks)
        for w, robot in np.argwhere(lacks & self._news[:, None]).tolist():
            load = int(see.load[w, robot])
            if load < 0:
                self._find_unit(w, robot)
            elif see.requested[w, load]:
                self._choose(w, robot, see.grid.stations, see.grid.loaded_to, None)
            else:
                self._find_place(w, robot)
        self._news[:] = False

    def _find_unit(self, w, robot):
        see = self._in
        wanted = see.requested[w] & (see.unit_cell[w] >= 0)
        others = self.aim[w, see.load[w] < 0]
        wanted[others[others >= 0]] = False
        units = wanted.nonzero()[0]
        if len(units):
            self._choose(w, robot, see.unit_cell[w, units], see.grid.unloaded_to, units)

    def _find_place(self, w, robot):
        see = self._in
        free = see.grid.storage & (see.unit_at[w] < 0)
        others = self.aim[w, see.load[w] >= 0]
        free[others[others >= 0]] = False
        places = free.nonzero()[0]
        if len(places):
            self._choose(w, robot, places, see.grid.loaded_to, places)

    def _choose(self, w, robot, cells, rows_to, aims):
        rows = rows_to(cells)
        nearest = self._in.grid.far[rows, self._in.cell[w, robot]].argmin()
        self.cell[w, robot], self.row[w, robot] = cells[nearest], rows[nearest]
        self.aim[w, robot] = -1 if aims is None else aims[nearest]
