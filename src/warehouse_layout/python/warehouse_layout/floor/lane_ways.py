# SPDX-License-Identifier: Apache-2.0
"""Streets that belong to lanes: robots come there only out of a lane, or can only go on into one.

    ▸ ▸ q q s x ▸ ▸      q s x  the lane of a station: queue, service cell, exit
    way in       way out

They are one-way for that reason, so no robots meet there. Robots that do not go to the station keep
out of them, as they do out of its lane.
"""

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from warehouse_layout.floor.stations import STEPS, cell_steps

Way = Callable[[int], list[int]]


def with_ways(
    lane: np.ndarray, passable: np.ndarray, places: np.ndarray, exits: np.ndarray
) -> np.ndarray:
    """Returns the cells of lanes and of the ways into them and out of them, (h, w) bool.

    All are (h, w), bool, `exits` uint8. places: storage and parking, which are no streets.
    """
    ways = _Ways(passable & ~places & ~lane, passable, exits)
    cells = np.flatnonzero(lane).tolist()
    out = lane.copy()
    after = ways.only_from(cells, ways.ahead, ways.before)
    before = ways.only_from(cells, ways.before, ways.ahead)
    out.flat[sorted(after ^ before)] = True  # what is both leads from one lane into the next
    return out


class _Ways:
    """The edges between the cells of a floor, and which cells are `streets` beside lanes."""

    def __init__(self, streets: np.ndarray, passable: np.ndarray, exits: np.ndarray) -> None:
        self._height, self._width = streets.shape
        self._steps = cell_steps(self._width)
        self._streets, self._passable, self._exits = (
            array.ravel() for array in (streets, passable, exits)
        )

    def ahead(self, cell: int) -> list[int]:
        """Returns the cells to which a robot without a load drives from one."""
        return [to for heading, to in self._beside(cell) if self._leads(cell, heading, to)]

    def before(self, cell: int) -> list[int]:
        """Returns the cells from which a robot without a load drives to one."""
        return [
            to for heading, to in self._beside(cell) if self._leads(to, (heading + 2) % 4, cell)
        ]

    def only_from(self, lane: Iterable[int], follow: Way, back: Way) -> set[int]:
        """Returns the streets to which one comes by `follow` from the lane alone, and goes on to
        streets alone: not into a storage place or the next lane."""
        known, out = set(lane), set[int]()
        front = list(known)
        while front:
            for cell in follow(front.pop()):
                if cell in known or not self._streets[cell] or not known.issuperset(back(cell)):
                    continue
                if all(self._streets[to] for to in follow(cell)):
                    known.add(cell)
                    out.add(cell)
                    front.append(cell)
        return out

    def _beside(self, cell: int) -> Iterator[tuple[int, int]]:
        """Yields heading and number of each cell beside one."""
        y, x = divmod(cell, self._width)
        for heading, ((dx, dy), step) in enumerate(zip(STEPS, self._steps)):
            if 0 <= x + dx < self._width and 0 <= y + dy < self._height:
                yield heading, cell + step

    def _leads(self, cell: int, heading: int, to: int) -> bool:
        is_open = self._passable[cell] and self._passable[to]
        return bool(is_open and self._exits[cell] >> heading & 1)
