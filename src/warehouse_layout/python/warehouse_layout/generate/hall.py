# SPDX-License-Identifier: Apache-2.0
"""A warehouse in a hall that has no room for stations with lanes.

Its stations are bays without a queue: one cell beside a street, where a unit is served, with the
belt beyond. Streets follow the shape of the hall: all of it is street at first, then one cell after
the other becomes a storage place, as long as the streets that are left have no dead ends and pass
every place and every bay.

    │ u u │       u  place, b  bay, ==  belt
    │ u u b ==    The streets around are two-way; a robot that meets another goes another way round.
    └─────┘
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from warehouse_layout.floor.masks import beside_of
from warehouse_layout.floor.stations import STEPS
from warehouse_layout.floor.street_graph import without_dead_ends

BELT_CELLS = 2
STREETS_A_ROBOT = 3  # cells, so that robots can pass each other
MOST_CELLS = 600  # of a hall in which every cell is tried
TRIED = 40  # belts' positions
EFFORT = 120_000  # cells looked at, in all

Cell = tuple[int, ...]  # i, j
Bay = tuple[Cell, int | None]  # its cell, and the heading of the belt, if it has one


@dataclass
class Hall:
    """The streets, places and bays of a hall, as masks (nx, ny) bool over the free cells."""

    streets: np.ndarray
    places: np.ndarray
    bays: list[Bay] = field(default_factory=list)  # those with a belt first

    def serves(self, streets: np.ndarray) -> bool:
        """Returns whether every place and every bay lies beside one of these streets."""
        beside = beside_of(streets)
        return bool(beside[self.places].all()) and all(beside[cell] for cell, _ in self.bays)


def carve(
    free: np.ndarray, picks: int, replenishments: int, patterns: Sequence[np.ndarray]
) -> Iterator[Hall]:
    """Yields Halls on free cells, one for each pattern, with the given counts of bays.

    A pattern (nx, ny) bool marks the cells that should rather be streets. Yields nothing where the
    free cells are too few, or more than MOST_CELLS.
    """
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


def regular(
    free: np.ndarray,
    picks: int,
    replenishments: int,
    pattern: np.ndarray,
    middle: np.ndarray,
) -> Hall | None:
    """Returns the Hall with streets along a pattern, and the bays nearest to the middle (i, j).

    Returns None where there are too few bays.
    """
    streets = without_dead_ends(pattern & free)
    room = free & ~pattern
    beside = room & beside_of(streets)
    hall = Hall(streets, np.zeros_like(free))
    cells = np.argwhere(beside)
    cells = cells[np.argsort(((cells - middle) ** 2).sum(1), kind="stable")].tolist()
    for kind in (True,) * picks + (False,) * replenishments:
        for i, j in cells:
            bays: Iterator[Bay] = (((i, j), h) for h in _headings(kind))
            bay = next((b for b in bays if all(_holds(room, c) for c in cells_of(*b))), None)
            if bay:
                room[tuple(np.transpose(cells_of(*bay)))] = False
                hall.bays.append(bay)
                break
        else:
            return None
    hall.places = room & beside
    return hall


def _headings(has_belt: bool) -> Sequence[int | None]:
    """Returns the headings in which a bay's belt may lie."""
    return range(4) if has_belt else (None,)


def _add_bay(hall: Hall, free: np.ndarray, has_belt: bool) -> bool:
    """Adds a bay where it costs the fewest streets, along walls if possible. False if nowhere."""
    used = np.zeros_like(free)
    for bay in hall.bays:
        used[tuple(np.transpose(list(cells_of(*bay))))] = True
    candidates = []
    for cell in np.argwhere(free & ~used).tolist():
        for heading in _headings(has_belt):
            cells = cells_of(tuple(cell), heading)
            if all(_holds(free, c) and not used[c] for c in cells):
                open_sides = sum(_holds(free, n) for c in cells for n in _around(c))
                candidates.append((open_sides, cells, heading))
    best = -1
    chosen: tuple[np.ndarray, list[Bay]] | None = None
    for _, cells, heading in sorted(candidates, key=lambda candidate: candidate[0])[:TRIED]:
        taken = hall.streets.copy()
        taken[tuple(np.transpose(cells))] = False
        streets = without_dead_ends(taken)
        bays = [*hall.bays, (cells[0], heading)]
        if streets.sum() > best and Hall(streets, hall.places, bays).serves(streets):
            best, chosen = int(streets.sum()), (streets, bays)
    if chosen:
        hall.streets, hall.bays = chosen
    return chosen is not None


def cells_of(cell: Cell, heading: int | None) -> list[Cell]:
    """Returns a bay's cell and those of its belt, if it has one."""
    if heading is None:
        return [cell]
    dx, dy = STEPS[heading]
    return [(cell[0] + i * dx, cell[1] + i * dy) for i in range(BELT_CELLS + 1)]


def _around(cell: Cell) -> list[Cell]:
    return [(cell[0] + dx, cell[1] + dy) for dx, dy in STEPS]


def _holds(mask: np.ndarray, cell: Cell) -> bool:
    inside = all(0 <= at < size for at, size in zip(cell, mask.shape))
    return inside and bool(mask[cell])


def _filled(hall: Hall, free: np.ndarray, pattern: np.ndarray) -> Hall:
    """Makes as many cells places as there can be, those of the pattern last; returns the hall."""
    room = free.copy()
    for bay in hall.bays:
        room[tuple(np.transpose(cells_of(*bay)))] = False
    # Cells beside the streets that are cut off from them hold units from the beginning.
    hall.places = room & ~hall.streets & beside_of(hall.streets)
    cells = np.argwhere(hall.streets).tolist()
    for cell in sorted(cells, key=lambda cell: bool(pattern[tuple(cell)])):
        if hall.streets[tuple(cell)]:
            _give_up(hall, tuple(cell), room)
    return hall


def _give_up(hall: Hall, cell: Cell, room: np.ndarray) -> None:
    """Makes a street's cell, and the dead ends that it leaves, places; if the rest serves all."""
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


def min_robots(places: int) -> int:
    """Returns how many robots work in a hall of `places` places, at least."""
    return max(1, places // 8)
