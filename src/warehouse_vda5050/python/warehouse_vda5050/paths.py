# SPDX-License-Identifier: Apache-2.0
"""Paths that vehicles of 3.0.0 say they plan (6.8): NURBS and polylines, as plain values."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

Point = tuple[float, float]  # [m] in the frame of the map
SAMPLES = 8  # points of each piece of a curve
MAX_POINTS = 1000  # of one path
STRAIGHT = 0.05  # headings within this of one another are those of one line [rad]


@dataclass(frozen=True)
class Trajectory:
    """A NURBS: knots in 0 … 1, `degree` + 1 more than points; weights as many as points."""

    degree: int
    knots: tuple[float, ...]
    points: tuple[Point, ...]
    weights: tuple[float, ...]


@dataclass(frozen=True)
class PlannedPath:
    """The way along an order, and the ids of its nodes that are passed on it."""

    trajectory: Trajectory
    nodes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Waypoint:
    """A point that is reached at a time [s since 1970]; theta: the heading there [rad]."""

    x: float
    y: float
    eta: float
    theta: float | None = None


def straight(points: Sequence[Point]) -> Trajectory:
    """Returns the NURBS of degree 1 through some points, with straight lines between them."""
    count = len(points)
    inner = [k / (count - 1) for k in range(count)]
    return Trajectory(1, (0.0, *inner, 1.0), tuple(points), (1.0,) * count)


def fault_of(curve: Trajectory) -> str:
    """Returns why the numbers are no NURBS, '' if they are one."""
    count, degree = len(curve.points), curve.degree
    if not 1 <= degree < count <= MAX_POINTS:
        return f"{count} control points; more than the degree, {degree}, and at most {MAX_POINTS}"
    if len(curve.knots) != count + degree + 1:
        return f"{len(curve.knots)} knots; {count + degree + 1} were expected"
    if any(a > b for a, b in itertools.pairwise(curve.knots)):
        return "a knot is smaller than the one before it"
    if min(curve.weights) <= 0:
        return "a weight is not above 0"
    return ""


def sampled(curve: Trajectory) -> list[Point]:
    """Returns points along a NURBS: its corners where it is of degree 1, else SAMPLES a piece."""
    if curve.degree == 1:
        return [*curve.points]
    knots = curve.knots[curve.degree : len(curve.points) + 1]
    out: list[Point] = []
    for a, b in itertools.pairwise(knots):
        if b > a:
            out += [_at(curve, a + (b - a) * k / SAMPLES) for k in range(SAMPLES)]
    return [*out, _at(curve, knots[-1])]


def _at(curve: Trajectory, u: float) -> Point:
    """Returns a point of a curve (de Boor, 1972), by homogeneous coordinates."""
    p, knots = curve.degree, curve.knots
    last = len(curve.points) - 1
    k = next((i for i in range(p, last + 1) if u < knots[i + 1]), last)
    while k > p and knots[k] == knots[k + 1]:
        k -= 1
    rows = [
        (w * x, w * y, w)
        for (x, y), w in zip(curve.points[k - p : k + 1], curve.weights[k - p : k + 1])
    ]
    for r in range(1, p + 1):
        for j in range(p, r - 1, -1):
            low, high = knots[j + k - p], knots[j + 1 + k - r]
            share = (u - low) / (high - low) if high > low else 0.0
            a, b = rows[j - 1], rows[j]
            rows[j] = (_mix(a[0], b[0], share), _mix(a[1], b[1], share), _mix(a[2], b[2], share))
    x, y, w = rows[p]
    return x / w, y / w


def _mix(a: float, b: float, share: float) -> float:
    return a + share * (b - a)


@dataclass(frozen=True)
class Motion:
    """What arrival times are estimated from: top speed [m/s], acceleration and deceleration
    [m/s²], and the time of a quarter turn [s]."""

    speed: float
    acceleration: float
    deceleration: float
    quarter_turn: float


@dataclass(frozen=True)
class _Leg:
    """A straight way; limit: the highest speed on it [m/s]."""

    end: Point
    length: float
    heading: float
    limit: float


def waypoints(
    points: Sequence[Point],
    limits: Sequence[float],
    yaw: float,
    speed: float,
    motion: Motion,
    begin: float,
) -> list[Waypoint]:
    """Returns when a robot that drives at a speed [m/s] from points[0] is at each corner of its
    way, and where its limit changes; it stops to turn, and at the end. limits: the highest speed
    on the way to each further point [m/s]. begin: the time now [s since 1970]."""
    out, now = [Waypoint(*points[0], begin, yaw)], begin
    for heading, straight in itertools.groupby(_legs(points, limits, motion), _heading):
        turn = abs(math.remainder(heading - yaw, math.tau))
        if turn > 0.1:
            now, speed = now + turn / (math.pi / 2) * motion.quarter_turn, 0.0
        legs = [*straight]
        for leg, seconds in zip(legs, _times(legs, speed, motion)):
            now += seconds
            out.append(Waypoint(*leg.end, now, heading))
        yaw, speed = heading, 0.0
    return out


def _heading(leg: _Leg) -> float:
    return leg.heading


def _legs(points: Sequence[Point], limits: Sequence[float], motion: Motion) -> list[_Leg]:
    """Returns a way's straight pieces of one limit; those of one line have the same heading."""
    legs: list[_Leg] = []
    start = points[0]
    for point, speed in zip(points[1:], limits):
        length, limit = math.dist(start, point), min(speed, motion.speed)
        if length < 1e-6:
            continue
        heading = math.atan2(point[1] - start[1], point[0] - start[0])
        if legs and abs(math.remainder(heading - legs[-1].heading, math.tau)) < STRAIGHT:
            heading = legs[-1].heading
            if limit == legs[-1].limit:
                length += legs.pop().length
        legs.append(_Leg(point, length, heading, limit))
        start = point
    return legs


def _times(legs: Sequence[_Leg], speed: float, motion: Motion) -> list[float]:
    """Returns how long each piece of a straight way takes that begins at a speed and ends at a
    stop [s]."""
    up, down = motion.acceleration, motion.deceleration
    ends = [0.0]  # the speed at each piece's end, from the last one back
    for leg in reversed(legs[1:]):
        ends.append(min(leg.limit, math.sqrt(ends[-1] ** 2 + 2 * down * leg.length)))
    times = []
    for leg, slowed in zip(legs, reversed(ends)):
        speed = min(speed, leg.limit)
        end = min(slowed, leg.limit, math.sqrt(speed * speed + 2 * up * leg.length))
        # The speed at which braking begins, if the piece is too short for its limit.
        peak = (2 * up * down * leg.length + down * speed**2 + up * end**2) / (up + down)
        peak = max(speed, end, min(math.sqrt(peak), leg.limit))
        rest = leg.length - (peak**2 - speed**2) / (2 * up) - (peak**2 - end**2) / (2 * down)
        cruise = max(0.0, rest) / peak if peak > 0 else 0.0
        times.append((peak - speed) / up + (peak - end) / down + cruise)
        speed = end
    return times


def corners(points: Sequence[Point]) -> list[Point]:
    """Returns the points of a way without those in the middle of a straight line."""
    kept: list[Point] = []
    for point in points:
        if kept and math.dist(kept[-1], point) < 1e-6:
            continue
        if len(kept) > 1 and _in_line(kept[-2], kept[-1], point):
            kept[-1] = point
        else:
            kept.append(point)
    return kept


def _in_line(a: Point, b: Point, c: Point) -> bool:
    cross = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
    ahead = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1])
    return ahead > 0 and abs(cross) <= STRAIGHT * ahead
