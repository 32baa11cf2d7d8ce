# SPDX-License-Identifier: Apache-2.0
"""Where a storage unit is put when a station is done with it."""

import numpy as np


class Random:
    def choose(self, unit, cells, distances, view):
        return cells[view.rng.integers(len(cells))]


class Nearest:
    def choose(self, unit, cells, distances, view):
        return cells[np.argmin(distances)]


class Fixed:
    """Each unit returns to where it stood at first, or as near to it as it can."""

    def choose(self, unit, cells, distances, view):
        return cells[np.argmin(view.cells_apart(view.first_cell(unit), cells))]


class TurnoverClasses:
    """Units are ranked by the demand for what they hold; each class has its band of places.

    classes: the share of the units in each, from the fastest on.
    """

    def __init__(self, classes=(0.1, 0.3, 0.6)):
        if abs(sum(classes) - 1) > 1e-6 or min(classes) <= 0:
            raise ValueError(
                f"classes are {classes}; shares above 0 that add up to 1 were expected"
            )
        self.bounds = np.cumsum(classes)

    def choose(self, unit, cells, distances, view):
        its = np.searchsorted(self.bounds, view.turnover_rank(unit))
        theirs = np.searchsorted(self.bounds, view.place_rank(cells))
        # Where its own band is full, the band that is nearest to it.
        return cells[np.lexsort((distances, np.abs(theirs - its)))[0]]


class Cache:
    """The places nearest to the stations are kept for units that orders wait for.

    share: of all storage places; work: pieces that orders want of a unit for it to get in.
    """

    def __init__(self, share=0.15, work=2):
        self.share, self.work = share, work

    def choose(self, unit, cells, distances, view):
        wanted = view.work(unit) >= self.work
        cached = view.place_rank(cells) < self.share
        return cells[np.lexsort((distances, cached != wanted))[0]]


NAMES = {
    "random": Random,
    "nearest": Nearest,
    "fixed": Fixed,
    "turnover classes": TurnoverClasses,
    "cache": Cache,
}
