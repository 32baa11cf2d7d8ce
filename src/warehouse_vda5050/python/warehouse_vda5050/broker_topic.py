# SPDX-License-Identifier: Apache-2.0
"""The topic /warehouse/vda5050: robots at a broker, for the warehouse's own programs."""

import time
from collections.abc import Callable, Iterable
from typing import Any

import rospy

from warehouse_msgs.msg import Vda5050
from warehouse_vda5050.errors import Error
from warehouse_vda5050.master.remote_vehicle import RemoteVehicle
from warehouse_vda5050.model import ConnectionState
from warehouse_vda5050.vehicles import Vehicles

PERIOD = 0.5  # between two looks at what has changed [s, wall]
CONNECTIONS = {
    None: Vda5050.OFFLINE,  # it was never there
    ConnectionState.ONLINE: Vda5050.ONLINE,
    ConnectionState.OFFLINE: Vda5050.OFFLINE,
    ConnectionState.CONNECTIONBROKEN: Vda5050.CONNECTIONBROKEN,
}


class BrokerTopic:
    """Publishes which robots are at a broker; latched, sent when something changed."""

    def __init__(self) -> None:
        self._latest: Any = None
        self._next = 0.0
        self._publisher = rospy.Publisher("warehouse/vda5050", Vda5050, latch=True, queue_size=1)

    def update(self, make_message: Callable[[], Vda5050]) -> None:
        """Publishes what has changed; looks each PERIOD, however often it is called."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + PERIOD
        message = make_message()
        if message != self._latest:
            self._latest = message
            self._publisher.publish(message)


def vehicles_message(vehicles: Vehicles, broker: str) -> Vda5050:
    """Returns the message of the robots that outside masters may drive."""
    links = sorted(vehicles.links.items())
    message = Vda5050(broker=broker, direction=Vda5050.VEHICLE)
    message.connection = [
        Vda5050.ONLINE if link.link.connected else Vda5050.CONNECTIONBROKEN for _, link in links
    ]
    for kiva_id, link in links:
        vehicle, order = link.vehicle, link.vehicle.order
        message.kiva_id.append(kiva_id)
        message.manufacturer.append(link.identity.manufacturer)
        message.serial.append(link.identity.serial)
        message.order.append(order.id if order and not vehicle.is_free else "")
        message.errors.append(_text(vehicle.errors()))
        message.driven.append(vehicle.is_taken)
        message.faults.append(link.faults.active.names)
        message.planned_points.append(0)
        message.waypoints.append(0)
    return message


def masters_message(vehicles: Iterable[RemoteVehicle], broker: str, now: float) -> Vda5050:
    """Returns the message of the vehicles that this warehouse drives. `now` is as for them [s]."""
    message = Vda5050(broker=broker, direction=Vda5050.MASTER)
    message.connection = []
    for vehicle in vehicles:
        robot, view = vehicle.robot, vehicle.view
        message.kiva_id.append(robot.number)
        message.manufacturer.append(robot.identity.manufacturer)
        message.serial.append(robot.identity.serial)
        silent = view.connection is ConnectionState.ONLINE and view.is_silent(now)
        message.connection.append(
            Vda5050.CONNECTIONBROKEN if silent else CONNECTIONS[view.connection]
        )
        message.order.append(vehicle.order_id)
        errors = _text(view.state.errors if view.state else ())
        lines = [*errors.splitlines(), *(f"factsheet: {why}" for why in vehicle.sheet_faults)]
        message.errors.append("\n".join(lines))
        message.driven.append(not vehicle.is_idle)
        message.faults.append("")
        _add_paths(message, vehicle)
    return message


def _add_paths(message: Vda5050, vehicle: RemoteVehicle) -> None:
    """Adds where a vehicle says that it will drive."""
    planned, waypoints = vehicle.view.planned_path, vehicle.view.waypoints
    message.planned_points.append(len(planned))
    message.planned_x += [x for x, _ in planned]
    message.planned_y += [y for _, y in planned]
    message.waypoints.append(len(waypoints))
    message.waypoint_x += [x for x, *_ in waypoints]
    message.waypoint_y += [y for _, y, _ in waypoints]
    message.waypoint_time += [time for *_, time in waypoints]


def _text(errors: Iterable[Error]) -> str:
    return "\n".join(f"{error.type}: {error.description}" for error in errors)
