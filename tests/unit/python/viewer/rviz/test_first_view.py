# SPDX-License-Identifier: Apache-2.0
"""RViz begins with all that stands in its picture."""

import math

import numpy as np
import pytest
import yaml

from warehouse_layout.file.request import PRESETS, resolve
from warehouse_layout.generate.generated import plan
from warehouse_viewer.rviz import first_view
from warehouse_viewer.shared_files import RVIZ_CONFIG

CONFIG = RVIZ_CONFIG.read_text(encoding="utf-8")


def seen(view, points):
    """Where in RViz's picture points (n, 2) on the floor are: (n, 2) within -1 … 1 if they are in
    it. As its orbit view has it: the eye is off the focal point by distance, yaw and pitch."""
    pitch, yaw = view["Pitch"], view["Yaw"]
    focus = np.array([view["Focal Point"][axis] for axis in "XYZ"], float)
    out = np.array([math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch)])
    out = np.append(out, math.sin(pitch))
    right = np.cross([0, 0, 1], out) / math.cos(pitch)
    up = np.cross(out, right)
    from_eye = np.pad(points, ((0, 0), (0, 1))) - focus - view["Distance"] * out
    depth = from_eye @ -out
    half = math.tan(view["Field of View"] / 2)
    return np.column_stack(
        [from_eye @ right / depth / half / first_view.ASPECT, from_eye @ up / depth / half]
    )


def view_of(points, floor=(-5, 5, -5, 5)):
    result = yaml.safe_load(first_view.config(CONFIG, first_view.around(points, floor)))
    return result["Visualization Manager"]["Views"]["Current"]


def points_of(name):
    layout = plan(resolve(name))
    return np.concatenate([layout.robots[:, :2], layout.units, layout.belts[:, :2]])


@pytest.mark.parametrize("name", [name for name in PRESETS if name != "empty"])
@pytest.mark.parametrize("moved", [(0, 0), (-340, 75)])
def test_everything_is_in_the_picture_and_fills_it(name, moved):
    points = points_of(name) + moved
    at = np.abs(seen(view_of(points), points))
    assert at.max() <= 1
    assert at.max() > 0.6


def test_without_anything_the_floor_is():
    view = view_of(np.zeros((0, 2)), floor=(10, 60, -20, 20))
    assert (view["Focal Point"]["X"], view["Focal Point"]["Y"]) == (35, 0)
    assert view["Distance"] > 40
