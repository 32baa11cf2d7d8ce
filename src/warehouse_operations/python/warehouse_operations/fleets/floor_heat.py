# SPDX-License-Identifier: Apache-2.0
"""Maps of robots' drives and waits on the floor, over the last hour."""

import zlib
from collections.abc import Iterable, Iterator

import numpy as np

from warehouse_layout.floor.floor_plan import FloorPlan

WINDOW, SLICES = 3600.0, 12  # counts older than the window are dropped a slice at a time [s]
TRAFFIC, WAITING = range(2)
GAP = 1.0  # longest time between two reports that counts for the place of the first [s]


class FloorHeat:
    """Counts on the cells of a FloorPlan."""

    def __init__(self, plan: FloorPlan, now: float) -> None:
        self._plan, self._began = plan, now
        self._slices = np.zeros((SLICES, 2, plan.passable.size), np.float32)
        self._slice = self._slice_of(now)
        self._cells, self._time = None, now

    def update(self, now: float, x: np.ndarray, y: np.ndarray, waits: np.ndarray) -> None:
        """Counts the cells of all robots, by their positions [m] and whether they wait (bool), at a
        time [s]."""
        self._turn(now)
        counts = self._slices[self._slice % SLICES]
        cells = self._plan.cell_of(x, y)
        inside = cells >= 0
        np.add.at(counts[WAITING], cells[inside & waits], np.clip(now - self._time, 0, GAP))
        if self._cells is not None and len(self._cells) == len(cells):
            np.add.at(counts[TRAFFIC], cells[inside & (cells != self._cells)], 1)
        self._cells, self._time = cells, now

    def kept(self, slices: int = 1) -> Iterator[tuple[int, float, bytes]]:
        """The last slices for restore(), each (slot, its beginning [s], bytes). A later slice
        replaces the one in its slot."""
        for number in range(self._slice + 1 - slices, self._slice + 1):
            slot = number % SLICES
            packed = zlib.compress(self._slices[slot].tobytes(), level=1)
            yield slot, max(number * (WINDOW / SLICES), self._began), packed

    def restore(self, kept: Iterable[tuple[float, bytes]]) -> None:
        """Restores slices of this floor from pairs (begin [s], bytes); ignores those of another
        one."""
        for began, packed in kept:
            counts = np.frombuffer(zlib.decompress(packed), np.float32)
            number = self._slice_of(began)
            if counts.size != self._slices[0].size or not 0 <= self._slice - number < SLICES:
                continue
            self._slices[number % SLICES] += counts.reshape(self._slices[0].shape)
            self._began = min(self._began, began)

    def seconds(self, now: float) -> float:
        """Returns the duration that the maps cover [s]."""
        oldest = (self._slice_of(now) + 1 - SLICES) * (WINDOW / SLICES)
        return now - max(self._began, oldest)

    def maps(self) -> np.ndarray:
        """Returns (traffic, waiting), each an array by cell: robots that came in; robot-seconds."""
        return self._slices.sum(axis=0)

    def _turn(self, now: float) -> None:
        """Empties the slices whose time begins again."""
        current = self._slice_of(now)
        for number in range(self._slice + 1, min(current, self._slice + SLICES) + 1):
            self._slices[number % SLICES] = 0
        self._slice = current

    @staticmethod
    def _slice_of(now: float) -> int:
        return int(now // (WINDOW / SLICES))
