# SPDX-License-Identifier: Apache-2.0
"""Pure pursuit: drives a robot along a path of points, by speeds. No ROS here.

    pursuit = PurePursuit([(0, 0), (3, 0), (3, 2)])
    while not pursuit.is_done:
        speed, turn_rate = pursuit.command((x, y, yaw))   # some twenty times a second

The robot steers for a point on the path a look-ahead distance before it, on the arc that leads
there: curvature 2 y / (x² + y²) for a point at (x, y) in its own frame (Coulter 1992).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

Point = tuple[float, float]  # [m]
Pose = tuple[float, float, float]  # x, y [m], yaw [rad]


@dataclass(frozen=True)
class Limits:
    """What the robot is asked for at most; less than a Kiva can do."""

    speed: float = 0.8  # [m/s]
    turn_rate: float = 1.5  # [rad/s]
    braking: float = 0.5  # towards the end of the path [m/s²]
    aside: float = 0.5  # across its heading, in bends [m/s²]
    look_ahead: float = 0.5  # [m]
    turns_first: float = math.radians(50)  # heading error from which it turns in place
    there: float = 0.01  # distance to the end at which it stops [m]


class PurePursuit:
    """The way along one path, from its first point to its last.

    `is_done` is true once the robot has passed the end, or stands there.
    """

    def __init__(self, points: Sequence[Point], limits: Limits | None = None) -> None:
        path = [point for i, point in enumerate(points) if i == 0 or point != points[i - 1]]
        if len(path) < 2:
            raise ValueError("a path of two different points, at least, was expected")
        self._limits = limits or Limits()
        self._path = path
        self._passed = [0.0]  # length of the path up to each point [m]
        for begin, end in zip(path, path[1:]):
            self._passed.append(self._passed[-1] + math.dist(begin, end))
        self._at = 0.0  # how far along the path the robot is [m]
        self.is_done = False

    @property
    def left(self) -> float:
        """Length of the path that is left [m]."""
        return self._passed[-1] - self._at

    def command(self, pose: Pose) -> tuple[float, float]:
        """Returns speed ahead [m/s] and turn rate to the left [rad/s] for that pose."""
        limits = self._limits
        self._advance(pose)
        if self.is_done or self.left <= limits.there:
            self.is_done = True
            return 0.0, 0.0
        ahead, aside = _seen_from(pose, self._point_at(self._at + limits.look_ahead))
        bearing = math.atan2(aside, ahead)
        if abs(bearing) > limits.turns_first:
            return 0.0, _within(2.5 * bearing, limits.turn_rate)
        curvature = 2 * aside / (ahead**2 + aside**2)
        speed = min(limits.speed, math.sqrt(2 * limits.braking * self.left))
        if curvature:
            speed = min(
                speed, math.sqrt(limits.aside / abs(curvature)), limits.turn_rate / abs(curvature)
            )
        return speed, speed * curvature

    def _advance(self, pose: Pose) -> None:
        """Moves along the path to the point nearest to the robot, at most a look-ahead on."""
        nearest, least = self._at, math.inf
        for i, (begin, end) in enumerate(zip(self._path, self._path[1:])):
            first, last = self._passed[i], self._passed[i + 1]
            if last < self._at or first > self._at + self._limits.look_ahead:
                continue
            along = _projected(begin, end, pose[:2])
            distance = math.dist(pose[:2], _between(begin, end, along))
            if distance < least:
                nearest, least = first + along * (last - first), distance
        self._at = max(self._at, min(nearest, self._at + self._limits.look_ahead))

    def _point_at(self, length: float) -> Point:
        """Returns the point after that length of the path [m]; beyond its end, straight on."""
        for i, (begin, end) in enumerate(zip(self._path, self._path[1:])):
            first, last = self._passed[i], self._passed[i + 1]
            if length <= last or i == len(self._path) - 2:
                return _between(begin, end, (length - first) / (last - first))
        raise AssertionError("a path has a last part")


def turn_to(yaw: float, now: float, limits: Limits | None = None) -> float:
    """Returns the turn rate [rad/s] towards a heading [rad]; 0 once it is within half a degree."""
    error = math.remainder(yaw - now, 2 * math.pi)
    if abs(error) < math.radians(0.5):
        return 0.0
    rate = _within(2 * error, (limits or Limits()).turn_rate)
    return math.copysign(max(abs(rate), 0.02), rate)


def _seen_from(pose: Pose, point: Point) -> Point:
    dx, dy = point[0] - pose[0], point[1] - pose[1]
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return c * dx + s * dy, c * dy - s * dx


def _projected(begin: Point, end: Point, point: Sequence[float]) -> float:
    """Returns the share of the way from begin to end that is nearest to a point, 0 to 1."""
    dx, dy = end[0] - begin[0], end[1] - begin[1]
    along = (point[0] - begin[0]) * dx + (point[1] - begin[1]) * dy
    return min(1.0, max(0.0, along / (dx * dx + dy * dy)))


def _between(begin: Point, end: Point, share: float) -> Point:
    return begin[0] + share * (end[0] - begin[0]), begin[1] + share * (end[1] - begin[1])


def _within(value: float, most: float) -> float:
    return max(-most, min(most, value))
