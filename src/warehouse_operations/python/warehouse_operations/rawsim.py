# SPDX-License-Identifier: Apache-2.0
"""Reads instances (.xinst) and settings (.xsett) of RAWSim-O as a Site and a demand.

Waypoints become cells: their places are snapped to the rows and columns that they form, whatever
the spacing. A station's lane is its queue, from the far end to the station's own waypoint, and the
queue waypoints after it. Units and robots are numbered from 1, in the file's order.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from warehouse_fleet.kinematics import Kinematics
from warehouse_layout.floor_plan import FloorPlan
from warehouse_layout.stations import PICK, REPLENISH, STEPS, Station
from warehouse_operations.rawsim_grid import Grid, Waypoint, read_waypoints
from warehouse_operations.rawsim_xml import (
    InstanceError,
    PathName,
    children,
    number_of,
    read_root,
    text_of,
)
from warehouse_operations.settings import Settings
from warehouse_operations.site import Site

__all__ = ["InstanceError", "ShiftSettings", "read_instance", "read_settings"]

BIN = 100.0  # capacity of a pod that one bin stands for


@dataclass(frozen=True)
class ShiftSettings:
    """The part of a settings file that a shift uses; None: the file does not say."""

    orders: str = "fill"
    policies: dict[str, Any] = field(default_factory=dict)
    duration_s: float | None = None
    seed: int | None = None
    level: float | None = None  # of the first stock, over its room


def read_instance(path: PathName) -> Site:
    """Returns the Site of an .xinst file. Raises InstanceError."""
    root = read_root(path, "Instance")
    _single_tier(path, root)
    waypoints = read_waypoints(path, root)
    grid = Grid(path, waypoints)
    pods, bots = children(root, "Pods", "Pod"), children(root, "Bots", "Bot")
    stations, overrides = _stations(path, root, waypoints, grid)
    plan = _plan(path, waypoints, grid, stations)
    units = {i: grid.cell_at(pod, path) for i, pod in enumerate(pods, 1)}
    for pod, cell in zip(pods, units.values()):
        if not plan.storage.flat[cell]:
            raise InstanceError(f"{path}: Pod {pod.get('ID')} stands on no PodStorageLocation")
    _distinct(path, "Pod", pods, units)
    robots = {i: grid.cell_at(bot, path) for i, bot in enumerate(bots, 1)}
    _distinct(path, "Bot", bots, robots)
    items = [
        (f"item{unit}.{i + 1}", unit)
        for unit, pod in zip(units, pods)
        for i in range(max(1, round(number_of(path, pod, "Capacity", 500.0) / BIN)))
    ]
    return Site(
        plan,
        robots,
        units,
        items,
        root.get("Name") or Path(path).stem,
        _kinematics(path, bots),
        Settings(by_station=overrides),
    )


def read_settings(path: PathName) -> ShiftSettings:
    """Returns the ShiftSettings of an .xsett file. Raises InstanceError."""
    root = read_root(path, "SettingConfiguration")
    mode = root.findtext(".//OrderMode", "Fill")
    demand = root.find(".//DemandInventoryConfiguration")
    if mode not in ("Fill", "Poisson"):
        raise InstanceError(f"{path}: OrderMode is '{mode}'; Fill or Poisson was expected")
    orders = mode.lower()
    options: dict[str, Any] = {}
    if demand is not None:
        if mode == "Fill":
            orders = f"fill:{int(text_of(path, demand, 'OrderCount', 200))}"
        options = {
            "begin": text_of(path, demand, "InventoryLevelBundleRestartThreshold", 0.65),
            "stop": text_of(path, demand, "InventoryLevelBundleStopThreshold", 0.85),
            "waiting": int(text_of(path, demand, "BundleCount", 200)),
        }
    seed = text_of(path, root, "Seed", None)
    return ShiftSettings(
        orders,
        {"replenishment": {"name": "threshold", **options}} if options else {},
        text_of(path, root, "SimulationDuration", None),
        None if seed is None else int(seed),
        text_of(path, root, ".//InitialInventory", None),
    )


def _id(path: PathName, element: Element) -> int:
    return int(number_of(path, element, "ID")) + 1


def _single_tier(path: PathName, root: Element) -> None:
    tiers = {element.get("Tier") for element in root.iter() if element.get("Tier") is not None}
    if len(tiers) > 1:
        raise InstanceError(f"{path}: {len(tiers)} tiers; robots here drive on one floor")


def _stations(
    path: PathName, root: Element, waypoints: Mapping[str, Waypoint], grid: Grid
) -> tuple[list[Station], dict[str, dict[str, Any]]]:
    """Returns the stations, and their own Settings by name."""
    result: list[Station] = []
    overrides: dict[str, dict[str, Any]] = {}
    for group, tag, kind in (
        ("OutputStations", "OutputStation", PICK),
        ("InputStations", "InputStation", REPLENISH),
    ):
        for element in children(root, group, tag):
            number = _id(path, element)
            name = f"{'pick' if kind == PICK else 'replenish'}{number}"
            lane, service = _lane(path, element, waypoints)
            cells = np.array([grid.cell[one] for one in lane], np.int32)
            result.append(Station(name, kind, cells, service))
            overrides[name] = _times(path, element, kind)
    return result, overrides


def _times(path: PathName, element: Element, kind: str) -> dict[str, Any]:
    if kind == REPLENISH:
        return {"bundle_s": number_of(path, element, "ItemBundleTransferTime", 10.0)}
    piece = number_of(path, element, "ItemTransferTime", 10.0)
    return {
        "piece_s": piece,
        "pick_s": min(number_of(path, element, "ItemPickTime", Settings.pick_s), piece),
        "slots": int(number_of(path, element, "Capacity", Settings.slots)),
    }


def _lane(
    path: PathName, element: Element, waypoints: Mapping[str, Waypoint]
) -> tuple[list[str], int]:
    """Returns the waypoints of a station's lane in driving order, and the index of its own one."""
    key = element.tag, element.get("ID")
    own = next((one for one in waypoints.values() if one.station == key), None)
    what = f"{element.tag} {element.get('ID')}"
    if own is None:
        raise InstanceError(f"{path}: {what} has no Waypoint")
    listed = [(one.text or "").strip() for one in element.findall("Queues/Queues")]
    listed += [(one.text or "").strip() for one in element.findall("Queue/Queue")]
    lane = [own.number]
    for text in listed:
        number = text.rpartition("/")[2]
        if number not in waypoints:
            raise InstanceError(f"{path}: {what}: its queue names Waypoint {number}: not there")
        if number in lane:
            continue
        if lane[0] not in waypoints[number].paths or waypoints[number].storage:
            break  # from here on the queue is no single lane
        lane.insert(0, number)
    service = len(lane) - 1
    while True:
        after = [n for n in waypoints[lane[-1]].paths if waypoints[n].queue and n not in lane]
        onward = [n for n in waypoints[lane[-1]].paths if n not in lane]
        if len(after) != 1 or len(onward) != 1:
            return lane, service
        lane.append(after[0])


def _plan(
    path: PathName, waypoints: Mapping[str, Waypoint], grid: Grid, stations: Sequence[Station]
) -> FloorPlan:
    shape = grid.height, grid.width
    passable, storage = np.zeros(shape, bool), np.zeros(shape, bool)
    exits = np.zeros(shape, np.uint8)
    headings = {dx + dy * grid.width: heading for heading, (dx, dy) in enumerate(STEPS)}
    for number, one in waypoints.items():
        cell = grid.cell[number]
        passable.flat[cell], storage.flat[cell] = True, one.storage
        for other in one.paths:
            heading = headings.get(grid.cell[other] - cell)
            if heading is None:
                raise InstanceError(
                    f"{path}: Waypoints {number} and {other} are no neighbours on a grid"
                )
            exits.flat[cell] |= 1 << heading
    return FloorPlan.laid_out(
        origin=grid.origin,
        spacing=grid.spacing,
        passable=passable,
        storage=storage,
        parking=np.zeros(shape, bool),
        exits=exits,
        stations=stations,
    )


def _kinematics(path: PathName, bots: Sequence[Element]) -> Kinematics:
    if not bots:
        raise InstanceError(f"{path}: there is no Bot")
    names = ("MaxVelocity", "MaxAcceleration", "TurnSpeed", "PodTransferTime")
    defaults = (1.5, 1.0, 2.5, 2.2)
    kinds = {
        tuple(number_of(path, bot, name, value) for name, value in zip(names, defaults))
        for bot in bots
    }
    if len(kinds) > 1:
        raise InstanceError(f"{path}: bots of {len(kinds)} kinds; all alike was expected")
    speed, acceleration, full_turn, lift = kinds.pop()
    if min(speed, acceleration) <= 0 or min(full_turn, lift) < 0:
        raise InstanceError(f"{path}: MaxVelocity and MaxAcceleration above 0 were expected")
    return replace(
        Kinematics(),
        speed=speed,
        acceleration=acceleration,
        quarter_turn=full_turn / 4,
        lift=lift,
    )


def _distinct(
    path: PathName, what: str, elements: Sequence[Element], cells: Mapping[int, int]
) -> None:
    first: dict[int, str | None] = {}
    for element, cell in zip(elements, cells.values()):
        if cell in first:
            raise InstanceError(
                f"{path}: {what} {element.get('ID')} stands where {first[cell]} does"
            )
        first[cell] = element.get("ID")
