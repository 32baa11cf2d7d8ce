# SPDX-License-Identifier: Apache-2.0
"""Where two-way streets let robots pass each other: by another way round, or not at all."""

from collections.abc import Iterator

import numpy as np

from warehouse_layout.floor.stations import STEPS

Cell = tuple[int, ...]  # y, x


def without_dead_ends(streets: np.ndarray) -> np.ndarray:
    """Returns the largest part of the streets in which two robots that meet can pass.

    Both are (h, w) bool. Dead ends are taken away, and single ways between two parts, on which no
    way round exists: bridges of the graph, found by chains of its depth-first tree (Schmidt 2013).
    """
    cells = {tuple(cell) for cell in np.argwhere(streets).tolist()}
    parent, order = _depth_first(cells)
    rank = {cell: i for i, cell in enumerate(order)}
    joined: dict[Cell, list[Cell]] = {cell: [] for cell in order}
    passed: set[Cell] = set()
    for cell in order:
        for near in _beside(cell, cells):
            if rank[near] <= rank[cell] or parent[near] == cell:
                continue  # each edge that is not in the tree once, from its upper end
            joined[cell].append(near)
            joined[near].append(cell)
            passed.add(cell)
            end = near
            while end not in passed:
                passed.add(end)
                before = parent[end]
                assert before is not None, "only the root has none, and the chain began there"
                joined[end].append(before)
                joined[before].append(end)
                end = before
    out = np.zeros_like(streets)
    largest: list[Cell] = max(_parts(joined), key=len, default=[])
    if len(largest) > 1:
        out[tuple(np.transpose(largest))] = True
    return out


def _beside(cell: Cell, cells: set[Cell]) -> list[Cell]:
    y, x = cell
    return [near for dx, dy in STEPS if (near := (y + dy, x + dx)) in cells]


def _depth_first(cells: set[Cell]) -> tuple[dict[Cell, Cell | None], list[Cell]]:
    """Returns the cell from which each one was reached, and the cells in the order of the visit."""
    parent: dict[Cell, Cell | None] = {}
    order: list[Cell] = []
    for start in sorted(cells):
        stack: list[tuple[Cell, Cell | None]] = [(start, None)]
        while stack:
            cell, before = stack.pop()
            if cell in parent:
                continue
            parent[cell] = before
            order.append(cell)
            stack += [(near, cell) for near in _beside(cell, cells) if near not in parent]
    return parent, order


def _parts(joined: dict[Cell, list[Cell]]) -> Iterator[list[Cell]]:
    """Yields the cells of each connected part."""
    left = set(joined)
    while left:
        part = [left.pop()]
        for cell in part:  # grows meanwhile
            for near in joined[cell]:
                if near in left:
                    left.remove(near)
                    part.append(near)
        yield part
