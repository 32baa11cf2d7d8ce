#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Puts a robot with cmd_vel and odom behind a broker, as a VDA 5050 vehicle.

    examples/cmd_vel_robot/vehicle.py odom:=/robot/odom cmd_vel:=/robot/cmd_vel _serial:=7

Parameters: ~manufacturer, ~serial; ~broker, ~prefix, ~version, ~tls, ~user, ~password_file, as of
vehicles.launch; ~x, ~y (of the middle of the floor's first cell), ~spacing [m], ~columns, ~rows:
the cells on which the robot may drive; ~limits: fields of Limits, "{speed: 0.3}". ~map_frame:
where odom drifts, the frame of tf in which the robot is localized; empty: odom's poses count.
"""

import contextlib
import time

import rospy
from driver import CmdVelDriver
from host import Host
from path_follower import Limits

from warehouse_vda5050.arguments import home, own_broker, read_arguments
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.topics import Identity
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings

PERIOD = 0.05  # between two looks at what the robot tells [s, wall]


def grid() -> Grid:
    """Returns the floor that the parameters tell."""
    x, y, spacing = (
        float(rospy.get_param(f"~{name}", default))
        for name, default in (("x", 0.0), ("y", 0.0), ("spacing", 1.0))
    )
    columns, rows = (int(rospy.get_param(f"~{name}", 20)) for name in ("columns", "rows"))
    return Grid(x, y, spacing, columns, rows)


def serve(stack: contextlib.ExitStack) -> None:
    """Drives the robot until ROS shuts down. Raises ValueError for parameters that are wrong."""
    driver = CmdVelDriver(Limits(**rospy.get_param("~limits", {})))
    Host(driver, str(rospy.get_param("~map_frame", "")))
    arguments = read_arguments(rospy.get_param)
    broker, address = own_broker(arguments, stack)
    who = Identity(
        str(rospy.get_param("~manufacturer", "example")), str(rospy.get_param("~serial", 1))
    )
    rospy.loginfo(f"vehicle {who.manufacturer}/{who.serial} at {address}")
    settings = VehicleSettings(
        begins_at_zero=arguments.codec.version.startswith("3"),
        logs=home() / "vda5050_logs",
        name=f"{who.manufacturer}-{who.serial}",
    )
    vehicle = Vehicle(driver, grid(), settings)
    link = VehicleLink(vehicle, who, arguments.codec, arguments.topics, broker)
    loop = MqttLoop()
    loop.add(link.link)
    while not rospy.is_shutdown():
        loop.poll(PERIOD)
        link.tick(time.monotonic())
    link.close()
    loop.close()


def main() -> None:
    rospy.init_node("cmd_vel_vehicle")
    with contextlib.ExitStack() as stack:
        try:
            serve(stack)
        except (ValueError, TypeError, RuntimeError) as error:
            raise SystemExit(f"vehicle.py: {error}") from None


if __name__ == "__main__":
    main()
