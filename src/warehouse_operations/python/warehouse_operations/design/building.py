# SPDX-License-Identifier: Apache-2.0
"""A building to be filled: its free cells, and rectangles of them in which a floor has room."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy import ndimage

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import Cell, LayoutFile, StationEntry
from warehouse_layout.place import file_check

LEAST, MOST = 8, 1000  # cells of an edge
PILLAR = 9  # cells of the largest obstacle that a floor is laid around
TRIES = 24  # positions tried for a floor
MAX_ROOMS = 3  # largest free rectangles of a building in which a floor is laid
SHARE, ALIKE = 0.3, 0.6  # least area over the largest room's; largest overlap with a larger room
Room = tuple[int, int, int, int]  # column, row, width, height


class BuildingError(ValueError):
    """Raised for a building in which no layout can be searched."""


@dataclass(frozen=True)
class Building:
    """A layout file that draws walls, pillars, doors and other fixed things; plain floor is
    free."""

    file: LayoutFile

    @classmethod
    def read(cls, text: str) -> "Building":
        """Reads a layout file, or WIDTHxHEIGHT in cells. Raises BuildingError, LayoutFileError."""
        if match := re.fullmatch(r"(\d+)\s*[xX×]\s*(\d+)", text.strip()):
            width, height = int(match[1]), int(match[2])
            if not all(LEAST <= edge <= MOST for edge in (width, height)):
                raise BuildingError(f"building is {text}; edges of {LEAST} to {MOST} cells")
            floor = np.full((height, width), lf.FLOOR, "<U1")
            return cls(LayoutFile(floor=floor, name=f"{width} x {height}"))
        if not Path(text).is_file():
            raise BuildingError(f"building is {text}; a layout file or WIDTHxHEIGHT was expected")
        file = lf.read(text)
        if not (file.floor == lf.FLOOR).any():
            raise BuildingError(f"{text}: no plain floor ({lf.FLOOR}) is drawn to be filled")
        return cls(file)

    @property
    def free(self) -> np.ndarray:
        """The cells to be filled, (h, w) bool."""
        return np.asarray(self.file.floor == lf.FLOOR)

    @property
    def square_metres(self) -> float:
        """The area of its floor [m2], without walls and cells outside."""
        inside = ~np.isin(self.file.floor, [lf.NO_FLOOR, lf.WALL])
        return float(inside.sum()) * self.file.spacing**2

    @cached_property
    def rooms(self) -> list[Room]:
        """The largest free rectangles, pillars included: one for each arm of an L-shaped
        building."""
        every = sorted(rectangles(self._without_pillars()), key=lambda room: -room[2] * room[3])
        out: list[Room] = []
        for room in every:
            area = room[2] * room[3]
            if len(out) == MAX_ROOMS or area < SHARE * out[0][2] * out[0][3] if out else not area:
                break
            if all(_shared(room, other) <= ALIKE * area for other in out):
                out.append(room)
        return out

    def _without_pillars(self) -> np.ndarray:
        """Returns the free cells and those of small obstacles among them."""
        taken = ~self.free
        labels, count = ndimage.label(taken, np.ones((3, 3)))
        sizes = ndimage.sum_labels(taken, labels, np.arange(count + 1))
        edge = np.unique(np.r_[labels[0], labels[-1], labels[:, 0], labels[:, -1]])
        small = sizes <= PILLAR
        small[edge] = small[0] = False
        return self.free | small[labels]

    def filled(self, floor: LayoutFile, room: Room) -> LayoutFile | None:
        """Returns the building with a floor at the first position in a room where a fleet can work;
        None without such a position."""
        column, row, width, height = room
        rows, columns = floor.floor.shape
        if columns > width or rows > height:
            return None
        slack = [(x, y) for y in range(height - rows + 1) for x in range(width - columns + 1)]
        middle = (width - columns) / 2, (height - rows) / 2
        slack.sort(key=lambda at: (abs(at[0] - middle[0]) + abs(at[1] - middle[1]), at))
        step = max(len(slack) // TRIES, 1)
        for x, y in slack[::step][:TRIES]:
            file = self._with(floor, column + x, row + y)
            if file is not None and not file_check.faults(file):
                return file
        return None

    def _with(self, floor: LayoutFile, x: int, y: int) -> LayoutFile | None:
        """Returns the building with a floor whose corner is at a cell."""
        rows, columns = floor.floor.shape
        out = self.file.floor.copy()
        out[self.free] = lf.KEEP_OUT
        part, free = out[y : y + rows, x : x + columns], self.free[y : y + rows, x : x + columns]
        drawn = (floor.floor != lf.NO_FLOOR) & free
        part[drawn] = floor.floor[drawn]
        names = {station.key for station in self.file.stations}
        stations = []
        for station in floor.stations:
            cells = [station.service, *station.queue, *station.exit]
            if station.key in names or not all(free[cell[1], cell[0]] for cell in cells):
                return None
            stations.append(_moved(station, x, y))
        return replace(
            floor,
            floor=out,
            stations=(*self.file.stations, *stations),
            spacing=self.file.spacing,
            building=self.file.building,
            at=self.file.at,
            stock=self.file.stock,
            skus=self.file.skus,
            items=0 if self.file.stock else floor.items,
            path=self.file.path,
        )


def _moved(station: StationEntry, x: int, y: int) -> StationEntry:
    def cell(place: Cell) -> Cell:
        return place[0] + x, place[1] + y

    return replace(
        station,
        service=cell(station.service),
        queue=tuple(map(cell, station.queue)),
        exit=tuple(map(cell, station.exit)),
    )


def rectangles(free: np.ndarray) -> set[Room]:
    """Returns all maximal rectangles of free cells, and some others."""
    out = set()
    heights = np.zeros(free.shape[1], int)
    for row, line in enumerate(free):
        heights = np.where(line, heights + 1, 0)
        for column, width, height in _under(heights.tolist()):
            out.add((column, row - height + 1, width, height))
    return out


def _shared(first: Room, second: Room) -> int:
    """Returns how many cells two rectangles have in common."""
    across, along = (
        min(first[i] + first[i + 2], second[i] + second[i + 2]) - max(first[i], second[i])
        for i in (0, 1)
    )
    return max(across, 0) * max(along, 0)


def _under(heights: list[int]) -> Iterator[tuple[int, int, int]]:
    """Yields the largest rectangles under a skyline: (column, width, height)."""
    stack: list[tuple[int, int]] = []  # (column, height), ascending
    for column, height in enumerate([*heights, 0]):
        begin = column
        while stack and stack[-1][1] >= height:
            begin, top = stack.pop()
            yield begin, column - begin, top
        stack.append((begin, height))
