# SPDX-License-Identifier: Apache-2.0
"""The blocks of a regular layout, and the streets between them: how many, and where."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from warehouse_layout.file.request import Request

BLOCK_DEPTH = 2
BLOCK_LENGTH = 8  # at most

# Cells of a lane before its service cell: at least the entry, four to wait in and the corner.
# Long ways need more of them, to keep the station busy: at top speed a robot drives FETCH cells
# while two units are exchanged, one every 20 s.
QUEUE, WAIT, FETCH = 6, 4, 60
CROWDED = 20  # picking stations that need a third street beside them
FILLED = 0.85  # share of the storage places on which a unit stands


@dataclass(frozen=True)
class Shape:
    """Rows of blocks along y, and the blocks' lengths along x: first parking, then storage."""

    rows: int
    parking: tuple[int, ...]
    storage: tuple[int, ...]
    picks: int  # picking stations

    @property
    def street_x(self) -> np.ndarray:
        """Cells' x of the streets along y; the last, at the stations, are side by side."""
        beside = [1] * (2 if self.picks >= CROWDED else 1)
        return np.cumsum([0] + [n + 1 for n in self.parking + self.storage] + beside)

    @property
    def street_y(self) -> np.ndarray:
        """Cells' y of the streets along x; the last two are side by side."""
        return np.append(np.arange(self.rows + 1) * (BLOCK_DEPTH + 1), self._top)

    @property
    def _top(self) -> int:
        return self.rows * (BLOCK_DEPTH + 1) + 1

    @property
    def queue(self) -> int:
        """Cells of a lane before its service cell."""
        return max(QUEUE, WAIT + math.ceil((self.street_x[-1] + self._top) / FETCH))

    @property
    def block_y(self) -> np.ndarray:
        """Cells' y of the lowest places of each row of blocks."""
        return self.street_y[:-2] + 1

    @property
    def cells(self) -> tuple[int, int]:
        """Cells of the whole floor along x and y: lanes lie beyond the last streets."""
        lane = self.queue if self.picks else 0
        return int(self.street_x[-1]) + lane + (3 if lane else 1), self._top + lane + 1

    def cost(self) -> float:
        """Returns the area in cells, times the square root of length over width."""
        width, height = self.cells
        return width * height * math.sqrt(max(width / height, height / width))


def shapes(request: Request) -> Iterator[Shape]:
    """Yields candidates: with an even number of rows the outermost streets along x go round."""
    places = places_for(request.shelves)
    most = max(request.belts, math.ceil(math.sqrt(request.robots + places)), 2)
    for rows in range(max(2, request.belts + request.belts % 2), most + 3, 2):
        parking, storage = (
            _split(math.ceil(n / (rows * BLOCK_DEPTH))) for n in (request.robots, places)
        )
        yield Shape(rows, parking, storage, request.belts)


def places_for(units: int) -> int:
    """Returns how many storage places a warehouse of `units` storage units has."""
    return math.ceil(units / FILLED - 1e-9)


def _split(cells: int) -> tuple[int, ...]:
    """Returns the lengths of blocks, nearly equal, that hold `cells` cells along x."""
    blocks = math.ceil(cells / BLOCK_LENGTH)
    return tuple(cells // blocks + (i < cells % blocks) for i in range(blocks))


def _block_cells(shape: Shape, first: int, lengths: tuple[int, ...]) -> np.ndarray:
    """Returns all cells of blocks, (n, 2) x y; `first` is the index of the street before them."""
    starts = shape.street_x[first : first + len(lengths)] + 1
    xs = [x for start, length in zip(starts, lengths) for x in range(start, start + length)]
    ys = [y + i for y in shape.block_y for i in range(BLOCK_DEPTH)]
    return np.array([(x, y) for x in xs for y in ys], float).reshape(-1, 2)


def parking_cells(shape: Shape) -> np.ndarray:
    """Returns the cells x y of the parking blocks, (n, 2)."""
    return _block_cells(shape, 0, shape.parking)


def storage_cells(shape: Shape) -> np.ndarray:
    """Returns the cells x y of the storage blocks, (n, 2)."""
    return _block_cells(shape, len(shape.parking), shape.storage)


def mask_of(cells: np.ndarray, shape: Shape) -> np.ndarray:
    """Returns the mask (h, w) bool of cells x y, (n, 2)."""
    width, height = shape.cells
    out = np.zeros((height, width), bool)
    x, y = cells.astype(int).T
    out[y, x] = True
    return out
