# SPDX-License-Identifier: Apache-2.0
"""Distances between cells along the axes."""

from collections.abc import Sequence

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE


class Distances:
    """The distances between the cells of a floor `width` cells wide."""

    def __init__(self, width: int) -> None:
        self._width = width

    def __call__(self, cell: int, cells: np.ndarray) -> np.ndarray:
        """Returns the distance from a cell to each of `cells`, (n,) [cells]."""
        (y, x), (ys, xs) = divmod(cell, self._width), np.divmod(cells, self._width)
        return np.abs(xs - x) + np.abs(ys - y)

    def nearest(self, cell: int, cells: Sequence[int]) -> int:
        """Returns the cell of `cells` that is nearest to a cell; NOWHERE if there are none."""
        if not len(cells):
            return NOWHERE
        return int(cells[self(cell, np.asarray(cells)).argmin()])
