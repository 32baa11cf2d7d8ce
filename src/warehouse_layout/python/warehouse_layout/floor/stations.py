# SPDX-License-Identifier: Apache-2.0
"""Stations and their lanes: one-way, entered at their first cell and left at their last. Short cuts
lead farther ahead: from a street into a queue, or from one of its cells to a later one."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from warehouse_layout._core import FloorError

PICK, REPLENISH = "PICK", "REPLENISH"
QUEUE, SERVICE, EXIT = "queue", "service", "exit"  # the parts of a lane
STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))  # along x and y, by heading


def cell_steps(width: int) -> tuple[int, ...]:
    """Returns what leads from the number of a cell to that of its neighbour, by heading, on a floor
    of `width` cells a row."""
    return tuple(dx + dy * width for dx, dy in STEPS)


@dataclass(frozen=True, eq=False)
class Station:
    """A place where units are served, on a lane from entry over service cell to exit."""

    name: str
    kind: str  # PICK or REPLENISH
    cells: np.ndarray  # (n,) int32, y * width + x, in driving order
    service: int  # index into cells
    belt: str = ""  # the conveyor belt there, if any
    # Further steps on the way to the service cell: (from, to), cells beside each other.
    short_cuts: tuple[tuple[int, int], ...] = ()

    @property
    def service_cell(self) -> int:
        """The cell on which a unit is served, y * width + x."""
        return int(self.cells[self.service])

    @property
    def queue(self) -> np.ndarray:
        """Cells in which units wait, (n,) int32, the entry first; without the service cell."""
        return self.cells[: self.service]

    @property
    def parts(self) -> dict[str, np.ndarray]:
        """The cells of each part of the lane."""
        cells = np.split(self.cells, [self.service, self.service + 1])
        return dict(zip((QUEUE, SERVICE, EXIT), cells))


def lane_mask(stations: Iterable[Station], shape: tuple[int, ...]) -> np.ndarray:
    """Returns the cells of the stations' lanes, (h, w) bool."""
    out = np.zeros(shape, bool)
    for station in stations:
        out.flat[station.cells] = True
    return out


def neighbour(values: np.ndarray, heading: int) -> np.ndarray:
    """Returns for each cell the value of its neighbour in that heading, (h, w).

    The value is False or 0 where the neighbour would be beyond the edge.
    """
    (dx, dy), (height, width) = STEPS[heading], values.shape
    out = np.zeros_like(values)
    out[max(-dy, 0) : height - max(dy, 0), max(-dx, 0) : width - max(dx, 0)] = values[
        max(dy, 0) : height - max(-dy, 0), max(dx, 0) : width - max(-dx, 0)
    ]
    return out


def with_lanes(exits: np.ndarray, passable: np.ndarray, stations: Iterable[Station]) -> np.ndarray:
    """Returns `exits`, (h, w) uint8, restricted by what is passable and by the stations' lanes.

    No exit leads to an impassable cell, or into a lane except at its entry. Within a lane the only
    exit leads ahead, and from its last cell out of it. Short cuts are exits as well.
    """
    stations = list(stations)
    lane = lane_mask(stations, passable.shape)
    entry = lane_mask([], passable.shape)
    entry.flat[[int(station.cells[0]) for station in stations]] = True
    out = np.where(passable, exits, 0).astype(np.uint8)
    for heading in range(4):
        # A lane's exit does not lead into the next one.
        shut = neighbour(lane, heading) & (lane | ~neighbour(entry, heading))
        out[shut | ~neighbour(passable, heading)] &= ~np.uint8(1 << heading)
    steps = cell_steps(passable.shape[1])
    for station in stations:
        cells = station.cells.tolist()
        for cell, after in zip(cells, cells[1:]):
            out.flat[cell] = 1 << steps.index(after - cell)
        for cell, after in station.short_cuts:
            out.flat[cell] |= 1 << steps.index(after - cell)
    return out


def short_cuts(
    exits: np.ndarray, streets: np.ndarray, cells: np.ndarray, service: int
) -> tuple[tuple[int, int], ...]:
    """Returns the short cuts of a lane, of those `exits`, (h, w) uint8, that lead into it.

    streets: (h, w) bool, cells from which a lane may be entered. cells, service: as a Station has.
    """
    steps = cell_steps(exits.shape[1])
    place = {int(cell): index for index, cell in enumerate(cells[: service + 1])}
    out = []
    for cell, index in place.items():
        for heading, step in enumerate(steps):
            before = cell - step
            if not 0 <= before < exits.size or not exits.flat[before] >> heading & 1:
                continue
            is_ahead = place[before] < index - 1 if before in place else streets.flat[before]
            if index and is_ahead:
                out.append((before, cell))
    return tuple(out)


def check_lane(name: str, cells: np.ndarray, passable: np.ndarray) -> None:
    """Raises FloorError unless the cells (n,) are distinct, passable, and each beside the next."""
    width = passable.shape[1]
    y, x = np.divmod(cells, width)
    far = np.abs(np.diff(x)) + np.abs(np.diff(y))
    if (far != 1).any() or len(set(cells.tolist())) < len(cells):
        raise FloorError(f"the lane of {name}: cells in a row, each but once, were expected")
    if not passable.flat[cells].all():
        taken = [(int(i), int(j)) for i, j in zip(x, y) if not passable[j, i]]
        raise FloorError(f"the lane of {name} is obstructed at cells {taken}")
