# SPDX-License-Identifier: Apache-2.0
"""Where two-way streets let robots pass each other: by another way round, or not at all."""

import numpy as np

from warehouse_layout.stations import STEPS


def without_dead_ends(streets):
    """(h, w) bool: of the cells of streets, the largest part in which two robots that meet can
    both go on. Dead ends are taken away, and single ways between two parts, on which no way round
    exists (bridges of the graph; found by chains of its depth-first tree, Schmidt 2013)."""
    cells = {tuple(cell) for cell in np.argwhere(streets).tolist()}
    parent, order = _depth_first(cells)
    rank = {cell: i for i, cell in enumerate(order)}
    joined, seen = {cell: [] for cell in order}, set()
    for cell in order:
        for near in _beside(cell, cells):
            if rank[near] <= rank[cell] or parent[near] == cell:
                continue  # each edge that is not in the tree once, from its upper end
            joined[cell].append(near)
            joined[near].append(cell)
            seen.add(cell)
            end = near
            while end not in seen:
                seen.add(end)
                joined[end].append(parent[end])
                joined[parent[end]].append(end)
                end = parent[end]
    out = np.zeros_like(streets)
    largest = max(_parts(joined), key=len, default=[])
    if len(largest) > 1:
        out[tuple(np.transpose(largest))] = True
    return out


def _beside(cell, cells):
    y, x = cell
    return [near for dx, dy in STEPS if (near := (y + dy, x + dx)) in cells]


def _depth_first(cells):
    """({cell: the one from which it was reached}, cells in the order in which they were)."""
    parent, order = {}, []
    for start in sorted(cells):
        stack = [(start, None)]
        while stack:
            cell, before = stack.pop()
            if cell in parent:
                continue
            parent[cell] = before
            order.append(cell)
            stack += [(near, cell) for near in _beside(cell, cells) if near not in parent]
    return parent, order


def _parts(joined):
    """Lists of cells that hang together."""
    left = set(joined)
    while left:
        part = [left.pop()]
        for cell in part:  # grows meanwhile
            for near in joined[cell]:
                if near in left:
                    left.remove(near)
                    part.append(near)
        yield part
