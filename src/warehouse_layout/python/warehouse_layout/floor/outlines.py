# SPDX-License-Identifier: Apache-2.0
"""Outlines on a floor, many at once, in cells: a cell's centre is (column, row)."""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from warehouse_layout.floor.stations import STEPS

Rectangle = tuple[int, int, int, int]  # first x, first y, last x, last y in cells

# Outlines about (0, 0), towards +x.
ARROW = np.array([(-1, -0.2), (0.1, -0.2), (0.1, -0.6), (1, 0), (0.1, 0.6), (0.1, 0.2), (-1, 0.2)])
BOTH_WAYS = np.array(
    [(-1, 0), (-0.4, -0.6), (-0.4, -0.2), (0.4, -0.2), (0.4, -0.6)]
    + [(1, 0), (0.4, 0.6), (0.4, 0.2), (-0.4, 0.2), (-0.4, 0.6)]
)
SQUARE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
BOLT = np.array([(0.2, 1), (-0.6, -0.15), (-0.05, -0.15), (-0.2, -1), (0.6, 0.15), (0.05, 0.15)])
DISC = np.array([(np.cos(a), np.sin(a)) for a in np.arange(24) * np.pi / 12])
UP_DOWN = np.array(  # which way an elevator goes
    [(0, 1), (0.6, 0.35), (0.2, 0.35), (0.2, -0.35), (0.6, -0.35), (0, -1)]
    + [(-0.6, -0.35), (-0.2, -0.35), (-0.2, 0.35), (-0.6, 0.35)]
)
TIP = np.array([(0.75, 0), (-0.25, 0.5), (-0.05, 0), (-0.25, -0.5)])  # which way a robot looks


def placed(outline: np.ndarray, at: np.ndarray, size: float = 1.0, yaw: Any = 0.0) -> np.ndarray:
    """Returns an outline at each of the points (n, 2), turned by yaw [rad], (n, corners, 2)."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    turn = np.moveaxis(np.array([[cos, -sin], [sin, cos]]), (0, 1), (-2, -1))
    return np.reshape(at, (-1, 1, 2)) + size * (outline @ np.swapaxes(turn, -1, -2))


def rectangles(mask: np.ndarray) -> list[Rectangle]:
    """Returns Rectangles that cover the cells of a mask (h, w)."""
    left = mask.copy()
    out: list[Rectangle] = []
    for y, x in np.argwhere(mask).tolist():
        if not left[y, x]:
            continue
        stop = x + int(np.argmin(np.append(left[y, x:], False)))
        low = y + 1
        while low < len(left) and left[low, x:stop].all():
            low += 1
        left[y:low, x:stop] = False
        out.append((x, y, stop - 1, low - 1))
    return out


def boxes(mask: np.ndarray, inset: float = 0.0) -> np.ndarray:
    """Returns the outlines of rectangles that cover the cells of a mask (h, w), (n, 4, 2).

    With an inset each cell has a rectangle of its own, that much smaller at each side.
    """
    if inset:
        return placed(SQUARE, np.argwhere(mask)[:, ::-1], 0.5 - inset)
    corners = np.reshape(rectangles(mask), (-1, 4)) + np.array([-0.5, -0.5, 0.5, 0.5])
    return corners[:, [[0, 1], [2, 1], [2, 3], [0, 3]]]


def stripes(mask: np.ndarray) -> np.ndarray:
    """Returns a slanting stroke in each cell of a mask (h, w), (n, 4, 2)."""
    stroke = np.array([(-0.5, -0.5), (-0.36, -0.5), (0.5, 0.36), (0.5, 0.5)])
    return placed(stroke, np.argwhere(mask)[:, ::-1], 1.0)


def thinned(mask: np.ndarray, tile: int) -> np.ndarray:
    """Returns cells (n, 2) of a mask, at most one in each square of `tile` by `tile` cells."""
    rows, columns = np.nonzero(mask)
    across = mask.shape[1] // tile + 1
    _, first = np.unique(rows // tile * across + columns // tile, return_index=True)
    return np.column_stack([columns, rows])[first]


def borders(mask: np.ndarray) -> np.ndarray:
    """Returns the segments (n, 2, 2) between the cells of a mask (h, w) and all others."""
    return np.concatenate([*_segments(mask, 0), *_segments(mask.T, 1)] or [np.zeros((0, 2, 2))])


def _segments(mask: np.ndarray, axis: int) -> Iterator[np.ndarray]:
    """Yields the segments along x; those of a transposed mask are turned back."""
    padded = np.pad(mask, 1)
    change = padded[1:] != padded[:-1]
    edges = np.diff(change.astype(np.int8), axis=1)
    starts, stops = np.argwhere(edges == 1), np.argwhere(edges == -1)
    if len(starts):
        y = starts[:, 0] - 0.5
        ends = np.stack([starts[:, 1] - 0.5, y, stops[:, 1] - 0.5, y], axis=1).reshape(-1, 2, 2)
        yield ends[..., ::-1] if axis else ends


def heading(begin: Iterable[int], end: Iterable[int]) -> float:
    """Returns the direction [rad] from a cell to the next."""
    (ax, ay), (bx, by) = begin, end
    return STEPS.index((bx - ax, by - ay)) * np.pi / 2
