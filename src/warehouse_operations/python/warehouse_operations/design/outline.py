# SPDX-License-Identifier: Apache-2.0
"""Floors that follow the outline of a building, whatever it is: two-way streets over all of it,
stations with lanes in the middle of the storage, and places nearest to them."""

from dataclasses import replace

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
BELT_CELLS = 2


def filled(
    building: Building, request: Request, replenish: int, pick_kind: str, shift: int
) -> LayoutFile | None:
    """Returns a building that is filled so; None where there is too little room for it.

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
    """Returns the building with the streets, places and stations of a site; None: too few places."""
    places = places_for(request.shelves)
    if len(site.places) < places + request.robots:
        return None
    floor = building.file.floor.copy()
    floor[building.free] = lf.KEEP_OUT
    low = ground.low
    floor[tuple((np.argwhere(site.streets) + low).T[::-1])] = lf.FLOOR
    at = site.places + low
    storage, parking = np.split(at[: places + request.robots], [places])
    floor[tuple(storage.T[::-1])] = lf.STORAGE
    floor[tuple(parking.T[::-1])] = lf.PARKING
    charging = parking[: round(CHARGED * request.robots + 0.5)]
    floor[tuple(charging.T[::-1])] = lf.CHARGING
    stations = []
    for number, lane in enumerate(site.lanes):
        cells = [(int(x + low[0]), int(y + low[1])) for x, y in lane]
        middle = len(cells) // 2
        is_pick = number < len(site.drops)
        for x, y in cells:
            floor[y, x] = lf.FLOOR
        if is_pick:
            x, y = cells[middle]
            dx, dy = STEPS[site.headings[number]]
            for i in range(1, BELT_CELLS + 1):
                floor[y + i * dy, x + i * dx] = lf.BELT
        name = f"pick{number + 1}" if is_pick else f"replenish{number + 1 - len(site.drops)}"
        stations.append(
            StationEntry(
                key=name,
                name=name,
                kind=pick_kind if is_pick else "replenish",
                service=cells[middle],
                queue=tuple(cells[:middle]),
                exit=tuple(cells[middle + 1 :]),
            )
        )
    return replace(
        building.file,
        floor=floor,
        stations=(*building.file.stations, *stations),
        storage_units=request.shelves,
        robots=request.robots,
        items=0 if building.file.stock else request.items,
    )
