# SPDX-License-Identifier: Apache-2.0
"""Generates layout files of regular warehouses: the presets, and others by their counts.

Seen from above, x to the right:

         x s q                      q  queue of a station, entered from the street beside it
         x   q                      s  its service cell, passed without turning
         x   q                      x  and the way back from there to the street
    ←─────────────────────────────
    ──────────────────────────────→ two streets or more along the stations, neighbours opposed
    │ pp │ uuuu │ uuuu │ uuuu │ │ x x x x
    │ pp │ uuuu │ uuuu │ uuuu │ │       s ==  PICK station before a conveyor belt
    ──────────────────────────────→ q q q q
    │ pp │ uuuu │ uuuu │ uuuu │ │
    │ pp │ uuuu │ uuuu │ uuuu │ │   pp  parked robots, each facing its street
    ──────────────────────────────  uu  blocks of storage places, two deep: each has a street

REPLENISH stations lie along y's upper edge. All but the belts' centres lies on whole metres.
Streets are one cell wide and one-way, neighbours opposed, and the outermost go round. A loaded
robot leaves any place's cell by the street before it; one without a load may pass beneath the
units as well, and cross streets.
"""

import math

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import Cell, LayoutFile, StationEntry
from warehouse_layout.file.request import Request
from warehouse_layout.floor.stations import PICK, Station
from warehouse_layout.generate import one_way
from warehouse_layout.generate.blocks import (
    Shape,
    mask_of,
    parking_cells,
    places_for,
    shapes,
    storage_cells,
)

CHARGED = 0.2  # places to charge at a robot


def of_request(
    request: Request, name: str = "", rng: np.random.Generator | None = None
) -> LayoutFile:
    """Returns the file of a regular warehouse; `rng` chooses where its robots park.

    Without `rng` the places nearest to the storage fill up first.
    """
    shape = min(shapes(request), key=Shape.cost)
    stations = one_way.stations(shape)
    return LayoutFile(
        floor=_drawing(request, shape, stations),
        name=name,
        stations=tuple(_entry(station, shape.cells[0]) for station in stations),
        storage_units=request.shelves,
        # Storage blocks have spare places, where robots may park later but do not begin.
        robots=tuple((int(x), int(y)) for x, y in _parked(request.robots, shape, rng)),
        items=request.items,
    )


def _drawing(request: Request, shape: Shape, stations: list[Station]) -> np.ndarray:
    width, height = shape.cells
    floor = np.full((height, width), lf.NO_FLOOR, "<U1")
    right, top = int(shape.street_x[-1]), int(shape.street_y[-1])
    _draw_streets(floor, shape)
    places = _last(storage_cells(shape), places_for(request.shelves))
    floor[mask_of(parking_cells(shape), shape)] = lf.PARKING
    floor[mask_of(storage_cells(shape), shape)] = lf.PARKING
    floor[mask_of(places, shape)] = lf.STORAGE
    floor[mask_of(_charging(request.robots, shape), shape)] = lf.CHARGING
    for station in stations:
        floor.flat[station.cells] = lf.FLOOR
        _open_exit(floor, station, right, top)
        if station.belt:
            row, column = divmod(station.service_cell, width)
            floor[row, column + 1 : column + 3] = lf.BELT
    return floor


def _open_exit(floor: np.ndarray, station: Station, right: int, top: int) -> None:
    """Lets robots that leave a lane choose between the two streets beside it."""
    row, column = divmod(int(station.cells[-1]), floor.shape[1])
    up, down = lf.ONE_WAY[1], lf.ONE_WAY[3]
    if station.kind == PICK:
        floor[row, right] = lf.FLOOR
    elif floor[top - 2, column] == up:
        floor[top - 1 : top + 1, column] = lf.FLOOR
    elif floor[top, column + 1] == down:
        floor[top - 1, column] = down  # a column's arrow beside it must lead into the street
    elif floor[top, column] != down:
        floor[top, column] = lf.FLOOR


def _draw_streets(floor: np.ndarray, shape: Shape) -> None:
    right, top = int(shape.street_x[-1]), int(shape.street_y[-1])
    rows = set(shape.street_y.tolist())
    for k, y in enumerate(shape.street_y):
        floor[y, : right + 1] = lf.ONE_WAY[2 * (k % 2)]
    for k, x in enumerate(shape.street_x[::-1]):
        step = -1 if x == 0 or k % 2 == 1 else 1
        for y in range(top + 1):
            # Where a column crosses a row, the row's arrow shows, unless another row follows.
            if y not in rows or y + step in rows:
                floor[y, x] = lf.ONE_WAY[1 if step > 0 else 3]


def _entry(station: Station, width: int) -> StationEntry:
    cells: list[Cell] = [(int(c) % width, int(c) // width) for c in station.cells]
    return StationEntry(
        key=station.name,
        service=cells[station.service],
        name=station.name,
        kind="pick" if station.kind == PICK else "replenish",
        queue=tuple(cells[: station.service]),
        exit=tuple(cells[station.service + 1 :]),
    )


def _parked(count: int, shape: Shape, rng: np.random.Generator | None) -> np.ndarray:
    """Returns the cells of parked robots, (count, 2) x y."""
    cells = parking_cells(shape)
    return _last(cells, count) if rng is None else rng.permutation(cells)[:count]


def _last(cells: np.ndarray, count: int) -> np.ndarray:
    """Returns the last `count` of the cells, row by row."""
    cells = cells[::-1][:count]
    return cells[np.lexsort((cells[:, 0], cells[:, 1]))]


def _charging(robots: int, shape: Shape) -> np.ndarray:
    """Returns the cells of parking where robots are charged, evenly spread, (n, 2)."""
    cells = parking_cells(shape)
    count = min(math.ceil(CHARGED * robots - 1e-9), len(cells))
    return cells[np.arange(count) * len(cells) // max(count, 1)]
