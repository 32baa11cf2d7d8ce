# SPDX-License-Identifier: Apache-2.0
"""Whether a vehicle is where it should be: jumps, ways that it has left, places that it misses."""

import math
from collections.abc import Sequence

from warehouse_vda5050.driver import Point
from warehouse_vda5050.master.frame import Pose

JUMP = 1.0  # largest distance between two states beyond what the time allows [m]
FASTEST = 3.0  # that a vehicle drives if its factsheet does not say more [m/s]
NEAR = 0.05  # largest distance from a place where it has to stand exactly [m]
SQUARE = 0.05  # largest error of a heading [rad]


def jumped(before: Pose, now: Pose, seconds: float, fastest: float = FASTEST) -> str:
    """Returns where a vehicle jumped from and to, '' if it can have driven that in the time, at
    its `fastest` [m/s]."""
    way = math.dist(before[:2], now[:2])
    if way <= JUMP + fastest * max(0.0, seconds):
        return ""
    return (
        f"the vehicle jumped {way:.1f} m, from {before[0]:.2f}, {before[1]:.2f}"
        f" to {now[0]:.2f}, {now[1]:.2f}"
    )


def is_elsewhere(before: Pose, now: Pose) -> bool:
    """Returns whether a vehicle that stands was put straight, or anywhere else."""
    turn = abs(math.remainder(now[2] - before[2], math.tau))
    return math.dist(before[:2], now[:2]) > NEAR or turn > SQUARE


def left_way(pose: Pose, points: Sequence[Point], within: float) -> str:
    """Returns the text of a vehicle's distance from its path; '' up to `within` [m]."""
    off = distance(pose, points)
    if off <= within:
        return ""
    return f"the vehicle is {off:.1f} m off its path, at {pose[0]:.2f}, {pose[1]:.2f}"


def distance(pose: Pose, points: Sequence[Point]) -> float:
    """Returns the distance of a pose from a path, whose stretches are along one axis [m]."""
    stretches = [*zip(points, points[1:])] or [(points[0], points[0])]
    return min(_from_stretch(pose, a, b) for a, b in stretches)


def _from_stretch(pose: Pose, a: Point, b: Point) -> float:
    beyond = [max(min(p, q) - c, c - max(p, q), 0.0) for c, p, q in zip(pose[:2], a, b)]
    return math.hypot(*beyond)


def square(yaw: float) -> float:
    """Returns the nearest heading along an axis [rad]."""
    return math.remainder(round(yaw / (math.pi / 2)) * math.pi / 2, math.tau)


def missed(pose: Pose, point: Point) -> str:
    """Returns how a vehicle that says to stand at a point misses it, '' if it does not."""
    off = math.dist(pose[:2], point)
    askew = abs(math.remainder(pose[2] - square(pose[2]), math.tau))
    if off <= NEAR and askew <= SQUARE:
        return ""
    return f"the vehicle ended its order {off:.2f} m off the node and {askew:.2f} rad askew"
