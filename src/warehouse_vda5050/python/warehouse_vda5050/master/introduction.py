# SPDX-License-Identifier: Apache-2.0
"""What a factsheet says to a person: what the vehicle can, and what does not fit this warehouse."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from warehouse_vda5050.master.abilities import Abilities
from warehouse_vda5050.master.commands import RefusedError
from warehouse_vda5050.master.seen import SeenVehicle
from warehouse_vda5050.model import Factsheet, LoadSet

PLANNED_SPEED = 1.5  # with which plans reckon where nothing else was measured [m/s]
SENT = ("cancelOrder", "startPause", "stopPause", "stateRequest")  # at once, by the master
UNKNOWN = Factsheet()


def abilities(sheet: Factsheet) -> Iterator[str]:
    """Yields what a vehicle can, in sentences."""
    names = [word for word in (sheet.series, sheet.vehicle_class, sheet.kinematics) if word]
    if names:
        yield ", ".join(names)
    yield f"it is {sheet.length:g} m long, {sheet.width:g} m wide and {sheet.height:g} m high"
    yield f"it drives at up to {sheet.max_speed:g} m/s"
    if sheet.max_load_mass:
        yield f"it carries up to {sheet.max_load_mass:g} kg"
    for loads in sheet.load_sets:
        yield _of_loads(loads)
    nodes = [action.type for action in sheet.actions if "NODE" in action.scopes]
    if nodes:
        yield f"actions at nodes: {', '.join(nodes)}"


def _of_loads(loads: LoadSet) -> str:
    parts = [f"loadType {loads.load_type}"]
    if loads.length and loads.width:
        parts.append(f"{loads.length:g} x {loads.width:g} m")
    if loads.max_mass is not None:
        parts.append(f"up to {loads.max_mass:g} kg")
    return f"load set '{loads.name}': {', '.join(parts)}"


def too_large(sheet: Factsheet | None, spacing: float) -> str:
    """Returns why a vehicle can't drive on cells of that edge [m], '' if it can."""
    longest = max(sheet.length, sheet.width) if sheet else 0.0
    if longest <= spacing:
        return ""
    return (
        f"it is {longest:g} m long, and a cell {spacing:g} m: it would reach into the cell beside"
    )


def misfits(vehicle: SeenVehicle, parameters: Mapping[str, Any], spacing: float) -> Iterator[str]:
    """Yields what does not fit this warehouse, in sentences; `parameters` are its
    action_parameters."""
    sheet = vehicle.sheet
    if vehicle.fault:
        yield f"its factsheet can't be read: {vehicle.fault}"
    if sheet is None:
        yield assumed(spacing)
        return
    yield from (f"its factsheet is invalid: {fault}" for fault in sheet.faults)
    if why := too_large(sheet, spacing):
        yield why
    elif math.hypot(sheet.length, sheet.width) > spacing:
        across = math.hypot(sheet.length, sheet.width)
        yield f"it needs {across:.2f} m to turn, more than a cell: it reaches into those beside"
    if sheet.max_speed < PLANNED_SPEED:
        yield f"plans reckon with {PLANNED_SPEED:g} m/s: robots behind it wait"
    yield from _lacking(Abilities(parameters, sheet))
    known = {action.type for action in sheet.actions}
    for kind in SENT if known else ():
        if kind not in known:
            yield f"its factsheet has no {kind}: it may not obey that"


def _lacking(able: Abilities) -> Iterator[str]:
    for kind in ("pick", "drop"):
        try:
            able.action(kind, "", 0, None)
        except RefusedError as refusal:
            yield f"no unit is given to it: {refusal}"
    try:
        able.check_path()
    except RefusedError as refusal:
        yield str(refusal)


def assumed(spacing: float) -> str:
    """Returns what holds of a vehicle without a factsheet."""
    sheet = UNKNOWN
    fits = "fits into" if max(sheet.length, sheet.width) <= spacing else "is larger than"
    return (
        f"it has sent no factsheet: that it {fits} a cell, picks up and drops any unit, and takes"
        f" orders of up to {sheet.max_nodes} nodes is assumed"
    )
