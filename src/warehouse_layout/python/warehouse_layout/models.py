# SPDX-License-Identifier: Apache-2.0
"""The models of a Layout, to be spawned: names, SDF texts and poses."""

import re
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from warehouse_layout import floor_markings
from warehouse_layout.layout import Layout

FLOOR = "ground_plane"

# The kinds of models in a warehouse, in the order in which they are taken away: what is carried or
# lies on another model goes after it.
KINDS = ("kiva", "storage_unit", "item", "conveyor_belt")
MARKINGS = floor_markings.NAME
_NUMBERED = re.compile(rf"({'|'.join((*KINDS, MARKINGS))})(\d+)")

_INCLUDE = "<include><uri>model://{}</uri><name>{}</name><pose>{}</pose></include>"

_FLOOR = """<model name="ground_plane">
  <static>true</static>
  <pose>{0[0]!r} {0[1]!r} 0 0 0 0</pose>
  <link name="floor">
    <collision name="floor">
      <geometry><plane><normal>0 0 1</normal><size>{1[0]!r} {1[1]!r}</size></plane></geometry>
      <surface><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface>
    </collision>
    <visual name="floor">
      <geometry><plane><normal>0 0 1</normal><size>{1[0]!r} {1[1]!r}</size></plane></geometry>
      <material><diffuse>0.80 0.80 0.82 1</diffuse></material>
    </visual>
  </link>
</model>"""


class Part(NamedTuple):
    """One model of an SDF document."""

    name: str
    xml: str


def kind_and_number(name: str) -> tuple[str | None, int]:
    """Returns ("storage_unit", 7) for `storage_unit7`; (None, 0) for names of other models."""
    match = _NUMBERED.fullmatch(name)
    return (match[1], int(match[2])) if match else (None, 0)


def of_layout(layout: Layout) -> list[Part]:
    """Returns the Parts of a Layout.

    Its own floor and the markings on it come first, items after the units on which they lie.
    """
    on_unit = np.pad(layout.units, ((0, 0), (0, 1)))[layout.item_unit]
    floor = [Part(FLOOR, _FLOOR.format(layout.floor.centre, layout.floor.size))]
    marks = f"{MARKINGS}1"
    return [
        *(floor if layout.has_own_floor else []),
        *([Part(marks, floor_markings.sdf(layout.plan, marks))] if layout.plan else []),
        *_numbered("conveyor_belt", layout.belts[:, :2], layout.belts[:, 2]),
        *_numbered("storage_unit", layout.units),
        *_numbered("item", on_unit + layout.item_place),
        *_numbered("kiva", layout.robots[:, :2], layout.robots[:, 2]),
    ]


def _numbered(kind: str, places: np.ndarray, yaws: np.ndarray | None = None) -> list[Part]:
    """Returns Parts of one kind at places (n, 2) or (n, 3), numbered from 1."""
    yaws = np.zeros(len(places)) if yaws is None else yaws
    rows = np.column_stack([places, np.zeros((len(places), 3 - places.shape[1])), yaws])
    return [include(kind, i, *row) for i, row in enumerate(rows.tolist(), start=1)]


def include(kind: str, number: int, x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> Part:
    """Returns the Part of one model of worlds/models, at a place in `world` [m, rad]."""
    name = f"{kind}{number}"
    return Part(name, _INCLUDE.format(kind, name, f"{x!r} {y!r} {z!r} 0 0 {yaw!r}"))


def document(parts: Iterable[Part]) -> str:
    """Returns one SDF text of all the Parts."""
    xml = "".join(part.xml for part in parts)
    return f'<sdf version="1.9"><world name="warehouse">{xml}</world></sdf>'
