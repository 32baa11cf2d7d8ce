# SPDX-License-Identifier: Apache-2.0
"""The robot that a person chose in RViz: sent by a goal, its laser shown.

RViz's tool "Publish Point" chooses the robot at the point; "2D Goal" sends it to the grid point
next to the goal, whose heading does not matter.
"""

import math
from types import ModuleType

from geometry_msgs.msg import PointStamped, PoseStamped
from sensor_msgs.msg import LaserScan

from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import FleetState, MoveTo

REACH = 0.75  # of a robot's centre from the point that means it [m]


class Chosen:
    """`number` is that of the chosen robot, 0 = none. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._ros, self.number, self._scan = ros, 0, None
        self._fleet, self._spacing = None, 1.0
        subscribe(ros, "clicked_point", PointStamped, self._choose, queue_size=1)
        subscribe(ros, "move_base_simple/goal", PoseStamped, self._send, queue_size=1)
        self._goals = ros.Publisher("mov", MoveTo, queue_size=10)
        self._scans = ros.Publisher("warehouse/chosen/scan", LaserScan, queue_size=1)

    def take(self, fleet: FleetState, spacing: float) -> None:
        """Takes over the newest FleetState; grid points are `spacing` [m] apart."""
        self._fleet, self._spacing = fleet, spacing
        if self.number and self.number not in fleet.kiva_id:
            self._set(0)

    def _choose(self, clicked: PointStamped) -> None:
        at, fleet = clicked.point, self._fleet
        if fleet is None:
            return
        far = [
            (math.hypot(x - at.x, y - at.y), int(number))
            for number, x, y in zip(fleet.kiva_id, fleet.x, fleet.y)
        ]
        distance, number = min(far, default=(math.inf, 0))
        self._set(number if distance < REACH else 0)

    def _set(self, number: int) -> None:
        if self._scan:
            self._scan.unregister()
        self.number, self._scan = number, None
        if number:
            topic = f"kiva{number}/chassis/laser/scan"
            self._scan = subscribe(self._ros, topic, LaserScan, self._scans.publish, queue_size=1)

    def _send(self, goal: PoseStamped) -> None:
        if not self.number:
            self._ros.logwarn("no robot is chosen: click one with Publish Point first")
            return
        at = goal.pose.position
        x, y = (round(along / self._spacing) * self._spacing for along in (at.x, at.y))
        self._goals.publish(x=x, y=y, kiva_id=self.number)
