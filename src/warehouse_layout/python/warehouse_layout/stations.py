# SPDX-License-Identifier: Apache-2.0
"""Stations and their lanes: one-way, entered at their first cell and left at their last."""

from dataclasses import dataclass

import numpy as np

from warehouse_layout._core import FloorError

PICK, REPLENISH = "PICK", "REPLENISH"
STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))  # along x and y, by heading


@dataclass(frozen=True, eq=False)
class Station:
    """Where units are served. Its lane leads from the entry over the service cell to the exit."""

    name: str
    kind: str  # PICK or REPLENISH
    cells: np.ndarray  # (n,) int32, y * width + x, in driving order
    service: int  # index into cells
    belt: str = ""  # the conveyor belt there, if any

    @property
    def service_cell(self):
        return int(self.cells[self.service])

    @property
    def queue(self):
        """Cells where units wait, the entry first; the service cell is not among them."""
        return self.cells[: self.service]


def lane_mask(stations, shape):
    """(h, w) bool: the cells of their lanes."""
    out = np.zeros(shape, bool)
    for station in stations:
        out.flat[station.cells] = True
    return out


def neighbour(values, heading):
    """(h, w): what each cell's neighbour in that heading has; False or 0 beyond the edge."""
    (dx, dy), (height, width) = STEPS[heading], values.shape
    out = np.zeros_like(values)
    out[max(-dy, 0) : height - max(dy, 0), max(-dx, 0) : width - max(dx, 0)] = values[
        max(dy, 0) : height - max(-dy, 0), max(dx, 0) : width - max(-dx, 0)
    ]
    return out


def with_lanes(exits, passable, stations):
    """`exits` (h, w) uint8 of a floor with these lanes: none leads off what is passable or into a
    lane but at its entry; in a lane they lead ahead, and from its last cell out of it."""
    lane = lane_mask(stations, passable.shape)
    entry = lane_mask([], passable.shape)
    entry.flat[[int(station.cells[0]) for station in stations]] = True
    out = np.where(passable, exits, 0).astype(np.uint8)
    for heading in range(4):
        # A lane's exit does not lead into the next one.
        shut = neighbour(lane, heading) & (lane | ~neighbour(entry, heading))
        out[shut | ~neighbour(passable, heading)] &= ~np.uint8(1 << heading)
    steps = (1, passable.shape[1], -1, -passable.shape[1])
    for station in stations:
        cells = station.cells.tolist()
        for cell, after in zip(cells, cells[1:]):
            out.flat[cell] = 1 << steps.index(after - cell)
    return out


def check_lane(name, cells, passable):
    """Raises FloorError unless `cells` are neighbours in a row, passable, each but once."""
    width = passable.shape[1]
    y, x = np.divmod(cells, width)
    far = np.abs(np.diff(x)) + np.abs(np.diff(y))
    if (far != 1).any() or len(set(cells.tolist())) < len(cells):
        raise FloorError(f"the lane of {name}: cells in a row, each but once, were expected")
    if not passable.flat[cells].all():
        taken = [(int(i), int(j)) for i, j in zip(x, y) if not passable[j, i]]
        raise FloorError(f"the lane of {name} is obstructed at cells {taken}")
