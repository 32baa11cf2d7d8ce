# SPDX-License-Identifier: Apache-2.0
"""The models of a Layout, to be spawned: names, SDF texts and poses."""

import functools
import math
import re
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from warehouse_layout.file import files
from warehouse_layout.floor import floor_markings
from warehouse_layout.place.layout import Layout

FLOOR = "ground_plane"

# The kinds of models in a warehouse, in the order in which they are taken away: what is carried or
# lies on another model goes after it.
KINDS = ("kiva", "storage_unit", "item", "conveyor_belt")
MARKINGS = floor_markings.NAME
WALLS = "layout_walls"
PLACED = (*KINDS, WALLS, MARKINGS)  # all kinds of a warehouse, in the order in which they go
_NUMBERED = re.compile(rf"({'|'.join(PLACED)})(\d+)")

MOST_CHARACTERS = 8_000_000  # of a document: its service reads 10 MB
WALL_HEIGHT = 1.0  # [m]
BELT_LENGTH = 1.8  # [m], of its model

_INCLUDE = "<include><uri>model://{}</uri><name>{}</name><pose>{}</pose></include>"

_PLAIN_BELT = """<model name="{0}">
  <static>true</static>
  <pose>{1}</pose>
  <link name="body">
    <collision name="body">
      <pose>0 0 0.3 0 0 0</pose>
      <geometry><box><size>{2:.6g} 0.8 0.6</size></box></geometry>
    </collision>
    <visual name="frame">
      <pose>0 0 0.295 0 0 0</pose>
      <geometry><box><size>{2:.6g} 0.8 0.59</size></box></geometry>
      <material><diffuse>0.95 0.75 0.10 1</diffuse></material>
    </visual>
    <visual name="belt">
      <pose>0 0 0.595 0 0 0</pose>
      <geometry><box><size>{2:.6g} 0.7 0.01</size></box></geometry>
      <material><diffuse>0.13 0.13 0.14 1</diffuse></material>
    </visual>
  </link>
</model>"""

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
    marks = floor_markings.models_of(layout.plan) if layout.plan else ()
    return [
        *(floor if layout.has_own_floor else []),
        *(Part(*mark) for mark in marks),
        *([Part(f"{WALLS}1", _walls(layout.walls))] if len(layout.walls) else []),
        *_belts(layout),
        *_numbered("storage_unit", layout.units),
        *_items(on_unit + layout.item_place, layout.item_mass),
        *_numbered("kiva", layout.robots[:, :2], layout.robots[:, 2]),
    ]


def _walls(boxes: np.ndarray) -> str:
    """Returns the SDF text of a static model of boxes x y size_x size_y [m], (n, 4)."""
    parts = []
    for i, (x, y, wide, deep) in enumerate(boxes.tolist()):
        pose = f"<pose>{x:.6g} {y:.6g} {WALL_HEIGHT / 2:g} 0 0 0</pose>"
        box = f"<geometry><box><size>{wide:.6g} {deep:.6g} {WALL_HEIGHT:g}</size></box></geometry>"
        parts.append(
            f'<collision name="{i}">{pose}{box}</collision><visual name="{i}">{pose}{box}'
            "<material><diffuse>0.62 0.60 0.57 1</diffuse></material></visual>"
        )
    links = f'<link name="walls">{"".join(parts)}</link>'
    return f'<model name="{WALLS}1"><static>true</static>{links}</model>'


def _belts(layout: Layout) -> list[Part]:
    """Returns the Parts of belts; one of another length than its model's is a plain one."""
    parts = _numbered("conveyor_belt", layout.belts[:, :2], layout.belts[:, 2])
    if layout.belt_lengths is None:
        return parts
    lengths = layout.belt_lengths.tolist()
    for i, (length, (x, y, yaw)) in enumerate(zip(lengths, layout.belts.tolist())):
        if abs(length - BELT_LENGTH) > 1e-6:
            name = parts[i].name
            xml = _PLAIN_BELT.format(name, f"{x!r} {y!r} 0 0 0 {yaw!r}", length)
            parts[i] = Part(name, xml)
    return parts


def _items(places: np.ndarray, masses: np.ndarray | None) -> list[Part]:
    """Returns the Parts of items; one of another mass than its model's has its model in it."""
    parts = _numbered("item", places)
    for i, mass in enumerate([] if masses is None else masses.tolist()):
        if not math.isnan(mass):
            parts[i] = Part(parts[i].name, _weighed(parts[i].name, places[i].tolist(), mass))
    return parts


def _weighed(name: str, place: list[float], mass: float) -> str:
    """Returns the model of an item at a place in `world` with another mass [kg]; its inertia is
    that of the same body of another density."""
    text, own_mass, moments = _item_model()
    x, y, z = place
    inertia = "".join(f"<{k}>{v * mass / own_mass:.6g}</{k}>" for k, v in moments.items())
    inertial = f"<mass>{mass!r}</mass><inertia>{inertia}</inertia>"
    return text.format(name=name, pose=f"{x!r} {y!r} {z!r} 0 0 0", inertial=inertial)


@functools.cache
def _item_model() -> tuple[str, float, dict[str, float]]:
    """Returns the text of the model of an item, with places for its name, pose and inertial; its
    mass [kg], and its moments of inertia [kg m2]."""
    model = ElementTree.parse(files.model("item")).getroot().find("model")
    assert model is not None
    inertial = model.find("link/inertial")
    assert inertial is not None
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    assert mass is not None and inertia is not None
    moments = {part.tag: float(part.text or 0) for part in inertia}
    own_mass = float(mass.text or 0)
    inertial.remove(inertia)
    inertial.remove(mass)
    inertial[-1].tail = "{inertial}"
    for part in model.iter():
        part.text, part.tail = (part.text or "").strip(), (part.tail or "").strip()
    model.set("name", "{name}")
    pose = ElementTree.Element("pose")
    pose.text = "{pose}"
    model.insert(0, pose)
    return ElementTree.tostring(model, "unicode"), own_mass, moments


def _numbered(kind: str, places: np.ndarray, yaws: np.ndarray | None = None) -> list[Part]:
    """Returns Parts of one kind at places (n, 2) or (n, 3), numbered from 1."""
    yaws = np.zeros(len(places)) if yaws is None else yaws
    rows = np.column_stack([places, np.zeros((len(places), 3 - places.shape[1])), yaws])
    return [include(kind, i, *row) for i, row in enumerate(rows.tolist(), start=1)]


def include(kind: str, number: int, x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> Part:
    """Returns the Part of one model of worlds/models, at a place in `world` [m, rad]."""
    name = f"{kind}{number}"
    return Part(name, _INCLUDE.format(kind, name, f"{x!r} {y!r} {z!r} 0 0 {yaw!r}"))


def documents(parts: Iterable[Part]) -> Iterator[str]:
    """Yields SDF texts with all the Parts, none longer than the world reads."""
    return map(document, batches(parts))


def batches(parts: Iterable[Part], most: int = sys.maxsize) -> Iterator[list[Part]]:
    """Yields all the Parts in lists of at most `most`, for documents that the world reads."""
    batch: list[Part] = []
    size = 0
    for part in parts:
        if batch and (len(batch) == most or size + len(part.xml) > MOST_CHARACTERS):
            yield batch
            batch, size = [], 0
        batch.append(part)
        size += len(part.xml)
    if batch:
        yield batch


def document(parts: Iterable[Part]) -> str:
    """Returns one SDF text of all the Parts."""
    xml = "".join(part.xml for part in parts)
    return f'<sdf version="1.9"><world name="warehouse">{xml}</world></sdf>'
