# SPDX-License-Identifier: Apache-2.0
"""A robot with wheels and odometry as a VDA 5050 vehicle's Driver. No ROS here."""

import math
from collections.abc import Sequence

from path_follower import Limits, PathFollower, Pose
from pose_filter import PoseFilter

from warehouse_vda5050.driver import Driver, Point, Report
from warehouse_vda5050.model import Factsheet

SILENT = 1.0  # [s] without odometry: the robot is not heard, and stands


class CmdVelDriver(Driver):
    """Drives by speeds, knows its pose by odometry; it has no lift.

    on_odometry() and command() are called by its host, the latter some twenty times a second.
    """

    def __init__(self, limits: Limits | None = None, trust: float = 0.1) -> None:
        self._follower = PathFollower(limits)
        self._filter = PoseFilter(trust)
        self._path_id = 0
        self._refusal = ""
        self._stopped = self._busy = False
        self._speed = self._rate = 0.0  # as commanded [m/s, rad/s]
        self._is_news = False  # odometry came since the last command
        self._heard_at = -math.inf
        self._now = 0.0

    # --- of the host

    def on_odometry(self, time: float, pose: Pose, speed: float, rate: float) -> None:
        """Takes in where the robot tells to be [m, rad] and how fast it is, at a time [s] of the
        robot's own clock."""
        self._filter.update(time, pose, speed, rate)
        self._speed, self._rate, self._is_news = speed, rate, True

    def command(self, now: float, dt: float) -> tuple[float, float]:
        """Returns the speeds to be commanded now [m/s, rad/s]."""
        self._now = now
        if self._is_news:
            self._heard_at, self._is_news = now, False
        pose = self._filter.pose
        if pose is None or not self._heard:
            return 0.0, 0.0
        speeds = self._follower.command(pose, dt, self._stopped)
        if self._busy and self._follower.is_done:
            self._busy = False
        return speeds

    # --- of the vehicle core

    def follow(self, path_id: int, first: int, points: Sequence[Point], released: int) -> None:
        """Begins a path, or goes on with the one under way."""
        self._refusal = ""
        if path_id == self._path_id and first:
            self._follower.extend(first, points, released)
            self._busy = True
        elif path_id != self._path_id:
            self._path_id, self._busy = path_id, True
            self._follower.begin(points, released)

    def lift(self, unit: str, up: bool) -> None:
        """Refuses: this robot has no lift."""
        self._refusal = "this robot has no lift"

    def cancel(self) -> None:
        """Stands at the next point."""
        self._follower.end_here()

    def stop(self, stopped: bool) -> None:
        """Stands as soon as it can, or goes on."""
        self._stopped = stopped

    def report(self) -> Report | None:
        """Returns where the robot is, and how far it has come."""
        if self._filter.pose is None:
            return None
        yaw = self._filter.pose[2]
        return Report(
            *self._filter.pose,
            vx=self._speed * math.cos(yaw),
            vy=self._speed * math.sin(yaw),
            omega=self._rate,
            busy=self._busy,
            moving=self._follower.moves,
            path_id=self._path_id,
            reached=self._follower.reached,
            refusal=self._refusal,
            heard=self._heard,
        )

    def factsheet(self) -> Factsheet:
        """Returns what this robot is."""
        limits = self._follower.limits
        return Factsheet(
            series="cmd_vel",
            description="a differential robot behind cmd_vel and odom",
            max_load_mass=0.0,
            length=0.3,
            width=0.3,
            height=0.2,
            max_speed=limits.speed,
            max_acceleration=limits.acceleration,
            max_deceleration=limits.acceleration,
        )

    @property
    def _heard(self) -> bool:
        return self._now - self._heard_at < SILENT
