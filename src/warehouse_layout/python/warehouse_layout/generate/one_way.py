# SPDX-License-Identifier: Apache-2.0
"""The stations of a regular layout, with lanes that fit its one-way streets."""

import math
from collections.abc import Iterator

import numpy as np

from warehouse_layout.floor.stations import PICK, REPLENISH, Station
from warehouse_layout.generate.blocks import Shape

PICKS_TO_REPLENISH = 2  # stations of the one kind for each of the other


def drops(shape: Shape) -> np.ndarray:
    """Returns the service cells x y before belts, (n, 2), evenly spread over the rows.

    Their queues continue streets.
    """
    rows = _spread(shape.picks, shape.rows)
    x = np.full(shape.picks, shape.street_x[-1] + shape.queue)
    return np.column_stack([x, shape.street_y[rows] + 1]).astype(float)


def stations(shape: Shape) -> list[Station]:
    """Returns all stations of a shape, those to pick first."""
    return [*_picks(shape), *_replenishments(shape)]


def _spread(count: int, of: int) -> np.ndarray:
    """Returns `count` of the numbers below `of`, evenly spread."""
    return ((np.arange(count) + 0.5) * of / max(count, 1)).astype(int)


def _picks(shape: Shape) -> Iterator[Station]:
    """Yields stations whose lanes lead along a row, past the belt and back to the street."""
    width = shape.cells[0]
    x = int(shape.street_x[-1]) + 1 + np.arange(shape.queue)
    for i, y in enumerate(drops(shape)[:, 1].astype(int), start=1):
        lane = np.r_[(y - 1) * width + x, y * width + x[-1], (y + 1) * width + x[::-1]]
        yield Station(f"pick{i}", PICK, lane.astype(np.int32), shape.queue, f"conveyor_belt{i}")


def _replenishments(shape: Shape) -> Iterator[Station]:
    """Yields stations whose lanes lead along a column and back, towards lower x."""
    width = shape.cells[0]
    y = int(shape.street_y[-1]) + 1 + np.arange(shape.queue)
    right = int(shape.street_x[-1])
    # Lanes are three cells wide; as long as there is room, they don't touch.
    count = min(math.ceil(shape.picks / PICKS_TO_REPLENISH), max(1, (right - 1) // 3))
    for i, x in enumerate(2 + _spread(count, right - 1), start=1):
        lane = np.r_[y * width + x, y[-1] * width + x - 1, y[::-1] * width + x - 2]
        yield Station(f"replenish{i}", REPLENISH, lane.astype(np.int32), shape.queue)
