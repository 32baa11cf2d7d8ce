# SPDX-License-Identifier: Apache-2.0
"""Drives a differential robot through released points: turns on the spot, then straight.

A reference stops before each corner and at the last released point, by v = sqrt(2 a s); across the
way it steers back by heading and offset. No ROS here.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

Point = tuple[float, float]
Pose = tuple[float, float, float]  # x, y [m], yaw [rad]


@dataclass(frozen=True)
class Limits:
    """What a robot can: speeds [m/s, rad/s], accelerations [m/s², rad/s²], and how exact it is."""

    speed: float = 0.5
    acceleration: float = 0.5
    turn_rate: float = 1.0
    turn_acceleration: float = 1.5
    near: float = 0.01  # from the end of a run on it is there [m]
    square: float = 0.01  # of its heading [rad]


class PathFollower:
    """The way of one robot. `reached` counts the points that it has come to; the first is where it
    begins."""

    def __init__(self, limits: Limits | None = None) -> None:
        self.limits = limits or Limits()
        self._points: list[Point] = []
        self._released = 0
        self.reached = 0
        self._turning = False
        self._speed = self._rate = 0.0  # as commanded [m/s, rad/s]
        self._ahead = 0.0  # to the next point [m]

    def begin(self, points: Sequence[Point], released: int) -> None:
        """Begins a path at points[0], where the robot stands."""
        self._points, self._released, self.reached = list(points), released, 1
        self._turning = True

    def extend(self, first: int, points: Sequence[Point], released: int) -> None:
        """Puts points in place of those from number `first` on, and releases more."""
        self._points[first:] = points
        self._released = max(self._released, released)

    def end_here(self) -> None:
        """Ends the path at the next point at which the robot can still stop."""
        last, ahead = self.reached, self._ahead
        if not self._speed:
            last -= 1
        while ahead < self._speed**2 / (2 * self.limits.acceleration) and last + 1 < self._released:
            last += 1
            ahead += math.dist(self._points[last - 1], self._points[last])
        self._released = min(self._released, last + 1)
        del self._points[self._released :]

    @property
    def is_done(self) -> bool:
        """Whether the robot stands at the last released point."""
        return self.reached >= self._released and not self._speed and not self._rate

    @property
    def moves(self) -> bool:
        """Whether its command is to drive or turn."""
        return bool(self._speed or self._rate)

    def command(self, pose: Pose, dt: float, stopped: bool = False) -> tuple[float, float]:
        """Returns the speeds ahead [m/s] and counterclockwise [rad/s] for the next `dt` [s]."""
        stands = stopped or self.reached >= self._released
        speeds = (0.0, 0.0) if stands else self._go(pose)
        limits = self.limits
        self._speed = _approach(self._speed, speeds[0], 2 * limits.acceleration * dt)
        self._rate = _approach(self._rate, speeds[1], 2 * limits.turn_acceleration * dt)
        return self._speed, self._rate

    def _go(self, pose: Pose) -> tuple[float, float]:
        """The speeds that the way asks for."""
        start, goal = self._points[self.reached - 1], self._points[self.reached]
        heading = math.atan2(goal[1] - start[1], goal[0] - start[0])
        error = _wrapped(heading - pose[2])
        if self._turning:
            if abs(error) > self.limits.square or abs(self._rate) > 0.1:
                return 0.0, self._turn(error)
            self._turning = False
        return self._drive(pose, start, heading, error)

    def _turn(self, error: float) -> float:
        limits = self.limits
        braked = math.sqrt(2 * limits.turn_acceleration * abs(error))
        rate = min(limits.turn_rate, braked, 3 * abs(error))
        return math.copysign(rate, error)

    def _drive(self, pose: Pose, start: Point, heading: float, error: float) -> tuple[float, float]:
        limits = self.limits
        along, across = _in_line(pose, start, heading)
        left = max(0.0, self._run_length(heading) - along)
        while self.reached < self._released and along >= self._leg() - limits.near:
            along -= self._leg()
            self.reached += 1
            if self._turns_here(heading):
                self._turning = True
                return 0.0, 0.0
            if self.reached >= self._released:
                return 0.0, 0.0
        self._ahead = self._leg() - along
        speed = min(limits.speed, math.sqrt(2 * limits.acceleration * left), 3 * left)
        steer = 3.0 * error - 6.0 * across * min(1.0, speed / 0.1)
        return max(speed, 0.02), max(-limits.turn_rate, min(limits.turn_rate, steer))

    def _leg(self) -> float:
        return math.dist(self._points[self.reached - 1], self._points[self.reached])

    def _run_length(self, heading: float) -> float:
        """Returns the distance from the last point reached to the next corner or end [m]."""
        length, i = 0.0, self.reached
        while i < self._released and abs(_wrapped(_heading(self._points, i) - heading)) < 0.1:
            length += math.dist(self._points[i - 1], self._points[i])
            i += 1
        return length

    def _turns_here(self, heading: float) -> bool:
        if self.reached >= self._released:
            return False
        return abs(_wrapped(_heading(self._points, self.reached) - heading)) > 0.1


def _heading(points: Sequence[Point], i: int) -> float:
    """Returns the heading of the leg that ends at point i [rad]."""
    (x0, y0), (x1, y1) = points[i - 1], points[i]
    return math.atan2(y1 - y0, x1 - x0)


def _in_line(pose: Pose, start: Point, heading: float) -> Point:
    """How far the robot is along a line from its start, and to its left [m]."""
    dx, dy = pose[0] - start[0], pose[1] - start[1]
    c, s = math.cos(heading), math.sin(heading)
    return c * dx + s * dy, c * dy - s * dx


def _wrapped(angle: float) -> float:
    return math.remainder(angle, math.tau)


def _approach(value: float, goal: float, step: float) -> float:
    return value + max(-step, min(step, goal - value))
