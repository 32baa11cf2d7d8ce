# SPDX-License-Identifier: Apache-2.0
"""What is painted on the floor, as a page draws it: rectangles, arrows and stations."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.floor import floor_markings
from warehouse_layout.floor.floor_markings import HEADINGS, Mark
from warehouse_layout.floor.stations import EXIT, QUEUE

if TYPE_CHECKING:
    from warehouse_msgs.msg import Scenery

YAWS = dict(zip(HEADINGS, np.arange(4) * np.pi / 2, strict=True))
APART = 3  # from one arrow of a street to the next [cells]


def of_scenery(scenery: Scenery) -> dict[str, Any]:
    """Returns `paint`, the rectangles of each kind as x y and full extents in a row [m]; `arrows`,
    x y yaw in a row [m, rad], along one-way streets and lanes; and `stations`."""
    marks = floor_markings.readable(scenery)
    rectangles: dict[str, list[float]] = {}
    for m in marks:
        rectangles.setdefault(m.kind, []).extend(short([m.x, m.y, m.size_x, m.size_y]))
    rows = [*_along_streets(marks, scenery.grid_spacing), *_along_lanes(marks)]
    return {
        "paint": rectangles,
        "arrows": short(rows),
        "stations": [{"name": m.station, "x": m.x, "y": m.y} for m in floor_markings.served(marks)],
    }


def _along_streets(marks: Iterable[Mark], cell: float) -> Iterator[float]:
    """Yields an arrow on each third cell that may be left towards one side alone."""
    for m in marks:
        yaw = YAWS.get(m.label.removeprefix("exits"))
        if yaw is None or not m.label.startswith("exits"):
            continue
        for x in _cells(m.x, m.size_x, cell):
            for y in _cells(m.y, m.size_y, cell):
                if round((x + y) / cell) % APART == 0:
                    yield from (x, y, yaw)


def _cells(middle: float, extent: float, cell: float) -> np.ndarray:
    """Returns the middles of the cells that an extent covers [m]."""
    count = max(1, round(extent / cell))
    return middle + cell * (np.arange(count) - (count - 1) / 2)


def _along_lanes(marks: Iterable[Mark]) -> Iterator[float]:
    """Yields an arrow between cells of a queue, or of an exit, which come in driving order."""
    for a, b in pairwise(marks):
        if a.label == b.label and a.model == b.model and a.kind in (QUEUE, EXIT):
            yield from ((a.x + b.x) / 2, (a.y + b.y) / 2, np.arctan2(b.y - a.y, b.x - a.x))


def short(numbers: ArrayLike) -> list[Any]:
    """Returns numbers rounded to 0.1 mm: half the bytes."""
    return np.round(np.asarray(numbers, float), 4).tolist()
