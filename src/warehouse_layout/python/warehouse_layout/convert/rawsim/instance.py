# SPDX-License-Identifier: Apache-2.0
"""The floor of a RAWSim-O instance (.xinst), and what stands on it.

Waypoints become cells: their places are snapped to the rows and columns that they form, whatever
the spacing. A station's lane is its queue, from the far end to the station's own waypoint, and the
queue waypoints after it; further connections into the queue are short cuts. Units and robots are
numbered from 1, in the file's order. Tiers lie side by side, and elevators lead from one to
another.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim.elevators import read_elevators
from warehouse_layout.convert.rawsim.grid import Grid, Waypoint, read_waypoints
from warehouse_layout.convert.rawsim.xml_fields import InstanceError, children, number_of, read_root
from warehouse_layout.floor.elevators import Elevator
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import (
    PICK,
    REPLENISH,
    Station,
    cell_steps,
    lane_mask,
    short_cuts,
)


@dataclass(frozen=True, eq=False)
class Instance:
    """An instance: its name, its floor, the cells of units and robots, and the file's elements."""

    name: str
    plan: FloorPlan
    paths: np.ndarray  # (h, w) uint8: exits of cells as the file has them, in lanes too
    units: dict[int, int]  # cells by number
    robots: dict[int, int]
    elements: dict[str, Element]  # of stations, by their names
    pods: list[Element]
    bots: list[Element]


def read_floor(path: PathName) -> Instance:
    """Returns the Instance of an .xinst file. Raises InstanceError."""
    root = read_root(path, "Instance")
    waypoints = read_waypoints(path, root)
    grid = Grid(path, waypoints)
    pods, bots = children(root, "Pods", "Pod"), children(root, "Bots", "Bot")
    stations, elements = _stations(path, root, waypoints, grid)
    elevators = read_elevators(path, root, waypoints, grid)
    paths = _paths(path, waypoints, grid, elevators)
    plan = _plan(waypoints, grid, stations, paths, elevators)
    units = {i: grid.cell_at(pod, path) for i, pod in enumerate(pods, 1)}
    for pod, cell in zip(pods, units.values()):
        if not plan.storage.flat[cell]:
            raise InstanceError(f"{path}: Pod {pod.get('ID')} stands on no PodStorageLocation")
    _distinct(path, "Pod", pods, units)
    robots = {i: grid.cell_at(bot, path) for i, bot in enumerate(bots, 1)}
    _distinct(path, "Bot", bots, robots)
    name = root.get("Name") or Path(path).stem
    return Instance(name, plan, paths, units, robots, elements, pods, bots)


def _id(path: PathName, element: Element) -> int:
    return int(number_of(path, element, "ID")) + 1


def _stations(
    path: PathName, root: Element, waypoints: Mapping[str, Waypoint], grid: Grid
) -> tuple[list[Station], dict[str, Element]]:
    """Returns the stations, and their elements by name."""
    result: list[Station] = []
    elements: dict[str, Element] = {}
    for group, tag, kind in (
        ("OutputStations", "OutputStation", PICK),
        ("InputStations", "InputStation", REPLENISH),
    ):
        for element in children(root, group, tag):
            number = _id(path, element)
            name = f"{'pick' if kind == PICK else 'replenish'}{number}"
            lane, service = _lane(path, element, waypoints)
            cells = np.array([grid.cell[waypoint] for waypoint in lane], np.int32)
            result.append(Station(name, kind, cells, service))
            elements[name] = element
    return result, elements


def _lane(
    path: PathName, element: Element, waypoints: Mapping[str, Waypoint]
) -> tuple[list[str], int]:
    """Returns the waypoints of a station's lane in driving order, and the index of its own one."""
    key = element.tag, element.get("ID")
    own = next((named for named in waypoints.values() if named.station == key), None)
    what = f"{element.tag} {element.get('ID')}"
    if own is None:
        raise InstanceError(f"{path}: {what} has no Waypoint")
    listed = [(named.text or "").strip() for named in element.findall("Queues/Queues")]
    listed += [(named.text or "").strip() for named in element.findall("Queue/Queue")]
    lane = [own.number]
    for text in listed:
        number = text.rpartition("/")[2]
        if number not in waypoints:
            raise InstanceError(f"{path}: {what}: its queue names Waypoint {number}: not there")
        if number in lane:
            continue
        if lane[0] not in waypoints[number].paths or waypoints[number].storage:
            break  # from here on the queue is not a single lane
        lane.insert(0, number)
    service = len(lane) - 1
    while True:
        after = [n for n in waypoints[lane[-1]].paths if waypoints[n].queue and n not in lane]
        onward = [n for n in waypoints[lane[-1]].paths if n not in lane]
        if len(after) != 1 or len(onward) != 1:
            return lane, service
        lane.append(after[0])


def _paths(
    path: PathName,
    waypoints: Mapping[str, Waypoint],
    grid: Grid,
    elevators: Sequence[Elevator],
) -> np.ndarray:
    exits = np.zeros((grid.height, grid.width), np.uint8)
    rides = {(start, end) for elevator in elevators for start, end, _ in elevator.rides()}
    headings = {step: heading for heading, step in enumerate(cell_steps(grid.width))}
    for number, waypoint in waypoints.items():
        cell = grid.cell[number]
        for other in waypoint.paths:
            if (cell, grid.cell[other]) in rides:
                continue
            if waypoint.tier != waypoints[other].tier:
                raise InstanceError(
                    f"{path}: Waypoints {number} and {other} are on two tiers, and of no Elevator"
                )
            heading = headings.get(grid.cell[other] - cell)
            if heading is None:
                raise InstanceError(
                    f"{path}: Waypoints {number} and {other} are no neighbours on a grid"
                )
            exits.flat[cell] |= 1 << heading
    return exits


def _plan(
    waypoints: Mapping[str, Waypoint],
    grid: Grid,
    stations: Sequence[Station],
    exits: np.ndarray,
    elevators: Sequence[Elevator],
) -> FloorPlan:
    passable, storage = np.zeros(exits.shape, bool), np.zeros(exits.shape, bool)
    for number, waypoint in waypoints.items():
        passable.flat[grid.cell[number]] = True
        storage.flat[grid.cell[number]] = waypoint.storage
    streets = passable & ~storage & ~lane_mask(stations, exits.shape)
    stations = [
        replace(s, short_cuts=short_cuts(exits, streets, s.cells, s.service)) for s in stations
    ]
    return FloorPlan.laid_out(
        origin=grid.origin,
        spacing=grid.spacing,
        passable=passable,
        storage=storage,
        parking=np.zeros(exits.shape, bool),
        exits=exits,
        stations=stations,
        elevators=elevators,
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
