# SPDX-License-Identifier: Apache-2.0
"""Generates layout files of regular warehouses: the presets, and others by their counts."""

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import Cell, LayoutFile, StationEntry
from warehouse_layout.file.request import Request
from warehouse_layout.floor.stations import PICK, Station
from warehouse_layout.place import layout as regular
from warehouse_layout.place import one_way
from warehouse_layout.place.blocks import (
    Shape,
    mask_of,
    parking_cells,
    places_for,
    shapes,
    storage_cells,
)


def of_request(request: Request, name: str = "") -> LayoutFile:
    """Returns the file of the warehouse that layout.plan() lays out for a Request."""
    shape = min(shapes(request), key=Shape.cost)
    stations = one_way.stations(shape)
    robots, _ = regular.parked(request.robots, shape)
    return LayoutFile(
        floor=_drawing(request, shape, stations),
        name=name,
        stations=tuple(_entry(station, shape.cells[0]) for station in stations),
        storage_units=request.shelves,
        # Storage blocks have spare places, where robots may park later but do not begin.
        robots=tuple((int(x), int(y)) for x, y in robots),
        items=request.items,
    )


def _drawing(request: Request, shape: Shape, stations: list[Station]) -> np.ndarray:
    width, height = shape.cells
    floor = np.full((height, width), lf.NO_FLOOR, "<U1")
    right, top = int(shape.street_x[-1]), int(shape.street_y[-1])
    _draw_streets(floor, shape)
    places = regular.some(storage_cells(shape), places_for(request.shelves))
    floor[mask_of(parking_cells(shape), shape)] = lf.PARKING
    floor[mask_of(storage_cells(shape), shape)] = lf.PARKING
    floor[mask_of(places, shape)] = lf.STORAGE
    floor[mask_of(regular.charging(request.robots, shape), shape)] = lf.CHARGING
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
