# SPDX-License-Identifier: Apache-2.0
"""Draws streets: finds the characters that say by which headings each cell may be left.

What a character says depends on the next cell's too (see drawn_floor). So the cells of the two
colours of a checkerboard choose in turn, each the character with which it and its neighbours are
wrong least often, until no cell changes. Where one is wrong still, it and its neighbours choose
together.
"""

from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np

from warehouse_layout.convert.common import cells_of, named, plural
from warehouse_layout.file import drawn_floor
from warehouse_layout.file import layout_file as lf
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import STEPS, Station, lane_mask, neighbour, with_lanes

CODES = lf.FLOOR + lf.ONE_WAY + lf.ALONG_X + lf.ALONG_Y  # the characters of streets
ROUNDS = 20  # most choices of a cell
MENDED = 2000  # most cells that choose together with their neighbours, in a round


def draw(plan: FloorPlan, floor: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Returns the floor (h, w) with the streets of a plan drawn on it, and what they can't say."""
    streets = _streets(plan)
    out = floor.copy()
    out[streets] = np.array(list(CODES))[_codes(plan.exits, streets)[streets]]
    return out, _unsaid(plan, out, streets)


def _streets(plan: FloorPlan) -> np.ndarray:
    lane = lane_mask(plan.stations, plan.shape)
    return plan.passable & ~plan.storage & ~plan.parking & ~lane


@cache
def _leaves() -> np.ndarray:
    """Returns whether a cell may be left into the next, (7, 7, 4) by codes of both and heading."""
    first, second = (list(c) for c in zip(*((a, b) for a in CODES for b in CODES)))
    pairs = np.array([first, second]).T  # a row for each pair
    out = np.zeros((len(CODES), len(CODES), 4), bool)
    for heading in range(4):
        ahead = heading < 2
        floor = pairs if ahead else pairs[:, ::-1]
        floor = floor if heading % 2 == 0 else floor.T
        exits = drawn_floor.exits(floor, drawn_floor.areas(floor), [])
        own = exits if heading % 2 == 0 else exits.T
        left = own[:, 0 if ahead else 1] >> heading & 1
        out[:, :, heading] = left.reshape(len(CODES), len(CODES))
    return out


def _codes(exits: np.ndarray, streets: np.ndarray) -> np.ndarray:
    """Returns the code of each street cell's character, (h, w)."""
    codes = _first_codes(exits, streets)
    rows, columns = np.indices(codes.shape)
    colour = (rows + columns) % 2
    for step in range(ROUNDS):
        wrong = np.stack([_wrong(code, codes, exits, streets) for code in range(len(CODES))])
        best = wrong.argmin(axis=0)
        now = np.take_along_axis(wrong, codes[None], axis=0)[0]
        better = streets & (wrong.min(axis=0) < now)
        if not better.any():
            break
        chosen = better & (colour == step % 2)
        codes = np.where(chosen, best, codes)
    _Mending(codes, exits, streets).run()
    return codes


def _first_codes(exits: np.ndarray, streets: np.ndarray) -> np.ndarray:
    """Returns the codes that cells would have without regard to their neighbours', (h, w)."""
    open_ = np.zeros(streets.shape, np.uint8)  # towards other streets
    for heading in range(4):
        open_ |= (neighbour(streets, heading).astype(np.uint8)) << heading
    table = np.zeros(16, int)
    for heading in range(4):
        table[[1 << heading, 1 << heading | 1 << (heading + 1) % 4]] = 1 + heading
    table[[0b0101, 0b1010]] = 5, 6
    towards = exits & open_
    return np.where(towards == open_, 0, table[towards])


def _wrong(code: int, codes: np.ndarray, exits: np.ndarray, streets: np.ndarray) -> np.ndarray:
    """Returns how many exits from and to each cell would be wrong if it had a code, (h, w)."""
    table = _leaves()
    out = np.zeros(codes.shape, np.uint8)
    for heading in range(4):
        back = (heading + 2) % 4
        beside = streets & neighbour(streets, heading)
        other = neighbour(codes, heading)
        leaves = table[code, other, heading] != (exits >> heading & 1)
        enters = table[other, code, back] != (neighbour(exits, heading) >> back & 1)
        out += beside & leaves
        out += beside & enters
    return out


class _Mending:
    """Lets a cell and its neighbours choose together.

    With the cell's code given, the best codes of its neighbours do not depend on each other.
    """

    def __init__(self, codes: np.ndarray, exits: np.ndarray, streets: np.ndarray) -> None:
        self._codes, self._exits, self._streets = codes, exits, streets

    def run(self) -> None:
        for _ in range(ROUNDS):
            wrong = np.zeros(self._codes.shape, np.uint8)
            for code in range(len(CODES)):
                here = self._codes == code
                wrong[here] = _wrong(code, self._codes, self._exits, self._streets)[here]
            cells = np.argwhere((wrong > 0) & self._streets)[:MENDED].tolist()
            if not sum([self._mend((row, column)) for row, column in cells]):
                return

    def _mend(self, cell: tuple[int, int]) -> bool:
        """Changes the codes of a cell and its neighbours; returns whether that made it better."""
        beside = list(self._beside(cell))
        costs = [self._costs(cell, other, heading) for heading, other in beside]
        total = sum(cost.min(axis=1) for cost in costs)
        codes = [self._codes[other] for _, other in beside]
        now = sum(cost[self._codes[cell], code] for cost, code in zip(costs, codes))
        if total.min() >= now:
            return False
        best = int(total.argmin())
        self._codes[cell] = best
        for (_, other), cost in zip(beside, costs):
            self._codes[other] = cost[best].argmin()
        return True

    def _costs(self, cell: tuple[int, int], other: tuple[int, int], heading: int) -> np.ndarray:
        """Returns what is wrong at a neighbour, (7, 7) by the codes of the cell and its own."""
        out = self._between(cell, other, heading)
        for further, third in self._beside(other):
            if third != cell:
                out = out + self._between(other, third, further)[:, self._codes[third]]
        return out

    def _between(self, cell: tuple[int, int], other: tuple[int, int], heading: int) -> np.ndarray:
        """Returns what is wrong between two cells, (7, 7) by their codes."""
        table, back = _leaves(), (heading + 2) % 4
        there = table[:, :, heading] != (self._exits[cell] >> heading & 1)
        return there.astype(int) + ((self._exits[other] >> back & 1) != table[:, :, back].T)

    def _beside(self, cell: tuple[int, int]) -> Iterator[tuple[int, tuple[int, int]]]:
        height, width = self._streets.shape
        for heading, (dx, dy) in enumerate(STEPS):
            row, column = cell[0] + dy, cell[1] + dx
            if 0 <= row < height and 0 <= column < width and self._streets[row, column]:
                yield heading, (row, column)


def _unsaid(plan: FloorPlan, floor: np.ndarray, streets: np.ndarray) -> list[str]:
    """Returns sentences about cells that the drawing lets robots leave otherwise."""
    said = _said(plan.stations, floor, plan.passable)
    both = streets & plan.passable
    return [
        f"{plural(len(cells), 'cell')} may be left {what} than before: {named(cells)}"
        for what, mask in (
            ("in more directions", both & ((said & ~plan.exits) != 0)),
            ("in fewer directions", both & ((plan.exits & ~said) != 0)),
        )
        if (cells := cells_of(mask))
    ]


def _said(stations: Sequence[Station], floor: np.ndarray, passable: np.ndarray) -> np.ndarray:
    ways = drawn_floor.exits(floor, drawn_floor.areas(floor), list(stations))
    return with_lanes(ways, passable, stations)
