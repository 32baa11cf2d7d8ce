# SPDX-License-Identifier: Apache-2.0
"""A warehouse in a hall that has no room for stations with lanes.

Its stations are bays without a queue: one cell beside a street, where the unit stands that is
served, with the belt beyond. Streets go where the shape of the hall lets them: all of it is street
at first, then cell after cell becomes a storage place, as long as what is left of the streets is
without dead ends and passes every place and every bay.

    │ u u │       u  place, b  bay, ==  belt
    │ u u b ==    The streets around are two-way; a robot that meets another goes another way round.
    └─────┘
"""

import math
from dataclasses import dataclass, field

import numpy as np

from warehouse_layout.stations import STEPS
from warehouse_layout.street_graph import without_dead_ends

BELT_CELLS = 2
STREETS_A_ROBOT = 3  # cells, so that robots can pass each other
MOST_CELLS = 600  # of a hall in which every cell is tried
TRIED = 40  # belts' positions
EFFORT = 120_000  # cells looked at, in all


@dataclass
class Hall:
    """Masks are (nx, ny) bool over the free cells. Bays are pairs (cell (i, j), heading of the belt
    or None), those with a belt first."""

    streets: np.ndarray
    places: np.ndarray
    bays: list = field(default_factory=list)

    def serves(self, streets):
        """Whether every place and every bay lies beside one of those streets."""
        beside = beside_of(streets)
        return beside[self.places].all() and all(beside[cell] for cell, _ in self.bays)


def beside_of(mask):
    """The cells next to one of a mask (nx, ny)."""
    out = np.zeros_like(mask)
    out[1:] |= mask[:-1]
    out[:-1] |= mask[1:]
    out[:, 1:] |= mask[:, :-1]
    out[:, :-1] |= mask[:, 1:]
    return out


def carve(free, picks, replenishments, patterns):
    """Halls with so many bays of either kind on free cells, one for each of the patterns, (nx, ny)
    bool, of cells that should rather be streets. None are too large to be tried."""
    size = int(free.sum())
    start = without_dead_ends(free)
    if not 4 <= size <= MOST_CELLS or not start.any():
        return
    hall = Hall(start, np.zeros_like(free))
    for kind in (True,) * picks + (False,) * replenishments:
        if not _add_bay(hall, free, has_belt=kind):
            return
    for pattern in patterns[:: max(1, math.ceil(len(patterns) * size**2 / EFFORT))]:
        yield _filled(Hall(hall.streets, hall.places, hall.bays), free, pattern)


def regular(free, picks, replenishments, pattern, middle):
    """The Hall with streets along a pattern and bays beside them, the nearest to the middle; None
    where there are too few."""
    streets = without_dead_ends(pattern & free)
    room = free & ~pattern
    beside = room & beside_of(streets)
    found = Hall(streets, np.zeros_like(free))
    cells = np.argwhere(beside)
    cells = cells[np.argsort(((cells - middle) ** 2).sum(1), kind="stable")].tolist()
    for kind in (True,) * picks + (False,) * replenishments:
        for cell in map(tuple, cells):
            bays = ([cells_of(cell, h), h] for h in (range(4) if kind else (None,)))
            bay = next((b for b in bays if all(_holds(room, c) for c in b[0])), None)
            if bay:
                room[tuple(np.transpose(bay[0]))] = False
                found.bays.append((cell, bay[1]))
                break
        else:
            return None
    found.places = room & beside
    return found


def _add_bay(hall, free, has_belt):
    """Puts a bay where it costs the fewest streets, along walls if it may. False if nowhere."""
    used = np.zeros_like(free)
    for bay in hall.bays:
        used[tuple(np.transpose(list(cells_of(*bay))))] = True
    candidates = []
    for cell in np.argwhere(free & ~used).tolist():
        for heading in range(4) if has_belt else (None,):
            cells = cells_of(tuple(cell), heading)
            if all(_holds(free, c) and not used[c] for c in cells):
                open_sides = sum(_holds(free, n) for c in cells for n in _around(c))
                candidates.append((open_sides, cells, heading))
    best, found = -1, None
    for _, cells, heading in sorted(candidates, key=lambda one: one[0])[:TRIED]:
        taken = hall.streets.copy()
        taken[tuple(np.transpose(cells))] = False
        streets = without_dead_ends(taken)
        bays = [*hall.bays, (cells[0], heading)]
        if streets.sum() > best and Hall(streets, hall.places, bays).serves(streets):
            best, found = int(streets.sum()), (streets, bays)
    if found:
        hall.streets, hall.bays = found
    return found is not None


def cells_of(cell, heading):
    """A bay's cell and those of its belt."""
    if heading is None:
        return [cell]
    dx, dy = STEPS[heading]
    return [(cell[0] + i * dx, cell[1] + i * dy) for i in range(BELT_CELLS + 1)]


def _around(cell):
    return [(cell[0] + dx, cell[1] + dy) for dx, dy in STEPS]


def _holds(mask, cell):
    inside = all(0 <= at < size for at, size in zip(cell, mask.shape))
    return inside and bool(mask[cell])


def _filled(hall, free, pattern):
    """The hall with as many places as there can be; cells of the pattern become one last."""
    room = free.copy()
    for bay in hall.bays:
        room[tuple(np.transpose(cells_of(*bay)))] = False
    # What is cut off from the streets but beside them holds units from the beginning.
    hall.places = room & ~hall.streets & beside_of(hall.streets)
    cells = np.argwhere(hall.streets).tolist()
    for cell in sorted(cells, key=lambda cell: bool(pattern[tuple(cell)])):
        if hall.streets[tuple(cell)]:
            _give_up(hall, tuple(cell), room)
    return hall


def _give_up(hall, cell, room):
    """Makes a street's cell, and what is a dead end then, places; if the rest still serves all."""
    left = hall.streets.copy()
    left[cell] = False
    streets = without_dead_ends(left)
    if not streets.any():
        return
    places = hall.places | (hall.streets & ~streets)
    count = int(places.sum())
    if streets.sum() < STREETS_A_ROBOT * min_robots(count):
        return
    if Hall(streets, places & room, hall.bays).serves(streets):
        hall.streets, hall.places = streets, places & room


def min_robots(places):
    """So many work in a hall of so many places, at least."""
    return max(1, places // 8)
