# SPDX-License-Identifier: Apache-2.0
"""What the characters of a drawing mean for robots: areas, and the ways out of each cell.

A one-way cell is left ahead, into places and lanes at its sides, and into a street that leads away
from it; no street is left against the direction of the next cell. Thus streets cross where a row's
cells run through a column's.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import Cell
from warehouse_layout.floor.floor_plan import ALL_EXITS
from warehouse_layout.floor.stations import STEPS, Station, lane_mask, neighbour


@dataclass(frozen=True, eq=False)
class DrawnFloor:
    """The areas of a drawing, each (h, w) bool; row 0 is the lowest."""

    passable: np.ndarray
    storage: np.ndarray
    parking: np.ndarray  # charging places among them
    charging: np.ndarray
    walls: np.ndarray
    belts: np.ndarray

    @cached_property
    def streets(self) -> np.ndarray:
        """Passable cells that are neither storage nor parking, (h, w) bool."""
        return self.passable & ~self.storage & ~self.parking


def areas(floor: np.ndarray) -> DrawnFloor:
    """Returns the areas of a drawing, (h, w) characters."""
    charging = floor == lf.CHARGING
    closed = np.isin(floor, [lf.WALL, lf.BELT, lf.NO_FLOOR, lf.KEEP_OUT])
    return DrawnFloor(
        passable=~closed,
        storage=floor == lf.STORAGE,
        parking=charging | (floor == lf.PARKING),
        charging=charging,
        walls=floor == lf.WALL,
        belts=floor == lf.BELT,
    )


def exits(floor: np.ndarray, drawn: DrawnFloor, stations: list[Station]) -> np.ndarray:
    """Returns by which headings each cell may be left, (h, w) uint8, bit h for heading h."""
    lane = lane_mask(stations, floor.shape)
    street = drawn.streets & ~lane
    one_way = [street & (floor == character) for character in lf.ONE_WAY]
    along_x, along_y = (street & (floor == c) for c in (lf.ALONG_X, lf.ALONG_Y))
    ruled = np.any([*one_way, along_x, along_y], axis=0)
    out = np.full(floor.shape, ALL_EXITS, np.uint8)
    for heading in range(4):
        along = along_x if heading % 2 == 0 else along_y
        # Ahead, into what is not a street (places, lanes), and into streets that lead away.
        leaves = one_way[heading] | along | ~neighbour(street, heading)
        leaves |= neighbour(one_way[heading], heading) | neighbour(along, heading)
        against = street & neighbour(one_way[(heading + 2) % 4], heading)
        shut = (ruled & ~leaves) | against
        out[shut] &= ~np.uint8(1 << heading)
    return out


def beside(mask: np.ndarray, cell: Cell) -> list[int]:
    """Returns the headings in which the cells beside this one are in the mask."""
    (height, width), (column, row) = mask.shape, cell
    return [
        heading
        for heading, (dx, dy) in enumerate(STEPS)
        if 0 <= column + dx < width and 0 <= row + dy < height and mask[row + dy, column + dx]
    ]
