# SPDX-License-Identifier: Apache-2.0
"""A warehouse on the free cells of a floor that is not its own.

Seen from above, streets one cell wide run along every third line of cells along x and every ninth
along y; between them is room for blocks of eight by two. Obstacles cut holes into this pattern:
what still hangs together of the streets is used, and of the cells beside them.
"""

import numpy as np

from warehouse_sim import items as shelves
from warehouse_sim.layout import BELT, BLOCK_DEPTH, BLOCK_LENGTH, DROP, SEED, Layout, chance
from warehouse_sim.request import RequestError
from warehouse_sim.routes import STEPS

ROW, COLUMN = BLOCK_DEPTH + 1, BLOCK_LENGTH + 1  # from street to street


def fit(request, cells, seed=SEED):
    """The Layout of a resolved Request on free Cells, as layout.plan() makes it.

    Raises RequestError if there are too few.
    """
    most = 0
    for shift in np.ndindex(COLUMN, ROW):
        pattern = _Pattern(cells, shift)
        layout = pattern.layout(request, chance(seed))
        if layout:
            return layout
        most = max(most, len(pattern.places))
    raise RequestError(
        f"{request} don't fit: of {(~cells.taken).sum()} free cells, {most} lie beside streets"
        f" that hang together; robots and storage units together, {most} at the most, would fit"
    )


class _Pattern:
    """Streets and places on the free cells; cells are indices into `taken`."""

    def __init__(self, cells, shift):
        self._cells = cells
        i, j = np.indices(cells.taken.shape)
        is_street = ((i - shift[0]) % COLUMN == 0) | ((j - shift[1]) % ROW == 0)
        self._streets = _largest_part(is_street & ~cells.taken)
        self._rooms = ~is_street & ~cells.taken
        beside = np.zeros_like(self._rooms)
        for step in STEPS:
            beside |= _shifted(self._streets, step)
        # The nearest to the middle first; equal ones in a fixed order.
        middle = np.array(cells.taken.shape) / 2 - 0.5
        places = np.argwhere(self._rooms & beside)
        self.places = places[np.argsort(((places - middle) ** 2).sum(1), kind="stable")]

    def layout(self, request, rng):
        """None if it does not fit."""
        count = request.shelves + request.robots
        drops = self._drops(request.belts, self.places[:count])
        if len(self.places) < count or drops is None:
            return None
        units, robots = np.split(self.places[:count], [request.shelves])
        if rng is not None:
            units, robots = rng.permutation(units), rng.permutation(robots)
        item_unit, item_place = shelves.spread(request.items, request.shelves, rng)
        drops = self._world(drops)
        return Layout(
            floor=self._cells.floor,
            robots=np.column_stack([self._world(robots), [self._yaw(cell) for cell in robots]]),
            units=self._world(units),
            item_unit=item_unit,
            item_place=item_place,
            belts=np.pad(drops + (BELT - DROP, 0), ((0, 0), (0, 1))),
            drops=drops,
            has_own_floor=False,
        )

    def _drops(self, count, taken):
        """Cells of streets with room for a belt of two cells along x; None if there are too few."""
        rooms = self._rooms.copy()
        rooms[tuple(taken.T)] = False
        found = self._streets & _shifted(rooms, (-1, 0)) & _shifted(rooms, (-2, 0))
        drops = np.argwhere(found)
        middle = self.places[: len(taken)].mean(0) if len(taken) else (0, 0)
        drops = drops[np.argsort(((drops - middle) ** 2).sum(1), kind="stable")][:count]
        return drops if len(drops) == count else None

    def _yaw(self, cell):
        """Towards the street beside a cell."""
        for dx, dy in STEPS:
            i, j = cell[0] + dx, cell[1] + dy
            inside = 0 <= i < self._streets.shape[0] and 0 <= j < self._streets.shape[1]
            if inside and self._streets[i, j]:
                return np.arctan2(dy, dx)
        return 0.0

    def _world(self, cells):
        """Grid points in world [m]."""
        return np.reshape(cells, (-1, 2)) + (float(self._cells.x), float(self._cells.y))


def _shifted(mask, step):
    """The mask moved by that many cells along x and y; what leaves is lost."""
    moved = np.zeros_like(mask)
    (dx, dy), (nx, ny) = step, mask.shape
    moved[max(dx, 0) : nx + min(dx, 0), max(dy, 0) : ny + min(dy, 0)] = mask[
        max(-dx, 0) : nx + min(-dx, 0), max(-dy, 0) : ny + min(-dy, 0)
    ]
    return moved


def _largest_part(mask):
    """The cells that hang together with each other, of the largest such part."""
    left = {tuple(cell) for cell in np.argwhere(mask).tolist()}
    largest = []
    while len(left) > len(largest):
        part = [left.pop()]
        for x, y in part:  # grows meanwhile
            for dx, dy in STEPS:
                near = (x + dx, y + dy)
                if near in left:
                    left.remove(near)
                    part.append(near)
        largest = max(largest, part, key=len)
    out = np.zeros_like(mask)
    if largest:
        out[tuple(np.transpose(largest))] = True
    return out
