# SPDX-License-Identifier: Apache-2.0
"""What pages and the API get of vehicles that this warehouse drives."""

from grid_robot import GRID

from warehouse_msgs.msg import Vda5050
from warehouse_vda5050.broker_topic import masters_message
from warehouse_vda5050.errors import Error
from warehouse_vda5050.master.commands import Follow
from warehouse_vda5050.master.remote_vehicle import RemoteVehicle
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.master.vehicle_view import SILENT
from warehouse_vda5050.model import AgvPosition, ConnectionState, VehicleState
from warehouse_vda5050.topics import Identity


def message_of(vehicle, now=0.0):
    return masters_message([vehicle], "host:1883", now)


def test_the_master_tells_whose_vehicle_it_is_connection_order_and_errors():
    vehicle = RemoteVehicle(RemoteRobot(21, Identity("acme", "7")), GRID, "run")
    message = message_of(vehicle)
    assert (message.direction, message.broker) == (Vda5050.MASTER, "host:1883")
    assert (message.kiva_id, message.manufacturer, message.serial) == ([21], ["acme"], ["7"])
    assert (message.connection, message.order, message.driven) == ([Vda5050.OFFLINE], [""], [False])

    vehicle.take_connection(ConnectionState.ONLINE, 0.0)
    errors = (Error("motorError", description="no torque"), Error("x"))
    vehicle.take_state(VehicleState(position=AgvPosition(0.0, 0.0, 0.0), errors=errors), 0.0)
    vehicle.command(Follow(1, 0, ((0.0, 0.0), (1.0, 0.0)), 2))
    message = message_of(vehicle)
    assert (message.connection, message.driven) == ([Vda5050.ONLINE], [True])
    assert message.order == [vehicle.messages(0.0)[-1].id]
    assert message.errors == ["motorError: no torque\nx: "]


def test_a_vehicle_that_tells_nothing_any_more_is_told_as_broken_off():
    vehicle = RemoteVehicle(RemoteRobot(21, Identity("acme", "7")), GRID, "run")
    vehicle.take_connection(ConnectionState.ONLINE, 0.0)
    assert message_of(vehicle, SILENT - 1).connection == [Vda5050.ONLINE]
    assert message_of(vehicle, SILENT + 1).connection == [Vda5050.CONNECTIONBROKEN]
    vehicle.take_connection(ConnectionState.OFFLINE, 0.0)
    assert message_of(vehicle, SILENT + 1).connection == [Vda5050.OFFLINE]
