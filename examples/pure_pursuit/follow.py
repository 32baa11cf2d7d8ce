#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Drives a Kiva along a path of points by cmd_vel; stands for a navigation stack.

follow.py kiva1 X Y X Y ... [--grid]

Points are in the frame map [m]; the path begins where the robot is. It is checked by /map first.
--grid: turns along the grid at the end, and gives the robot back to it.
Exit code 0: it is there; 1: it is not, and the reason is printed.
"""

import argparse
import math
import sys

import rospy
import tf2_ros
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid
from pursuit import Point, Pose, PurePursuit, turn_to

from warehouse_client.pace import PaceKeeper, wait_beyond
from warehouse_msgs.srv import SetCmdVel

RATE = 20.0  # of commands [Hz]
LOOKAHEAD = 3 / RATE  # how far simulated time may pass beyond the last command [s]
PATIENCE = 20.0  # time without progress after which it gives up [s]
HALF_WIDTH = 0.34  # of a robot and a margin, beside the path [m]
STANDS = 0.6  # time after which a robot that was asked to stop stands [s]


class Failure(Exception):
    """The robot can't be driven there; the text says why."""


class Robot:
    """A Kiva that takes velocities: its pose in the map, and its speeds."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._frames = tf2_ros.Buffer()
        self._listener = tf2_ros.TransformListener(self._frames)
        self._speeds = rospy.Publisher(f"{name}/cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        self._pace = PaceKeeper(LOOKAHEAD)
        rospy.on_shutdown(self.stop)

    def hand_over(self, enable: bool) -> None:
        """Has the robot take velocities, or gives it back to the grid."""
        service = rospy.ServiceProxy("warehouse/set_cmd_vel", SetCmdVel)
        answer = service(int(self._name.removeprefix("kiva")), enable)
        if not answer.success and "already" not in answer.message:
            raise Failure(answer.message)

    def pose(self) -> Pose:
        """Returns the pose in the map."""
        try:
            at = self._frames.lookup_transform(
                "map", f"{self._name}/base_link", rospy.Time(), rospy.Duration(5)
            ).transform
        except tf2_ros.TransformException as error:
            raise Failure(f"{self._name} is not localised: {error}") from None
        yaw = 2 * math.atan2(at.rotation.z, at.rotation.w)
        return at.translation.x, at.translation.y, yaw

    def drive(self, speed: float, turn_rate: float) -> None:
        """Asks for a speed [m/s] and a turn rate [rad/s], for half a second at most; returns when
        it is time for the next."""
        now, twist = rospy.Time.now(), Twist()
        twist.linear.x, twist.angular.z = speed, turn_rate
        self._speeds.publish(twist)
        self._pace.acted_upon(now)
        wait_beyond(now.to_sec(), 1 / RATE)

    def stop(self) -> None:
        """Asks it to stop."""
        self._speeds.publish(Twist())
        self._pace.release()


def taken(grid: OccupancyGrid, begin: Point, end: Point) -> Point | None:
    """Returns a place on a straight way that is not free for the robot's width, or None."""
    info = grid.info
    length = math.dist(begin, end)
    steps = max(1, math.ceil(length / info.resolution))
    sides = [k * info.resolution for k in range(math.ceil(HALF_WIDTH / info.resolution) + 1)]
    nx, ny = (begin[1] - end[1]) / length, (end[0] - begin[0]) / length
    for step in range(steps + 1):
        x = begin[0] + (end[0] - begin[0]) * step / steps
        y = begin[1] + (end[1] - begin[1]) * step / steps
        for side in (sign * min(way, HALF_WIDTH) for way in sides for sign in (-1, 1)):
            column = math.floor((x + side * nx - info.origin.position.x) / info.resolution)
            row = math.floor((y + side * ny - info.origin.position.y) / info.resolution)
            is_inside = 0 <= column < info.width and 0 <= row < info.height
            if not is_inside or grid.data[row * info.width + column] != 0:
                return x, y
    return None


def check(points: list[Point]) -> None:
    """Raises Failure if something of the map stands in the way."""
    grid = rospy.wait_for_message("map", OccupancyGrid, 30)
    for begin, end in zip(points, points[1:]):
        if place := taken(grid, begin, end):
            raise Failure(f"the way is not free at {place[0]:.2f},{place[1]:.2f}: /map")


def follow(robot: Robot, points: list[Point]) -> None:
    """Drives along the points. Raises Failure if the robot gets no farther."""
    pursuit = PurePursuit(points)
    left, since = math.inf, rospy.get_time()
    while not pursuit.is_done:
        robot.drive(*pursuit.command(robot.pose()))
        if pursuit.left < left - 0.01:
            left, since = pursuit.left, rospy.get_time()
        if rospy.get_time() > since + PATIENCE:
            raise Failure(f"it gets no farther, {pursuit.left:.2f} m before the end")


def square_up(robot: Robot) -> None:
    """Turns along the grid, and gives the robot back to it."""
    yaw = math.pi / 2 * round(robot.pose()[2] / (math.pi / 2))
    while turn_rate := turn_to(yaw, robot.pose()[2]):
        robot.drive(0.0, turn_rate)
    robot.stop()
    rospy.sleep(STANDS)
    robot.hand_over(False)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("robot", help="its name, such as kiva1")
    parser.add_argument("points", nargs="+", type=float, metavar="X Y", help="points [m]")
    parser.add_argument("--grid", action="store_true", help="give it back to the grid at the end")
    options = parser.parse_args(rospy.myargv()[1:])
    if len(options.points) % 2:
        parser.error("an x and a y of each point were expected")
    aims = list(zip(options.points[::2], options.points[1::2]))
    rospy.init_node("pure_pursuit", anonymous=True)
    robot = Robot(options.robot)
    try:
        robot.hand_over(True)
        points = [robot.pose()[:2], *aims]
        check(points)
        follow(robot, points)
        if options.grid:
            square_up(robot)
        else:
            robot.stop()
            rospy.sleep(STANDS)
    except (Failure, rospy.ROSException, ValueError) as error:
        robot.stop()
        print(f"{options.robot}: {error}", file=sys.stderr)
        sys.exit(1)
    x, y, yaw = robot.pose()
    print(f"{options.robot} is at {x:.3f},{y:.3f}, heading {math.degrees(yaw):.1f}°")


if __name__ == "__main__":
    main()
