# SPDX-License-Identifier: Apache-2.0
"""Generates floors and problems like those of the League of Robot Runners: blocks of shelves
between aisles, stations along two walls; floors with walls at random."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass
class LeagueWarehouse:
    """A floor. All arrays are (rows, columns) of bool."""

    passable: NDArray[np.bool_]  # the whole floor, beneath storage units too
    storage: NDArray[np.bool_]  # where storage units stand
    stations: NDArray[np.bool_]  # where goods are picked

    def walls(self) -> NDArray[np.bool_]:
        """Returns where robots can drive that never drive beneath units, (rows, columns): shelves
        are walls."""
        return self.passable & ~self.storage


def warehouse(
    blocks: tuple[int, int] = (10, 6),
    block: tuple[int, int] = (3, 2),
    aisle: int = 1,
    margin: int = 4,
    stations: int = 14,
) -> LeagueWarehouse:
    """Returns a floor of `blocks` (columns, rows) blocks of `block` (columns, rows) shelves each,
    with aisles of `aisle` cells between them, a margin of `margin` cells around them, and
    `stations` stations along each of the top and bottom walls."""
    columns = blocks[0] * (block[0] + aisle) - aisle + 2 * margin
    rows = blocks[1] * (block[1] + aisle) - aisle + 2 * margin
    storage = np.zeros((rows, columns), bool)
    for top in range(margin, rows - margin, block[1] + aisle):
        for left in range(margin, columns - margin, block[0] + aisle):
            storage[top : top + block[1], left : left + block[0]] = True
    places = np.zeros((rows, columns), bool)
    along = np.linspace(1, columns - 2, stations).round().astype(int)
    places[0, along] = places[-1, along] = True
    return LeagueWarehouse(np.ones((rows, columns), bool), storage, places)


def huge(times: int = 1) -> LeagueWarehouse:
    """Returns about the floor of the preset `huge`, or one `times` as large: blocks two deep, at
    least 4,000 storage places and 40 stations."""
    rows = 34 * times
    return warehouse(blocks=(12, rows), block=(5, 2), aisle=2, margin=5, stations=20 * times)


def tasks(
    floor: LeagueWarehouse, count: int, rng: np.random.Generator, at_stations: float = 0.5
) -> NDArray[np.int64]:
    """Returns the cells of `count` random tasks of one errand, (count,): a station with probability
    `at_stations`, else a cell of an aisle beside a shelf."""
    walls = floor.walls()
    beside = np.zeros_like(walls)
    for axis in (0, 1):
        for step in (-1, 1):
            beside |= np.roll(floor.storage, step, axis)
    stations, shelves = np.flatnonzero(floor.stations & walls), np.flatnonzero(beside & walls)
    at_station = rng.random(count) < at_stations
    return np.where(at_station, rng.choice(stations, count), rng.choice(shelves, count))


def starts(floor: LeagueWarehouse, robots: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Returns random distinct cells of the aisles, (robots,); raises ValueError if there are
    fewer."""
    free = np.flatnonzero(floor.walls())
    if robots > free.size:
        raise ValueError(f"{robots} robots on {free.size} free cells")
    return rng.choice(free, robots, replace=False)


def scattered(width: int, height: int, walls: float, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Returns where robots can drive on a floor whose cells are walls at random, with probability
    `walls`, (height, width): its largest connected part."""
    left = rng.random((height, width)) >= walls
    best = np.zeros_like(left)
    while np.count_nonzero(left) > np.count_nonzero(best):
        part = _connected(left, int(np.flatnonzero(left)[0]))
        best = part if np.count_nonzero(part) > np.count_nonzero(best) else best
        left = left & ~part
    return best


def _connected(passable: NDArray[np.bool_], cell: int) -> NDArray[np.bool_]:
    """Returns the cells that can be reached from a cell, (rows, columns)."""
    reached = np.zeros_like(passable)
    reached.flat[cell] = True
    while True:
        wider = reached.copy()
        wider[1:] |= reached[:-1]
        wider[:-1] |= reached[1:]
        wider[:, 1:] |= reached[:, :-1]
        wider[:, :-1] |= reached[:, 1:]
        wider &= passable
        if (wider == reached).all():
            return reached
        reached = wider
