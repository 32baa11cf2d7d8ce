#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Puts a robot with cmd_vel and odom behind a broker, as a VDA 5050 vehicle.

    examples/cmd_vel_robot/vehicle.py odom:=/robot/odom cmd_vel:=/robot/cmd_vel _serial:=7

Parameters: ~manufacturer, ~serial, ~broker (HOST:PORT), ~prefix; ~x, ~y (of the middle of the
floor's first cell), ~spacing [m], ~columns, ~rows: the cells on which the robot may drive.
"""

import math
import time

import rospy
from driver import CmdVelDriver
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import read_settings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.topics import Identity, Topics
from warehouse_vda5050.vehicle import Vehicle

PERIOD = 0.05  # of commands [s]


def pose_of(odometry: Odometry) -> tuple[float, float, float]:
    """Returns x, y [m] and yaw [rad] of an odometry."""
    p, q = odometry.pose.pose.position, odometry.pose.pose.orientation
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return p.x, p.y, yaw


class Host:
    """Carries odometry in and speeds out."""

    def __init__(self) -> None:
        self.driver = CmdVelDriver()
        self._speeds = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("odom", Odometry, self._on_odometry, queue_size=1, tcp_nodelay=True)
        rospy.Timer(rospy.Duration(PERIOD), self._command)

    def _on_odometry(self, odometry: Odometry) -> None:
        twist, stamp = odometry.twist.twist, odometry.header.stamp.to_sec()
        self.driver.on_odometry(stamp, pose_of(odometry), twist.linear.x, twist.angular.z)

    def _command(self, _: object) -> None:
        out = Twist()
        speeds = self.driver.command(rospy.get_time(), PERIOD)
        out.linear.x, out.angular.z = speeds
        self._speeds.publish(out)


def grid() -> Grid:
    """Returns the floor that the parameters tell."""
    told = [rospy.get_param(f"~{name}", default) for name, default in (("x", 0.0), ("y", 0.0))]
    size = [int(rospy.get_param(f"~{name}", 20)) for name in ("columns", "rows")]
    return Grid(*map(float, told), float(rospy.get_param("~spacing", 1.0)), *size)


def main() -> None:
    rospy.init_node("cmd_vel_vehicle")
    host = Host()
    who = Identity(rospy.get_param("~manufacturer", "example"), str(rospy.get_param("~serial", "1")))
    broker = read_settings(rospy.get_param("~broker", "localhost:1883"))
    topics = Topics(rospy.get_param("~prefix", "uagv/v2"))
    vehicle = Vehicle(host.driver, grid())
    link = VehicleLink(vehicle, who, codec_for(), topics, broker, rospy.loginfo)
    loop = MqttLoop()
    loop.add(link.link)
    while not rospy.is_shutdown():
        loop.poll(PERIOD)
        link.tick(time.monotonic())
    link.close()
    loop.close()


if __name__ == "__main__":
    main()
