# SPDX-License-Identifier: Apache-2.0
"""A Layout as the models to spawn: names, SDF texts and poses."""

import re
from dataclasses import dataclass

import numpy as np

from warehouse_sim import poses

FLOOR = "ground_plane"

# Of everything that a warehouse consists of, in the order in which it is taken away: what is
# carried or lies on something goes after it.
KINDS = ("kiva", "storage_unit", "item", "conveyor_belt")
_NUMBERED = re.compile(rf"({'|'.join(KINDS)})(\d+)")

# Equal texts are parsed once by the world, so the name and the pose travel beside them.
_INCLUDE = """<sdf version="1.9"><world name="spawn">
  <include><uri>model://{}</uri></include>
</world></sdf>"""

_FLOOR = """<sdf version="1.9"><model name="ground_plane">
  <static>true</static>
  <link name="floor">
    <collision name="floor">
      <geometry><plane><normal>0 0 1</normal><size>{0:g} {1:g}</size></plane></geometry>
      <surface><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface>
    </collision>
    <visual name="floor">
      <geometry><plane><normal>0 0 1</normal><size>{0:g} {1:g}</size></plane></geometry>
      <material><diffuse>0.80 0.80 0.82 1</diffuse></material>
    </visual>
  </link>
</model></sdf>"""


@dataclass(frozen=True)
class Model:
    """One to spawn; the pose is a row as in poses.py."""

    name: str
    xml: str
    pose: np.ndarray


def kind_and_number(name):
    """("storage_unit", 7) of `storage_unit7`; (None, 0) of what belongs to no warehouse."""
    match = _NUMBERED.fullmatch(name)
    return (match[1], int(match[2])) if match else (None, 0)


def of_layout(layout):
    """All models of a Layout: the floor first, then what stands on it, items after their units."""
    units = _planar(layout.units)
    places = np.pad(layout.item_place, ((0, 0), (0, 4)))
    places[:, 6] = 1
    return [
        Model(FLOOR, _FLOOR.format(*layout.floor.size), poses.planar(*layout.floor.centre, 0)),
        *_numbered("conveyor_belt", _planar(layout.belts)),
        *_numbered("storage_unit", units),
        *_numbered("item", poses.compose(units[layout.item_unit], places)),
        *_numbered("kiva", _planar(layout.robots)),
    ]


def _planar(points):
    """Pose rows of (n, 2) x y or (n, 3) x y yaw."""
    yaws = points[:, 2] if points.shape[1] == 3 else np.zeros(len(points))
    out = [poses.planar(x, y, yaw) for (x, y), yaw in zip(points[:, :2], yaws)]
    return np.array(out).reshape(-1, 7)


def _numbered(kind, rows):
    xml = _INCLUDE.format(kind)
    return [Model(f"{kind}{i}", xml, pose) for i, pose in enumerate(rows, start=1)]
