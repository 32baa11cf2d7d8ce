# SPDX-License-Identifier: Apache-2.0
"""Policies that choose the place in which a storage unit is stored."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View


class Random:
    """Chooses any cell."""

    def choose(self, unit: int, cells: np.ndarray, distances: np.ndarray, view: "View") -> int:
        """Returns the cell, one of cells (n,), in which a unit is stored; distances [m], (n,)."""
        return cells[view.rng.integers(len(cells))]


class Nearest:
    """Chooses the cell with the shortest way."""

    def choose(self, unit: int, cells: np.ndarray, distances: np.ndarray, view: "View") -> int:
        """Returns the cell, one of cells (n,), in which a unit is stored; distances [m], (n,)."""
        return cells[np.argmin(distances)]


class Fixed:
    """Returns each unit to where it stood at first, or as near to it as possible."""

    def choose(self, unit: int, cells: np.ndarray, distances: np.ndarray, view: "View") -> int:
        """Returns the cell, one of cells (n,), in which a unit is stored; distances [m], (n,)."""
        return cells[np.argmin(view.cells_apart(view.first_cell(unit), cells))]


class TurnoverClasses:
    """Ranks units by the demand for what they hold, and stores each class in a band of places.

    classes: the share of the units in each, from the fastest on. Raises ValueError unless they are
    above 0 and add up to 1.
    """

    def __init__(self, classes: Sequence[float] = (0.1, 0.3, 0.6)) -> None:
        if abs(sum(classes) - 1) > 1e-6 or min(classes) <= 0:
            raise ValueError(
                f"classes are {classes}; shares above 0 that add up to 1 were expected"
            )
        self.bounds = np.cumsum(classes)

    def choose(self, unit: int, cells: np.ndarray, distances: np.ndarray, view: "View") -> int:
        """Returns the cell, one of cells (n,), in which a unit is stored; distances [m], (n,)."""
        its = np.searchsorted(self.bounds, view.turnover_rank(unit))
        theirs = np.searchsorted(self.bounds, view.place_rank(cells))
        # The nearest band, if its own is full.
        return cells[np.lexsort((distances, np.abs(theirs - its)))[0]]


class Cache:
    """Keeps the places nearest to the stations for units that orders wait for.

    share: of all storage places. work: fewest pieces that orders want of a unit there.
    """

    def __init__(self, share: float = 0.15, work: int = 2) -> None:
        self.share, self.work = share, work

    def choose(self, unit: int, cells: np.ndarray, distances: np.ndarray, view: "View") -> int:
        """Returns the cell, one of cells (n,), in which a unit is stored; distances [m], (n,)."""
        is_busy = view.work(unit) >= self.work
        cached = view.place_rank(cells) < self.share
        return cells[np.lexsort((distances, cached != is_busy))[0]]


NAMES: dict[str, type] = {
    "random": Random,
    "nearest": Nearest,
    "fixed": Fixed,
    "turnover classes": TurnoverClasses,
    "cache": Cache,
}
