# SPDX-License-Identifier: Apache-2.0
"""The boxes that make up the walls of a drawing."""

from collections.abc import Iterable

import numpy as np

from warehouse_layout.floor.outlines import Rectangle, rectangles

TURNING = 0.58  # [m]: from the middle of a cell; as far as the corners of a turning unit reach


def boxes(walls: np.ndarray, spacing: float) -> np.ndarray:
    """Returns x y size_x size_y of boxes for the cells of walls (h, w) bool, (n, 4) [m].

    x and y are from the centre of cell (0, 0). Walls keep away from their cells' edges, so that a
    storage unit can be turned in the cell beside them; boxes overlap where they join.
    """
    whole = rectangles(walls)
    joints = [*_runs(walls), *(_turned(run) for run in _runs(walls.T)), *_blocks(walls)]
    parts = {*whole, *_across(joints, whole, walls.shape)}
    low, high = np.reshape(sorted(parts), (-1, 2, 2)).astype(float).transpose(1, 0, 2)
    size = (high - low + 1) * spacing - 2 * max(TURNING - spacing / 2, 0.0)
    return np.column_stack([(low + high) / 2 * spacing, size])


def _across(
    joints: Iterable[Rectangle], whole: list[Rectangle], shape: tuple[int, ...]
) -> Iterable[Rectangle]:
    """Yields what joins rectangles, which cover all walls: not what lies within one."""
    part = np.zeros(shape, np.int32)
    for i, (x, y, last_x, last_y) in enumerate(whole):
        part[y : last_y + 1, x : last_x + 1] = i
    for x, y, last_x, last_y in joints:
        if (part[y : last_y + 1, x : last_x + 1] != part[y, x]).any():
            yield x, y, last_x, last_y


def _runs(walls: np.ndarray) -> Iterable[Rectangle]:
    """Yields the runs of walls along x; those of one cell are in rectangles() or run along y."""
    edges = np.diff(np.pad(walls, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    for (row, first), (_, after) in zip(np.argwhere(edges == 1), np.argwhere(edges == -1)):
        if after - first > 1:
            yield int(first), int(row), int(after) - 1, int(row)


def _blocks(walls: np.ndarray) -> Iterable[Rectangle]:
    """Yields rectangles with all squares of four cells: runs would leave holes in their middles."""
    pairs = walls[1:] & walls[:-1]
    for x, y, last_x, last_y in rectangles(pairs[:, 1:] & pairs[:, :-1]):
        yield x, y, last_x + 1, last_y + 1


def _turned(rectangle: Rectangle) -> Rectangle:
    x, y, last_x, last_y = rectangle
    return y, x, last_y, last_x
