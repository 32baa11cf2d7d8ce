# SPDX-License-Identifier: Apache-2.0
"""Divides a measured map into the cells of a floor."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from warehouse_layout.convert import straight
from warehouse_layout.convert.common import PathName, check_size
from warehouse_layout.file import layout_file as lf

WALL = 0.8  # of a cell's length that a wall of one pixel goes through it
MOST = 0.3  # share of a cell that is occupied, which makes it a wall in any case
SEEN = 0.5  # share of a cell that was seen to be free, of floor
NEARLY = 0.97  # of the floor that other edges would have
PHASES = 20  # places of the cells' edges that are tried along an axis, at most
SAMPLE = 300_000  # free pixels that decide about those
CHUNK = 1_000_000  # pixels that are placed at a time


@dataclass(frozen=True, eq=False)
class Picture:
    """A map; row 0 is the lowest. origin: x y [m] of its lower left corner."""

    resolution: float  # [m] a pixel
    yaw: float  # by which it is turned about z [rad]
    occupied: np.ndarray  # (h, w) bool
    free: np.ndarray  # (h, w) bool
    origin: tuple[float, float] = (0.0, 0.0)

    def points(self, mask: np.ndarray, every: int = 1) -> Iterator[np.ndarray]:
        """Yields x y (n, 2) [m] of the mask's pixels, in parts; only each `every`-th."""
        chosen = np.flatnonzero(mask)[::every]
        for i in range(0, len(chosen), CHUNK):
            rows, columns = np.divmod(chosen[i : i + CHUNK], mask.shape[1])
            points = (np.column_stack([columns, rows]) + 0.5) * self.resolution
            yield straight.turned(points, self.yaw)


def floor_of(
    path: PathName, picture: Picture, angle: float, spacing: float
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the floor (h, w) of characters that a picture makes, turned by an angle [rad] about
    the origin of its frame, and x y [m] of the centre of its cell (0, 0) in that frame.

    `spacing` is the edge of a cell [m]; the picture has a free pixel. Raises FormatError for a
    floor that is too large; `path` is that of the file.
    """
    return _Cells(path, picture, angle, spacing).floor()


class _Cells:
    def __init__(self, path: PathName, picture: Picture, angle: float, spacing: float) -> None:
        self._picture, self._angle, self._spacing = picture, angle, spacing
        # Pixels larger than half a cell are subdivided, so that no cell is missed.
        self._parts = math.ceil(2 * picture.resolution / spacing - 1e-9)
        self._in_a_cell = (spacing / picture.resolution * self._parts) ** 2  # parts of pixels
        self._low, (width, height) = self._extent()
        self._shape = height, width
        check_size(path, "a map", height, width)

    def floor(self) -> tuple[np.ndarray, np.ndarray]:
        origin = straight.turned(np.array([self._picture.origin]), self._angle)[0]
        # Centres on the grid of a world, on which robots stop, keep the poses of the map.
        corner = self._low + self._spacing
        if self._parts == 1:
            corner = self._best_corner(
                corner - (corner + origin + self._spacing / 2) % self._spacing
            )
        return self._drawn(corner, 1), corner + origin + self._spacing / 2

    def _extent(self) -> tuple[np.ndarray, tuple[int, int]]:
        """Returns the lower corner [m] of what is known, and the cells along x and y."""
        known = self._picture.free | self._picture.occupied
        rows, columns = (np.flatnonzero(known.any(axis=axis)) for axis in (1, 0))
        box = [[c, r] for c in columns[[0, -1]] + (0, 1) for r in rows[[0, -1]] + (0, 1)]
        corners = np.array(box) * self._picture.resolution
        corners = straight.turned(corners, self._picture.yaw + self._angle)
        low = corners.min(axis=0) - self._spacing
        width, height = np.ceil((corners.max(axis=0) - low) / self._spacing - 1e-9).astype(int) + 1
        return low, (int(width), int(height))

    def _best_corner(self, on_grid: np.ndarray) -> np.ndarray:
        """Returns the corner [m] from which cells have most floor: their edges cut few walls.

        That is `on_grid` where it has nearly as much.
        """
        every = int(np.count_nonzero(self._picture.free) // SAMPLE)
        every = max(1, min(every, int(self._in_a_cell / 8)))
        phases = max(1, min(PHASES, round(self._spacing / self._picture.resolution)))
        corner = self._low
        for axis in np.eye(2):
            tried = [corner + self._spacing * i / phases * axis for i in range(phases)]
            corner = max(tried, key=lambda candidate: self._free_cells(candidate, every))
        fine = self._free_cells(on_grid, every) >= NEARLY * self._free_cells(corner, every)
        return on_grid if fine else corner

    def _free_cells(self, corner: np.ndarray, every: int) -> int:
        return np.count_nonzero(self._drawn(corner, every) == lf.FLOOR)

    def _drawn(self, corner: np.ndarray, every: int) -> np.ndarray:
        """Returns the floor of cells from a corner on; counts each `every`-th free pixel."""
        floor = np.full(self._shape, lf.NO_FLOOR, "<U1")
        free = self._counts(self._picture.free, corner, every)
        floor[free * every >= SEEN * self._in_a_cell] = lf.FLOOR
        walls = self._counts(self._picture.occupied, corner, 1)
        share = min(WALL * self._picture.resolution / self._spacing, MOST)
        floor[walls >= max(1, share * self._in_a_cell)] = lf.WALL
        return floor

    def _counts(self, mask: np.ndarray, corner: np.ndarray, every: int) -> np.ndarray:
        """Returns how many parts of the mask's pixels lie in each cell, (h, w)."""
        height, width = self._shape
        out = np.zeros(height * width, np.int64)
        for points in self._picture.points(mask, every):
            turned = straight.turned(points, self._angle)
            for shift in self._shifts():
                x, y = np.floor((turned + shift - corner) / self._spacing).astype(np.int64).T
                inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
                out += np.bincount((y * width + x)[inside], minlength=len(out))
        return out.reshape(self._shape)

    def _shifts(self) -> np.ndarray:
        """Returns the centres of the parts of a pixel about its own, (parts², 2) [m]."""
        along = (np.arange(self._parts) + 0.5) / self._parts - 0.5
        pairs = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
        return straight.turned(pairs * self._picture.resolution, self._picture.yaw + self._angle)
