# SPDX-License-Identifier: Apache-2.0
"""The graph that ways of loaded robots are searched on."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from warehouse_layout.floor.floor_plan import FloorPlan


def lanes_of(plan: FloorPlan) -> np.ndarray:
    """Returns the index of the station to whose lane each cell belongs, (cells,) int32; or -1."""
    out = np.full(plan.passable.size, -1, np.int32)
    for index, station in enumerate(plan.stations):
        out[station.cells] = index
    return out


class WayGraph:
    """Steps by cell and heading, (cells, 4) int32, of ways that pass no lane: in the direction of
    the search, a lane is left only where the search began in it. Short cuts would make lanes of
    other stations worth it."""

    def __init__(self, steps: np.ndarray, lane_of: np.ndarray) -> None:
        """lane_of: (cells,) int, the lane of each cell; or -1."""
        self._steps = steps.copy()
        cells, headings = np.nonzero(steps >= 0)
        to = steps[cells, headings]
        leaves = (lane_of[cells] >= 0) & (lane_of[cells] != lane_of[to])
        cells, headings, to = cells[leaves], headings[leaves], to[leaves]
        self._steps[cells, headings] = -1
        self._closed = {
            int(lane): (cells[chosen], headings[chosen], to[chosen])
            for lane in np.unique(lane_of[cells])
            for chosen in [lane_of[cells] == lane]
        }

    @contextmanager
    def open(self, lane: int) -> Iterator[np.ndarray]:
        """Yields the steps of a search that begins in a lane; -1: in none."""
        cells, headings, to = self._closed.get(int(lane), ([], [], -1))
        self._steps[cells, headings] = to
        try:
            yield self._steps
        finally:
            self._steps[cells, headings] = -1
