# SPDX-License-Identifier: Apache-2.0
"""A vehicle as the warehouse sees it: the row of a FleetState."""

import math
from dataclasses import dataclass

from warehouse_fleet.robots.failures import EMPTY, OUT_OF_ORDER
from warehouse_layout.message_enums import EventKind as Ended
from warehouse_layout.message_enums import FailureKind, State, Status
from warehouse_vda5050.master.remote_vehicle import EventKind, RemoteVehicle
from warehouse_vda5050.master.speedometer import REST

# What breaks, by words in the types that makers give their errors.
WORDS = (
    ("motor", FailureKind.MOTOR),
    ("battery", EMPTY),
    ("laser", FailureKind.LASER_BLIND),
    ("lift", FailureKind.LIFT_STUCK),
)
LAST_END = {None: 0, EventKind.DONE: int(Ended.DONE), EventKind.BLOCKED: int(Ended.BLOCKED)}


@dataclass(frozen=True)
class Shadow:
    """The state of one robot, as in warehouse_msgs/FleetState [m, rad, m/s, rad/s]."""

    kiva_id: int
    x: float
    y: float
    yaw: float
    vx: float
    vy: float
    yaw_rate: float
    status: int
    state: int
    shelf_id: int
    path_id: int
    reached: int
    left: int
    last_end: int
    failures: int
    charge: float


def shadow_of(vehicle: RemoteVehicle, now: float) -> Shadow | None:
    """Returns what a vehicle is and does now; None until it has reported a position."""
    view = vehicle.view
    if not view.is_there or view.state is None:
        return None
    x, y, yaw = view.pose
    status, state = _status(vehicle)
    twist = view.speedometer.read(now) if view.hears else REST
    return Shadow(
        vehicle.robot.number,
        x,
        y,
        yaw,
        *twist,
        status,
        state,
        vehicle.load,
        vehicle.path_id,
        vehicle.reached,
        max(0, vehicle.reached - 1),
        LAST_END[vehicle.last_end],
        _failures(vehicle, now),
        min(max(view.state.battery.charge / 100, 0.0), 1.0),
    )


def _status(vehicle: RemoteVehicle) -> tuple[int, int]:
    view = vehicle.view
    if vehicle.is_idle:
        return Status.IDLE, State.IDLE
    if view.state is not None and view.state.field_violation:
        return Status.BLOCKED, State.BLOCKED
    if vehicle.lifts:
        return Status.BUSY, State.LIFTING
    if vehicle.waits:
        return Status.BUSY, State.WAITING
    along_x = abs(math.cos(view.pose[2])) > math.sqrt(0.5)
    return Status.BUSY, State.MOVING_X if along_x else State.MOVING_Y


def _failures(vehicle: RemoteVehicle, now: float) -> int:
    """The bits of FleetState.failures."""
    view, failures = vehicle.view, 0
    for type in view.fatal_types:
        failures |= 1 << next((bit for word, bit in WORDS if word in type.lower()), OUT_OF_ORDER)
    if not view.is_localized:
        failures |= 1 << OUT_OF_ORDER
    if view.is_silent(now):
        failures |= 1 << FailureKind.RADIO_LOST
    return failures
