# SPDX-License-Identifier: Apache-2.0
"""Reads instances of RAWSim-O, `.xinst`, as layout files."""

from functools import partial

import numpy as np

from warehouse_layout.convert import arrows
from warehouse_layout.convert.common import (
    PathName,
    cells_of,
    cells_of_short_cuts,
    named,
    on_grid,
    with_letters,
)
from warehouse_layout.convert.rawsim import stations as rawsim_stations
from warehouse_layout.convert.rawsim.instance import Instance, read_floor
from warehouse_layout.convert.rawsim.xml_fields import InstanceError, number_of
from warehouse_layout.file import items as shelves
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import Cell, ElevatorEntry, LayoutFile, StationEntry
from warehouse_layout.file.layout_reader import LEAST_SPACING, MOST_SPACING
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import PICK, Station

BIN = 100.0  # of a pod's capacity, which one item stands for


def read(path: PathName) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of an .xinst file, and what it can't hold. Raises FormatError."""
    instance = read_floor(path)
    plan = instance.plan
    if not LEAST_SPACING <= plan.spacing <= MOST_SPACING:
        raise InstanceError(
            f"{path}: Waypoints are {plan.spacing:g} m apart; {LEAST_SPACING} to"
            f" {MOST_SPACING:g} m were expected"
        )
    floor = np.full(plan.shape, lf.NO_FLOOR, "<U1")
    floor[plan.passable] = lf.FLOOR
    floor[plan.storage] = lf.STORAGE
    floor, notes = arrows.draw(plan, floor)
    file = LayoutFile(
        floor=floor,
        name=instance.name,
        spacing=round(plan.spacing, 4),
        stations=tuple(_entry(path, instance, station) for station in plan.stations),
        elevators=tuple(
            ElevatorEntry.of_elevator(elevator, plan.width) for elevator in plan.elevators
        ),
        storage_units=_cells(instance.units.values(), plan),
        robots=_cells(instance.robots.values(), plan),
        items=_items(path, instance),
        at=on_grid(np.array(plan.origin), plan.spacing),
    )
    return with_letters(file), [*notes, *_unsaid(path, instance)]


def _cells(numbers: object, plan: FloorPlan) -> tuple[Cell, ...]:
    rows, columns = np.divmod(np.array(list(numbers), int), plan.width)  # type: ignore[call-overload]
    return tuple(zip(columns.tolist(), rows.tolist()))


def _entry(path: PathName, instance: Instance, station: Station) -> StationEntry:
    cells = _cells(station.cells, instance.plan)
    element = instance.elements[station.name]
    is_pick = station.kind == PICK
    return StationEntry(
        key=station.name,
        service=cells[station.service],
        name=station.name,
        kind="pick" if is_pick else "replenish",
        queue=cells[: station.service],
        short_cuts=cells_of_short_cuts(station, instance.plan.width),
        exit=cells[station.service + 1 :],
        settings=rawsim_stations.settings(partial(number_of, path, element), {}) if is_pick else {},
    )


def _items(path: PathName, instance: Instance) -> int:
    """Returns the count of items in the pods, a bin each; at most the places of our units."""
    held = [round(number_of(path, pod, "Capacity", 5 * BIN) / BIN) for pod in instance.pods]
    return sum(min(max(1, count), shelves.CAPACITY) for count in held)


def _unsaid(path: PathName, instance: Instance) -> list[str]:
    short = cells_of((instance.paths & ~instance.plan.exits) != 0)
    out = (
        [f"a lane has one way out, and ways in from streets; others end at {named(short)}"]
        if short
        else []
    )
    for station in instance.plan.stations:
        missing = [
            part
            for part, there in (
                ("queue", station.service),
                ("exit", station.service < len(station.cells) - 1),
            )
            if not there
        ]
        if missing:
            out.append(f"station {station.name} has no {' and no '.join(missing)} of its own")
        element = instance.elements[station.name]
        bundle = number_of(path, element, "ItemBundleTransferTime", rawsim_stations.BUNDLE)
        if bundle != rawsim_stations.BUNDLE:
            out.append(f"station {station.name}: a layout does not hold {bundle:g} s a bundle")
    for bot in instance.bots[:1]:
        out += rawsim_stations.unlike_ours(partial(number_of, path, bot))
    return out
