# SPDX-License-Identifier: Apache-2.0
"""Where robots are going, as a nav_msgs/Path for each robot whose topic has a subscriber."""

import math
from collections.abc import Collection, Mapping, Sequence
from types import ModuleType
from typing import Any

import rospy
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from nav_msgs.msg import Path
from std_msgs.msg import Header

from warehouse_msgs.msg import FleetPaths, FleetState

AT_ONCE = 25  # topics made in a turn: each is a call to the master


def ways(
    fleet: FleetState, paths: FleetPaths | None
) -> list[tuple[int, list[tuple[float, float]]]]:
    """Returns (kiva_id, [(x, y), …]) of each robot under way, from its place to its goal [m]."""
    where = {n: (x, y) for n, x, y in zip(fleet.kiva_id, fleet.x, fleet.y)}
    out: list[tuple[int, list[tuple[float, float]]]] = []
    at = 0
    if paths is None:
        return out
    for number, points in zip(paths.kiva_id, paths.points):
        corners = list(zip(paths.x[at : at + points], paths.y[at : at + points]))
        at += points
        if number in where and all(map(math.isfinite, sum(corners, ()))):
            out.append((int(number), [where[number], *corners]))
    return out


def path(points: Sequence[tuple[float, float]], stamp: rospy.Time) -> Path:
    """Returns a Path along points (x, y) [m] in world; each pose heads to the next."""
    header = Header(stamp=stamp, frame_id="world")
    yaw, out = 0.0, Path(header=header)
    for (x, y), (to_x, to_y) in zip(points, [*points[1:], *points[-1:]]):
        if (x, y) != (to_x, to_y):
            yaw = math.atan2(to_y - y, to_x - x)
        turn = Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
        out.poses.append(PoseStamped(header, Pose(Point(x, y, 0), turn)))
    return out


class PathTopics:
    """/kiva<id>/path of every robot, published while it has a subscriber. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._ros = ros
        self._topics: dict[int, Any] = {}
        self._sent: dict[int, list] = {}

    def turn(self, fleet: FleetState, paths: FleetPaths | None) -> None:
        """Publishes the paths that changed, and adds or removes topics as robots come or go."""
        standing = {int(n) for n in fleet.kiva_id}
        for number in sorted(standing - self._topics.keys())[:AT_ONCE]:
            topic = f"kiva{number}/path"
            self._topics[number] = self._ros.Publisher(topic, Path, queue_size=1)
        for number in self._topics.keys() - standing:
            self._topics.pop(number).unregister()
        heard = {n for n, topic in self._topics.items() if topic.get_num_connections()}
        if heard:
            self._send(heard, dict(ways(fleet, paths)), fleet.stamp)
        self._sent = {n: points for n, points in self._sent.items() if n in heard}

    def _send(
        self,
        heard: Collection[int],
        points_of: Mapping[int, list[tuple[float, float]]],
        stamp: rospy.Time,
    ) -> None:
        for number in heard:
            points = points_of.get(number, [])
            if self._sent.get(number) != points:
                self._sent[number] = points
                self._topics[number].publish(path(points, stamp))
