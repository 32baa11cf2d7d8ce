# SPDX-License-Identifier: Apache-2.0
"""The empty bins of a warehouse, by unit."""

from collections import defaultdict
from collections.abc import Collection, Iterator
from heapq import heappop, heappush
from typing import Generic, Protocol, TypeVar

import numpy as np


class OnUnit(Protocol):
    """A bin: its id, and that of its unit."""

    bin_id: int
    unit: int


Bin = TypeVar("Bin", bound=OnUnit)


class EmptyBins(Generic[Bin]):
    """Bins without anything, in the order in which they became so. Questions about units cost the
    same however many bins there are."""

    def __init__(self, bins: Collection[Bin]) -> None:
        """bins: all that there are, empty or not."""
        self._bins: dict[int, Bin] = {}  # by id
        self._units = np.unique(np.array([bin_.unit for bin_ in bins], np.int64))
        self._row = {unit: row for row, unit in enumerate(self._units.tolist())}
        self._counts = np.zeros(len(self._units), np.int32)
        self._room = np.full(len(self._units), np.inf)
        # Of each unit a heap of ids. Those of bins that are filled meanwhile leave it as they come
        # first.
        self._ids: dict[int, list[int]] = defaultdict(list)

    def __iter__(self) -> Iterator[Bin]:
        return iter(self._bins.values())

    def add(self, bin_: Bin) -> None:
        """Adds a bin, unless it is there."""
        if bin_.bin_id in self._bins:
            return
        self._bins[bin_.bin_id] = bin_
        self._counts[self._row[bin_.unit]] += 1
        heappush(self._ids[bin_.unit], bin_.bin_id)

    def discard(self, bin_: Bin) -> None:
        """Removes a bin, if it is there."""
        if self._bins.pop(bin_.bin_id, None):
            self._counts[self._row[bin_.unit]] -= 1

    def set_room(self, unit: int, weight: float) -> None:
        """Sets the weight that a unit takes."""
        self._room[self._row[unit]] = weight

    def units_with(self, weight: float) -> list[int]:
        """Returns the units with an empty bin that take more than a weight, or just as much,
        ascending."""
        chosen: list[int] = self._units[(self._counts > 0) & (self._room >= weight)].tolist()
        return chosen

    def first_on(self, unit: int) -> Bin:
        """Returns the bin of the lowest id on a unit that has one."""
        ids = self._ids[unit]
        while ids[0] not in self._bins:
            heappop(ids)
        return self._bins[ids[0]]

    def counts(self) -> Iterator[tuple[int, int]]:
        """Yields (unit, number of its empty bins) of the units with some."""
        some = self._counts > 0
        yield from zip(self._units[some].tolist(), self._counts[some].tolist())
