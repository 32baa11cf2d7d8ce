# SPDX-License-Identifier: Apache-2.0
"""Draws layout files by chance: good ones, odd ones and such as no fleet can work in."""

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile, StationEntry
from warehouse_layout.floor.stations import STEPS

LOWEST = "A"


def layout(seed):
    """Returns the LayoutFile of a seed."""
    return _Drawing(np.random.default_rng(seed)).file(f"random {seed}")


class _Drawing:
    def __init__(self, rng):
        self._rng = rng
        # Blocks of storage places, one to three deep, streets of one or two cells, open floor.
        self._long, self._deep = int(rng.integers(2, 6)), int(rng.choice([1, 2, 2, 2, 3]))
        self._street = int(rng.choice([1, 1, 1, 1, 2]))
        self._blocks = 2 * rng.integers(1, 3, 2) - 1  # along x and y; odd: outer streets go round
        self._maybe(0.2, lambda: setattr(self, "_blocks", self._blocks + rng.integers(0, 2, 2)))
        self._period = np.array([self._long, self._deep]) + self._street
        self._inner = self._blocks * self._period + self._street
        width, height = self._inner + rng.integers(3, 12, 2) * (rng.random(2) < 0.8)
        self.floor = np.full((height, width), lf.FLOOR, "<U1")
        self._stations = []

    def file(self, name):
        self._draw_blocks()
        streets = self._rng.integers(4)
        if streets:
            self._direct(one_way=streets < 3)
        self._maybe(0.1, self._draw_wall)
        self._maybe(0.1, self._spoil)
        self._add_parking()
        for _ in range(self._rng.integers(1, 4)):
            self._add_station()
        if self._rng.random() < 0.7:
            self.floor = np.pad(self.floor, 1, constant_values=lf.WALL)
            self._stations = [_moved(station) for station in self._stations]
        return LayoutFile(
            floor=self.floor,
            name=name,
            spacing=float(self._rng.choice([1.0, 1.0, 1.0, 1.2])),
            stations=tuple(self._stations),
            storage_units=float(self._rng.choice([0.3, 0.6, 0.85])),
            robots=int(self._rng.integers(1, 7)),
            items=20,
        )

    def _maybe(self, chance, act):
        if self._rng.random() < chance:
            act()

    def _draw_blocks(self):
        for i, j in np.ndindex(*self._blocks):
            x, y = (i, j) * self._period + self._street
            self.floor[y : y + self._deep, x : x + self._long] = lf.STORAGE

    def _direct(self, one_way):
        """One-way streets, neighbours opposed, or streets both ways along one axis."""
        right, top = self._inner
        for j, y in enumerate(range(0, top, self._period[1])):
            self._draw((y, slice(right)), lf.ONE_WAY[2 * (j % 2)] if one_way else lf.ALONG_X)
        for i, x in enumerate(range(0, right, self._period[0])):
            inner = slice(1, top - 1)  # crossings are those of the rows
            self._draw((inner, x), lf.ONE_WAY[3 - 2 * (i % 2)] if one_way else lf.ALONG_Y)

    def _draw(self, where, character):
        cells = self.floor[where]
        cells[cells == lf.FLOOR] = character
        if character in (lf.ALONG_X, lf.ALONG_Y):  # streets cross where any way is open
            cells[:: self._period[0 if character == lf.ALONG_X else 1]] = lf.FLOOR

    def _draw_wall(self):
        """A wall across the floor, with a door or two."""
        length = self.floor.shape[0] if (along := self._rng.random() < 0.5) else len(self.floor.T)
        line = self.floor.T if along else self.floor
        row = line[self._rng.integers(len(line))]
        doors = self._rng.choice(length, min(length, int(self._rng.integers(1, 5))), replace=False)
        keep = row[doors].copy()
        row[:] = lf.WALL
        row[doors] = np.where(keep == lf.STORAGE, lf.FLOOR, keep)

    def _spoil(self):
        """A few cells of anything."""
        for _ in range(self._rng.integers(1, 6)):
            self.floor[self._cell()] = self._rng.choice(list("#x><^v-|sp. "))

    def _cell(self):
        return tuple(int(self._rng.integers(edge)) for edge in self.floor.shape)

    def _add_parking(self):
        for _ in range(self._rng.integers(0, 5)):
            row, column = self._cell()
            if self.floor[row, column] == lf.STORAGE or self._rng.random() < 0.1:
                self.floor[row, column] = self._rng.choice([lf.PARKING, lf.CHARGING])

    def _add_station(self):
        """A station anywhere: with a belt beside it or without, its lane drawn or to be found."""
        rng, key = self._rng, chr(ord(LOWEST) + len(self._stations))
        for attempt in range(20):
            row, column = self._cell()
            character = self.floor[row, column]
            if character == lf.FLOOR or attempt > 4 and character not in lf.STORAGE + lf.WALL:
                break
        kind = "pick" if not self._stations or rng.random() < 0.6 else "replenish"
        self.floor[row, column] = key
        queue, leave = self._lane(column, row) if rng.random() < 0.2 else ((), ())
        self._stations.append(StationEntry(key, (column, row), key.lower(), kind, queue, leave))
        if kind == "pick" and rng.random() < 0.4:
            dx, dy = STEPS[rng.integers(4)]
            height, width = self.floor.shape
            for i in (1, 2):
                x, y = column + i * dx, row + i * dy
                if 0 <= x < width and 0 <= y < height and (x, y) not in (*queue, *leave):
                    self.floor[y, x] = lf.BELT

    def _lane(self, column, row):
        """Queue and exit in a row through the service cell, as far as there is floor."""
        (dx, dy), (height, width) = STEPS[self._rng.integers(4)], self.floor.shape
        cells = [(column + i * dx, row + i * dy) for i in range(-3, 3)]
        inside = [(x, y) for x, y in cells if 0 <= x < width and 0 <= y < height]
        at = inside.index((column, row))
        return tuple(inside[:at]), tuple(inside[at + 1 :])


def _moved(station):
    """Returns the station on a floor with a margin."""
    queue, leave = (
        tuple((x + 1, y + 1) for x, y in part) for part in (station.queue, station.exit)
    )
    x, y = station.service
    return StationEntry(station.key, (x + 1, y + 1), station.name, station.kind, queue, leave)
