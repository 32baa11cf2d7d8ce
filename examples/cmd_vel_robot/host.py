# SPDX-License-Identifier: Apache-2.0
"""A CmdVelDriver's robot in ROS: odometry and poses of tf go in, speeds go out."""

import math
from typing import Any

import rospy
import tf2_ros
from driver import CmdVelDriver
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

from warehouse_client.pace import PaceKeeper

PERIOD = 0.05  # between two commands [s, of the robot's clock]
LOOKAHEAD = 3 * PERIOD  # how far simulated time may pass beyond the last command [s]


class Host:
    """Carries what a robot tells to its driver, and the driver's speeds to the robot.

    The pose is that of odom, or, with a map_frame, that of odom's child frame in it.
    """

    def __init__(self, driver: CmdVelDriver, map_frame: str = "") -> None:
        self._driver, self._map_frame = driver, map_frame
        self._frames = tf2_ros.Buffer()
        self._listener = tf2_ros.TransformListener(self._frames) if map_frame else None
        self._speeds = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber("odom", Odometry, self._on_odometry, queue_size=1, tcp_nodelay=True)
        self._pace = PaceKeeper(LOOKAHEAD)  # a robot that is no simulated one does not hear it
        rospy.on_shutdown(self._stand)
        rospy.Timer(rospy.Duration(PERIOD), self._command, reset=True)

    def _on_odometry(self, odometry: Odometry) -> None:
        pose = odometry.pose.pose
        at, turned = pose.position, pose.orientation
        if self._map_frame:
            try:
                transform = self._frames.lookup_transform(
                    self._map_frame, odometry.child_frame_id, rospy.Time()
                ).transform
            except tf2_ros.TransformException as error:
                rospy.logwarn_throttle(10, f"the robot is not localized: {error}")
                return
            at, turned = transform.translation, transform.rotation
        stamp, twist = odometry.header.stamp.to_sec(), odometry.twist.twist
        pose = at.x, at.y, yaw_of(turned)
        self._driver.on_odometry(stamp, pose, twist.linear.x, twist.angular.z)

    def _command(self, _: object) -> None:
        now = rospy.Time.now()
        self._publish(*self._driver.command(now.to_sec(), PERIOD))
        self._pace.acted_upon(now)

    def _stand(self) -> None:
        """Leaves no speed behind: many robots go on with the last command."""
        self._publish(0.0, 0.0)

    def _publish(self, speed: float, rate: float) -> None:
        out = Twist()
        out.linear.x, out.angular.z = speed, rate
        self._speeds.publish(out)


def yaw_of(turned: Any) -> float:
    """Returns the yaw [rad] of a quaternion."""
    q = turned
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
