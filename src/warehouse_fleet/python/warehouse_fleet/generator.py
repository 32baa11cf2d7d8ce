# SPDX-License-Identifier: Apache-2.0
"""Floors and problems like those of the competition: blocks of shelves between aisles, stations
along the walls."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Warehouse:
    """A floor. All arrays are (rows, columns) of bool."""

    passable: np.ndarray  # the whole floor, beneath storage units too
    storage: np.ndarray  # where storage units stand
    stations: np.ndarray  # where goods are picked

    def walls(self):
        """The floor of robots that never drive beneath units: shelves are walls."""
        return self.passable & ~self.storage


def warehouse(blocks=(10, 6), block=(3, 2), aisle=1, margin=4, stations=14):
    """Blocks of (columns, rows) of shelves with aisles so many cells wide between them, a margin
    around, and so many stations along each of the two long walls."""
    columns = blocks[0] * (block[0] + aisle) - aisle + 2 * margin
    rows = blocks[1] * (block[1] + aisle) - aisle + 2 * margin
    storage = np.zeros((rows, columns), bool)
    for top in range(margin, rows - margin, block[1] + aisle):
        for left in range(margin, columns - margin, block[0] + aisle):
            storage[top : top + block[1], left : left + block[0]] = True
    places = np.zeros((rows, columns), bool)
    along = np.linspace(1, columns - 2, stations).round().astype(int)
    places[0, along] = places[-1, along] = True
    return Warehouse(np.ones((rows, columns), bool), storage, places)


def huge(times=1):
    """About the floor of the preset `huge`, or so many times as large: blocks two deep, 4,000
    storage places and more, 40 stations."""
    rows = 34 * times
    return warehouse(blocks=(12, rows), block=(5, 2), aisle=2, margin=5, stations=20 * times)


def tasks(floor, count, rng, at_stations=0.5):
    """So many tasks of one errand: a station, or a cell of an aisle beside a shelf."""
    walls = floor.walls()
    beside = np.zeros_like(walls)
    for axis in (0, 1):
        for step in (-1, 1):
            beside |= np.roll(floor.storage, step, axis)
    stations, shelves = np.flatnonzero(floor.stations & walls), np.flatnonzero(beside & walls)
    at_station = rng.random(count) < at_stations
    return np.where(at_station, rng.choice(stations, count), rng.choice(shelves, count))


def starts(floor, robots, rng):
    """Distinct cells of the aisles for so many robots."""
    free = np.flatnonzero(floor.walls())
    if robots > free.size:
        raise ValueError(f"{robots} robots on {free.size} free cells")
    return rng.choice(free, robots, replace=False)
