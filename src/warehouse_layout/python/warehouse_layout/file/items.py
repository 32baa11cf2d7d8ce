# SPDX-License-Identifier: Apache-2.0
"""Where items lie in their storage units."""

import xml.etree.ElementTree as ElementTree

import numpy as np

from warehouse_layout.file import files


def _boards() -> np.ndarray:
    """Returns the heights of the boards' upper faces in a storage unit [m], from its model."""
    visuals = ElementTree.parse(files.model("storage_unit")).iter("visual")
    boards = [v for v in visuals if v.get("name", "").startswith("board")]
    z = [float(v.findtext("pose", "").split()[2]) for v in boards]
    height = [float(v.findtext("geometry/box/size", "").split()[2]) for v in boards]
    return np.round(np.add(z, np.divide(height, 2)), 6)


BOARDS = _boards()

# Items measure 0.20 x 0.15 m; so placed they clear each other, the posts and the board's edge.
PLACES = np.array([(x, y) for y in (-0.27, -0.09, 0.09, 0.27) for x in (-0.24, 0.0, 0.24)])

CAPACITY = len(BOARDS) * len(PLACES)


def spread(
    items: int, units: int, rng: np.random.Generator | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Lays `items` items on `units` storage units as evenly as possible; by chance with an `rng`.

    Returns the unit of each item, (items,) indices, and its place in that unit's frame,
    (items, 3) [m]. At most CAPACITY items lie on a unit.
    """
    if not items:
        return np.zeros(0, int), np.zeros((0, 3))
    unit, layer = np.arange(items) % units, np.arange(items) // units
    if rng is None:
        board, place = _regular(unit, layer)
    else:
        slots = rng.random((units, CAPACITY)).argsort(axis=1)
        board, place = np.divmod(slots[unit, layer], len(PLACES))
        order = rng.permutation(items)
        unit, board, place = unit[order], board[order], place[order]
    return unit, np.column_stack([PLACES[place], BOARDS[board]])


def stacked(unit: np.ndarray) -> np.ndarray:
    """Returns the places of items on units `unit` (n,), one after the other on each, (n, 3) [m].

    They are in the frame of their unit, at most CAPACITY on each.
    """
    order = np.argsort(unit, kind="stable")
    first = np.searchsorted(unit[order], unit[order])
    layer = np.empty(len(unit), int)
    layer[order] = np.arange(len(unit)) - first
    board, place = _regular(unit, layer)
    return np.column_stack([PLACES[place], BOARDS[board]])


def _regular(unit: np.ndarray, layer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns board and place of a unit's first, second … item."""
    layer, board = np.divmod(layer, len(BOARDS))
    # 5 and 12 share no divisor: each board's places come once before any comes again, and not
    # in a row. The other terms only keep units and boards from looking alike.
    return board, (5 * layer + 3 * board + 7 * unit) % len(PLACES)
