# SPDX-License-Identifier: Apache-2.0
"""Writes a world that runs as an SDF file: the texts of its models, where these stand now."""

import copy
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from warehouse_layout.file import files
from warehouse_layout.floor import poses
from warehouse_layout.models.sdf_world import name_of

UNKNOWN = -1  # index of a text that is not known
MODELS = ("model", "include", "actor")
SAME = 1e-6  # [m] and parts of a quaternion


@dataclass(frozen=True)
class Standing:
    """A model of the world that runs.

    document: the index of the text that it comes from, or UNKNOWN; original: its name there;
    written: its pose there; pose: its pose in the world now, both (7,).
    """

    name: str
    document: int
    original: str
    written: np.ndarray
    pose: np.ndarray


@dataclass(frozen=True)
class Saved:
    """An SDF text, the count of the models in it, and the names of those that it lacks."""

    xml: str
    models: int
    left_out: list[str]


def text_of(name: str, documents: Sequence[str], models: Sequence[Standing], folder: Path) -> Saved:
    """Returns the world `name` with these models.

    The first of the SDF texts is that of the world's own file, which lay in `folder`: light, grid
    and physics are taken from it. Models without a text are left out, as are those of URDF texts.
    """
    parsed = [_parsed(text) for text in documents]
    root = _surroundings(parsed[0] if parsed else None)
    world = root[0]
    world.set("name", name)
    by_name = [_models(tree) for tree in parsed]
    left_out = []
    for model in models:
        known = by_name[model.document] if model.document != UNKNOWN else {}
        element = known.get(model.original)
        if element is None:
            left_out.append(model.name)
            continue
        world.append(_placed(copy.deepcopy(element), model))
    _make_absolute(root, folder)
    xml = ElementTree.tostring(root, encoding="unicode")
    count = len(models) - len(left_out)
    return Saved(f'<?xml version="1.0"?>\n{xml}\n', count, left_out)


def _parsed(text: str) -> ElementTree.Element | None:
    """Returns the <sdf> of a text; None for URDF, and for a text that is not XML."""
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError:
        return None
    return root if root.tag == "sdf" else None


def _models(root: ElementTree.Element | None) -> dict[str, ElementTree.Element]:
    """Returns the models of an <sdf> by their names, whether in a <world> or without."""
    if root is None:
        return {}
    world = root.find("world")
    elements = root if world is None else world
    return {name_of(element): element for element in elements if element.tag in MODELS}


def _surroundings(root: ElementTree.Element | None) -> ElementTree.Element:
    """Returns a copy of a world without its models, and without poses that were saved in it."""
    if root is None or root.find("world") is None:
        root = ElementTree.parse(files.worlds() / "empty.sdf").getroot()
    out = ElementTree.Element("sdf", root.attrib)
    world = copy.deepcopy(root.find("world"))
    assert world is not None
    for element in [e for e in world if e.tag in (*MODELS, "state")]:
        world.remove(element)
    out.append(world)
    return out


def _placed(element: ElementTree.Element, model: Standing) -> ElementTree.Element:
    """Gives a model its present name and pose."""
    _rename(element, model.name)
    own = element.find("pose")
    is_plain = own is None or not own.attrib
    if is_plain and np.allclose(model.pose, model.written, rtol=0, atol=SAME):
        return element
    # What the text's pose leads to is its model's placement frame, not always the model itself.
    placement = _placement(own, model.written) if own is not None and is_plain else None
    pose = model.pose if placement is None else _within(model.pose, poses.inverse(placement))
    if own is None:
        own = ElementTree.SubElement(element, "pose")
    own.attrib.clear()
    own.text = " ".join(f"{number:.9g}" for number in _rows_of(pose))
    return element


def _placement(own: ElementTree.Element, written: np.ndarray) -> np.ndarray | None:
    """Returns the pose (1, 7) of a model in the frame that its text's pose places; None if the text
    can't be read."""
    try:
        numbers = [float(word) for word in (own.text or "").split()] or [0.0] * 6
    except ValueError:
        return None
    if len(numbers) != 6:
        return None
    text = np.array([*numbers[:3], *_quaternion(*numbers[3:])])[None]
    return poses.compose(poses.inverse(text), written[None])


def _within(frame: np.ndarray, inner: np.ndarray) -> np.ndarray:
    return poses.compose(frame[None], inner)[0]


def _rename(element: ElementTree.Element, name: str) -> None:
    if element.tag != "include":
        element.set("name", name)
        return
    own = element.find("name")
    if own is None:
        own = ElementTree.SubElement(element, "name")
    own.text = name


def _rows_of(pose: np.ndarray) -> list[float]:
    """Returns x y z [m] roll pitch yaw [rad] of a pose (7,)."""
    x, y, z, w = pose[3:].tolist()
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    return [*pose[:3].tolist(), float(roll), float(pitch), float(poses.yaw(pose[None])[0])]


def _quaternion(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """Returns the unit quaternion of the angles of SDF: about x, then y, then z, all fixed."""
    turns = np.zeros((3, 1, 4))
    for row, (axis, angle) in enumerate(((2, yaw), (1, pitch), (0, roll))):
        turns[row, 0, axis], turns[row, 0, 3] = np.sin(angle / 2), np.cos(angle / 2)
    return poses.multiply(poses.multiply(turns[0], turns[1]), turns[2])[0]


def _make_absolute(root: ElementTree.Element, folder: Path) -> None:
    """Gives files and models around the world's own file their whole paths: the new one lies
    elsewhere."""
    for uri in root.iter("uri"):
        text = (uri.text or "").strip()
        if path := _beside(text, folder):
            uri.text = str(path.resolve())


def _beside(uri: str, folder: Path) -> Path | None:
    """Returns the path of a URI that is found by the folder of a world alone."""
    if "://" not in uri:
        path = folder / uri
        return path if uri and path.exists() else None
    name = uri.removeprefix("model://")
    if name == uri or not name or (files.worlds() / "models" / name).exists():
        return None
    around = (f / part / name for f in (folder, *folder.parents) for part in ("", "models"))
    return next((path for path in around if path.exists()), None)
