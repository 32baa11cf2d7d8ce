# SPDX-License-Identifier: Apache-2.0
"""Masks of cells: (nx, ny) bool arrays, and the sets of cells that they stand for."""

import numpy as np

from warehouse_layout.floor.stations import STEPS


def beside_of(mask: np.ndarray) -> np.ndarray:
    """Returns the cells that have one of the mask's at one of their four sides."""
    out = np.zeros_like(mask)
    out[1:] |= mask[:-1]
    out[:-1] |= mask[1:]
    out[:, 1:] |= mask[:, :-1]
    out[:, :-1] |= mask[:, 1:]
    return out


def grown(mask: np.ndarray) -> np.ndarray:
    """Returns the mask's cells and the four around each."""
    return mask | beside_of(mask)


def shifted(mask: np.ndarray, step: tuple[int, int]) -> np.ndarray:
    """Returns the mask moved by `step` cells along x and y; cells that leave the array are lost."""
    moved = np.zeros_like(mask)
    (dx, dy), (nx, ny) = step, mask.shape
    moved[max(dx, 0) : nx + min(dx, 0), max(dy, 0) : ny + min(dy, 0)] = mask[
        max(-dx, 0) : nx + min(-dx, 0), max(-dy, 0) : ny + min(-dy, 0)
    ]
    return moved


def squares(free: np.ndarray, side: int) -> np.ndarray:
    """Returns where a square of `side` x `side` cells is free, by its lowest cell: a mask of
    (nx - side + 1, ny - side + 1)."""
    nx, ny = (max(size - side + 1, 0) for size in free.shape)
    fits = np.ones((nx, ny), bool)
    for i, j in np.ndindex(side, side):
        fits &= free[i : nx + i, j : ny + j]
    return fits


def covered(fits: np.ndarray, side: int) -> np.ndarray:
    """Returns the cells of squares of `side` x `side` cells, given their lowest cells."""
    nx, ny = fits.shape
    out = np.zeros((nx + side - 1, ny + side - 1), bool)
    for i, j in np.ndindex(side, side):
        out[i : nx + i, j : ny + j] |= fits
    return out


def parts(mask: np.ndarray) -> list[np.ndarray]:
    """Returns a mask for each part of this one that is connected side by side."""
    labels = labelled(mask)
    return [labels == number for number in np.unique(labels[labels >= 0])]


def labelled(mask: np.ndarray) -> np.ndarray:
    """Returns the number of the connected part that each cell is in, (nx, ny) int; -1 outside.

    Runs along y are joined with the runs beside them that they touch.
    """
    labels = np.full(mask.shape, -1)
    parent: list[int] = []
    before: list[tuple[int, int, int]] = []

    def root(run: int) -> int:
        while parent[run] != run:
            parent[run] = parent[parent[run]]
            run = parent[run]
        return run

    for i, column in enumerate(mask):
        edges = np.flatnonzero(np.diff(np.r_[False, column, False].astype(np.int8))).tolist()
        runs = []
        for start, stop in zip(edges[::2], edges[1::2]):
            number = len(parent)
            parent.append(number)
            labels[i, start:stop] = number
            for other_start, other_stop, other in before:
                if other_start < stop and start < other_stop:
                    parent[root(number)] = root(other)
            runs.append((start, stop, number))
        before = runs
    roots = np.array([root(run) for run in range(len(parent))] + [-1])
    return roots[labels]


def largest_part(mask: np.ndarray) -> np.ndarray:
    """Returns the mask of the largest part that is connected side by side."""
    left = {tuple(cell) for cell in np.argwhere(mask).tolist()}
    largest: list[tuple[int, ...]] = []
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
