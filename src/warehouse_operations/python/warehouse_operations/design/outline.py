# SPDX-License-Identifier: Apache-2.0
"""Floors that follow any outline of a building: two-way streets over all of it, stations with lanes
in the middle of the storage, and places nearest to them."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile, StationEntry
from warehouse_layout.file.request import Request, RequestError
from warehouse_layout.floor.stations import STEPS
from warehouse_layout.generate import rooms, sites
from warehouse_layout.generate.blocks import places_for
from warehouse_layout.generate.cells import Cells
from warehouse_layout.generate.generator import CHARGED
from warehouse_layout.generate.sites import Ground, Site
from warehouse_layout.place import file_check
from warehouse_operations.design.building import Building

SHIFTS = len(sites.SHIFTS)  # ways to lay the streets over a building
BELT = range(2)  # cells behind a service cell


def filled(
    building: Building, request: Request, replenish: int, pick_kind: str, shift: int
) -> LayoutFile | None:
    """Returns a building filled in this way; None where it has too little room.

    shift: of the pattern of streets, below SHIFTS. pick_kind: of the picking stations.
    """
    cells = Cells(0, 0, ~building.free.T)
    try:
        ground = Ground(cells, rooms.choose(cells))
    except RequestError:
        return None
    ground.shifts = [sites.SHIFTS[shift]]
    for site in sites.with_lanes(ground, request.belts, replenish):
        file = _drawn(building, ground, site, request, pick_kind)
        if file is not None and not file_check.faults(file):
            return file
    return None


def _drawn(
    building: Building, ground: Ground, site: Site, request: Request, pick_kind: str
) -> LayoutFile | None:
    """Returns the building with streets, places and stations of a site; None: too few places."""
    places = places_for(request.shelves)
    if len(site.places) < places + request.robots:
        return None
    floor = building.file.floor.copy()
    floor[building.free] = lf.KEEP_OUT
    storage, parking = np.split(site.places[: places + request.robots] + ground.low, [places])
    charging = parking[: math.ceil(CHARGED * request.robots - 1e-9)]
    _draw(floor, np.argwhere(site.streets) + ground.low, lf.FLOOR)
    _draw(floor, storage, lf.STORAGE)
    _draw(floor, parking, lf.PARKING)
    _draw(floor, charging, lf.CHARGING)
    stations = tuple(_stations(site, ground, pick_kind))
    for station in stations:
        _draw(floor, [*station.queue, station.service, *station.exit], lf.FLOOR)
    for station, heading in zip(stations, site.headings):
        belt = [np.add(station.service, (i + 1) * np.array(STEPS[heading])) for i in BELT]
        _draw(floor, belt, lf.BELT)
    return replace(
        building.file,
        floor=floor,
        stations=(*building.file.stations, *stations),
        storage_units=request.shelves,
        robots=request.robots,
        items=0 if building.file.stock else request.items,
    )


def _draw(floor: np.ndarray, cells: np.ndarray | Sequence[Any], character: str) -> None:
    """Draws a character in cells x y, (n, 2)."""
    x, y = np.reshape(cells, (-1, 2)).astype(int).T
    floor[y, x] = character


def _stations(site: Site, ground: Ground, pick_kind: str) -> Iterator[StationEntry]:
    """Yields the stations of a site, the picking ones first."""
    picks = len(site.drops)
    for number, lane in enumerate(site.lanes):
        cells = [(int(x), int(y)) for x, y in np.add(lane, ground.low)]
        middle = len(cells) // 2
        is_pick = number < picks
        name = f"pick{number + 1}" if is_pick else f"replenish{number + 1 - picks}"
        yield StationEntry(
            key=name,
            name=name,
            kind=pick_kind if is_pick else "replenish",
            service=cells[middle],
            queue=tuple(cells[:middle]),
            exit=tuple(cells[middle + 1 :]),
        )
