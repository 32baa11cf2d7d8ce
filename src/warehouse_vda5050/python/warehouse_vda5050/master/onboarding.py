# SPDX-License-Identifier: Apache-2.0
"""Makes a vehicle that was seen at the broker a robot of the warehouse, or says why not."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from warehouse_vda5050.grid import Grid
from warehouse_vda5050.master.commands import RefusedError
from warehouse_vda5050.master.frame import Frame, Pose
from warehouse_vda5050.master.introduction import too_large
from warehouse_vda5050.master.robots_file import (
    MOST_NUMBER,
    NODE_IDS,
    RemoteRobot,
    RobotsFileError,
    read_robot,
)
from warehouse_vda5050.master.seen import SeenVehicle
from warehouse_vda5050.master.whereabouts import square
from warehouse_vda5050.model import AgvPosition

CLEAR = 0.25  # largest distance of a vehicle from the middle of its cell [cells]
ASKEW = 0.1  # largest angle between its heading and an axis of the floor [rad]
MAP_ASKEW = 0.05  # up to which a map counts as turned by a whole number of quarter turns [rad]
MOST_METRES = 1e6


@dataclass(frozen=True)
class Request:
    """What a person asks for: `stands` says whether the pose is where the vehicle stands on the
    floor, or where its map has its zero point; number 0 is the lowest that is free."""

    number: int
    stands: bool
    pose: Pose
    map_id: str = ""
    node_ids: str = ""
    action_parameters: str = ""
    assume: bool = False


@dataclass(frozen=True)
class Floor:
    """The floor, and where its robots are, by number [m]."""

    grid: Grid
    robots: Mapping[int, tuple[float, float]]


def make_robot(request: Request, vehicle: SeenVehicle, floor: Floor) -> RemoteRobot:
    """Returns the robot that a vehicle is to be. Raises RefusedError."""
    at = _check_vehicle(vehicle, request, floor.grid)
    number = _number(request.number, floor)
    if not all(math.isfinite(v) and abs(v) <= MOST_METRES for v in request.pose):
        raise RefusedError("x, y and theta have to be numbers in metres and radians")
    frame = _frame_of(request.pose, at, floor.grid) if request.stands else Frame(*request.pose)
    _check_place(frame.to_world(at.x, at.y, at.theta), floor)
    entry: dict[str, Any] = {
        "manufacturer": vehicle.identity.manufacturer,
        "serial": vehicle.identity.serial,
        "origin": [frame.x, frame.y, frame.theta],
        "action_parameters": _parameters(request.action_parameters),
        "node_ids": request.node_ids or NODE_IDS,
    }
    try:
        entry |= {"map_id": request.map_id} if request.map_id else {}
        return read_robot(f"robot {number}", number, entry)
    except RobotsFileError as error:
        raise RefusedError(str(error)) from error


def _check_vehicle(vehicle: SeenVehicle, request: Request, grid: Grid) -> AgvPosition:
    """Returns where a vehicle is on its own map. Raises RefusedError where it can't be taken."""
    name = f"{vehicle.identity.manufacturer}/{vehicle.identity.serial}"
    if not vehicle.is_connected:
        raise RefusedError(f"{name} is not connected to the broker")
    at = vehicle.state.position if vehicle.state else None
    if at is None or not at.initialized:
        raise RefusedError(f"{name} has not reported where it is: localize it first")
    if vehicle.sheet is None and not request.assume:
        why = vehicle.fault or "none has come"
        raise RefusedError(f"{name} has no factsheet ({why}): confirm what is assumed, or send one")
    if why := too_large(vehicle.sheet, grid.spacing):
        raise RefusedError(f"{name} does not fit: {why}")
    return at


def _number(number: int, floor: Floor) -> int:
    """Returns the number of the new robot. Raises RefusedError where it is taken."""
    if number == 0:
        return next(n for n in range(1, MOST_NUMBER + 1) if n not in floor.robots)
    if not 1 <= number <= MOST_NUMBER:
        raise RefusedError(f"a robot's number is 1 to {MOST_NUMBER}, not {number}")
    if number in floor.robots:
        raise RefusedError(f"number {number} is taken: kiva{number} is there already")
    return number


def _frame_of(stands: Pose, at: AgvPosition, grid: Grid) -> Frame:
    """Returns the origin of the map of a vehicle that stands in the middle of a cell."""
    x, y = grid.position(grid.cell_at(*stands[:2]))
    turn = math.remainder(stands[2] - at.theta, math.tau)
    if abs(math.remainder(turn - square(turn), math.tau)) <= MAP_ASKEW:
        turn = square(turn)  # a small error of the heading moves what is far away
    c, s = math.cos(turn), math.sin(turn)
    return Frame(x - (c * at.x - s * at.y), y - (s * at.x + c * at.y), turn)


def _check_place(pose: Pose, floor: Floor) -> None:
    """Raises RefusedError where no robot can stand, or where one stands already."""
    x, y, yaw = pose
    grid, where = floor.grid, f"it would stand at {x:.2f}, {y:.2f} m"
    cell = grid.cell_at(x, y)
    if not grid.contains(cell):
        raise RefusedError(f"{where}: that is off the floor")
    middle = grid.position(cell)
    if max(abs(x - middle[0]), abs(y - middle[1])) > CLEAR * grid.spacing:
        raise RefusedError(
            f"{where}: that is not the middle of a cell, as {middle[0]:g}, {middle[1]:g}"
        )
    if abs(math.remainder(yaw - square(yaw), math.tau)) > ASKEW:
        raise RefusedError(f"{where} with a heading of {yaw:.2f} rad: it has to be along an axis")
    if cell in grid.blocked:
        raise RefusedError(f"{where}: a wall or something else that is fixed stands there")
    for number, place in floor.robots.items():
        if grid.cell_at(*place) == cell:
            raise RefusedError(f"{where}: kiva{number} stands there")


def _parameters(text: str) -> dict[str, Any]:
    if not text:
        return {}
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise RefusedError(f"action_parameters: {error}") from error
    if not isinstance(value, dict) or len(text) > 2000:
        raise RefusedError("action_parameters: a short object, names with values, was expected")
    return value
