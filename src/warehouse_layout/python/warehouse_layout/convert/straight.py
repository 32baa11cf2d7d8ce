# SPDX-License-Identifier: Apache-2.0
"""Lays what was measured or drawn along a grid: by which angle, and from which corner."""

import math

import numpy as np

MOST_POINTS = 20_000  # of those that decide about the angle
GAIN = 1.05  # least factor by which an angle must improve on none
LEAST = 0.01  # degrees by which drawn lines are off the axes


def turned(points: np.ndarray, angle: float) -> np.ndarray:
    """Returns points x y (n, 2) turned about the origin by an angle [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def angle_of(points: np.ndarray, grain: float) -> float:
    """Returns the angle [rad] by which points of walls (n, 2) [m] must be turned.

    At the right one the walls lie along x and y, so that the points' coordinates fall into the
    fewest bins; a bin is as wide as the points' own grain [m]. Between -45 and 45 degrees.
    """
    points = points[:: max(1, len(points) // MOST_POINTS)]
    if len(points) < 10:
        return 0.0
    best = 0.0
    # From half degrees to hundredths.
    for step, reach in ((0.5, 45.0), (0.1, 0.6), (0.01, 0.12)):
        angles = best + np.arange(-reach, reach, step)
        best = float(angles[np.argmax([_sharpness(points, a, grain) for a in angles])])
    better = _sharpness(points, best, grain) > GAIN * _sharpness(points, 0.0, grain)
    return math.radians(best) if better else 0.0


def angle_of_lines(lines: np.ndarray) -> float:
    """Returns the angle [rad] by which lines x y (n, 2) must be turned: the longest lie along axes.

    Between -45 and 45 degrees.
    """
    lengths = np.hypot(*lines.T)
    angles = np.degrees(np.arctan2(lines[:, 1], lines[:, 0]))
    bins = np.bincount(np.round(angles % 90 * 10).astype(int) % 900, lengths, minlength=900)
    most = int(bins.argmax()) / 10
    off = (angles - most + 45) % 90 - 45
    near = np.abs(off) < 0.2
    degrees = most + np.average(off[near], weights=lengths[near]) if lengths.sum() else 0.0
    turn = -((degrees + 45) % 90 - 45)
    return math.radians(turn) if abs(turn) > LEAST else 0.0


def _sharpness(points: np.ndarray, degrees: float, grain: float) -> float:
    bins = np.floor(turned(points, math.radians(degrees)) / grain).astype(np.int64)
    counts = [np.bincount(axis - axis.min()) for axis in bins.T]
    return float(sum(np.sum(count.astype(float) ** 2) for count in counts))


def phase_of_centres(values: np.ndarray, spacing: float) -> tuple[float, float]:
    """Returns where cells' edges lie [m] for places with these centres, and how well they agree.

    The second is 1 where all centres are whole spacings apart, 0 where they are anywhere.
    """
    if not len(values):
        return 0.0, 1.0
    mean = np.exp(2j * math.pi * values / spacing).mean()
    centre = float(np.angle(mean)) / (2 * math.pi) * spacing
    return (centre - spacing / 2) % spacing, float(abs(mean))
