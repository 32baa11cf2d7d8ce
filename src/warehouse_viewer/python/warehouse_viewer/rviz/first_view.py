# SPDX-License-Identifier: Apache-2.0
"""The view with which RViz begins: all that stands, from obliquely above."""

import math
from collections.abc import Sequence

import numpy as np
import yaml

FIELD = math.pi / 4  # RViz's vertical field of view [rad]
ASPECT = 1.0  # least of its picture, beside the panels
PITCH, YAW = 0.9, -math.pi / 2  # it looks along y, downwards [rad]
MARGIN = 2.0  # around what stands [m]
NEAREST = 8.0  # [m]


def around(points: np.ndarray, fallback: Sequence[float]) -> tuple[float, ...]:
    """Returns min_x, max_x, min_y, max_y [m] around points (n, 2); without any `fallback`."""
    if not len(points):
        return tuple(fallback)
    (x0, y0), (x1, y1) = np.min(points, 0) - MARGIN, np.max(points, 0) + MARGIN
    return float(x0), float(x1), float(y0), float(y1)


def distance(bounds: Sequence[float]) -> float:
    """Returns the distance from the bounds' centre at which the camera sees all of them [m]."""
    x0, x1, y0, y1 = bounds
    high = math.tan(FIELD / 2)  # of the picture's upper half, at a distance of 1
    half_x, half_y = (x1 - x0) / 2, (y1 - y0) / 2
    # The nearer edge is the wider one, and the lower one of the picture.
    towards, across = half_y * math.cos(PITCH), half_y * math.sin(PITCH)
    return max(NEAREST, towards + across / high, towards + half_x / (high * ASPECT))


def config(text: str, bounds: Sequence[float]) -> str:
    """Returns the RViz configuration `text` with its views set to show the bounds."""
    settings = yaml.safe_load(text)
    x, y = (bounds[0] + bounds[1]) / 2, (bounds[2] + bounds[3]) / 2
    views = settings["Visualization Manager"]["Views"]
    views["Current"] |= {
        "Focal Point": {"X": x, "Y": y, "Z": 0},
        "Distance": distance(bounds),
        "Pitch": PITCH,
        "Yaw": YAW,
    }
    wide = max(bounds[1] - bounds[0], ASPECT * (bounds[3] - bounds[2]))
    for view in views["Saved"]:
        view |= {"X": x, "Y": y, "Scale": 1400 / wide}
    return yaml.safe_dump(settings, sort_keys=False)
