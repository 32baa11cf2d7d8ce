# SPDX-License-Identifier: Apache-2.0
"""Distances between cells along the axes, and from tier to tier."""

from collections.abc import Sequence

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE

CHANGE = 100_000  # from one tier to another, farther than any way on one [cells]


class Distances:
    """The distances between the cells of a floor `width` cells wide. `tier`, (cells,): the tier of
    each cell; None: there is one."""

    def __init__(self, width: int, tier: np.ndarray | None = None) -> None:
        self._width, self._tier = width, tier

    def __call__(self, cell: int, cells: np.ndarray) -> np.ndarray:
        """Returns the distance from a cell to each of `cells`, (n,) [cells]."""
        (y, x), (ys, xs) = divmod(cell, self._width), np.divmod(cells, self._width)
        far = np.abs(xs - x) + np.abs(ys - y)
        if self._tier is not None:
            far = far + CHANGE * (self._tier[cells] != self._tier[cell])
        return far

    def nearest(self, cell: int, cells: Sequence[int]) -> int:
        """Returns the cell of `cells` that is nearest to a cell; NOWHERE if there are none."""
        if not len(cells):
            return NOWHERE
        return int(cells[self(cell, np.asarray(cells)).argmin()])
