# SPDX-License-Identifier: Apache-2.0
"""World files, read in order to add their models to a running world."""

import math
import os
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Collection
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from warehouse_layout.file import user_file
from warehouse_layout.models.models import FLOOR, kind_and_number


class WorldFileError(ValueError):
    """Names the file that does not exist or holds no SDF."""


def find(world: str, worlds: str | Path, cwd: str | Path | None = None) -> Path:
    """Returns the file of a world, given by a path or by a name in the folder `worlds`.

    A relative path is looked up from `cwd`: PWD by default, because roslaunch starts its nodes in
    another folder than the one in which the command was typed. Raises WorldFileError.
    """
    base = Path(cwd) if cwd else Path(os.environ.get("PWD", "."))
    tried = [base / world, Path(worlds) / world, Path(worlds) / f"{world}.sdf"]
    for path in tried:
        if path.is_file():
            return path
    raise WorldFileError(f"there is no world '{world}'; tried {', '.join(map(str, tried))}")


@dataclass(frozen=True)
class Insertion:
    """The models of a world file, ready to be added to a world: SDF text and names.

    Robots, storage units, items and belts whose name is taken get the lowest free number: `renamed`
    maps a name in the file to the new one. `left_out` names floors: the world keeps its own.
    """

    xml: str
    names: list[str]
    renamed: dict[str, str]
    left_out: list[str]


def insertable(
    path: str | Path,
    standing: Collection[str],
    at: tuple[float, float] = (0.0, 0.0),
    yaw: float = 0.0,
) -> Insertion:
    """Returns the Insertion of a world file into a world that holds the models `standing`.

    The file's models are turned by `yaw` [rad] about the origin and then moved by `at` (x, y) [m].
    Raises WorldFileError if the file can't be read, or has other models whose names are taken.
    """
    root, world = _parse(path)
    left_out = _leave_out_floors(world, FLOOR in standing)
    elements = [e for e in world if e.tag in ("model", "include")]
    taken = {_name(e) for e in elements if not kind_and_number(_name(e))[0]} & set(standing)
    if taken:
        raise WorldFileError(
            f"{path}: nothing was added, for these stand in the world already:"
            f" {', '.join(sorted(taken))}"
        )
    renamed = _free_names([_name(e) for e in elements], standing)
    for element in elements:
        _rename(element, renamed)
        _move(path, element, at, yaw)
    for element in world.iter():
        frame = element.get("relative_to")
        if frame in renamed:
            element.set("relative_to", renamed[frame])
    xml = ElementTree.tostring(root, encoding="unicode")
    return Insertion(xml, [_name(e) for e in elements], renamed, left_out)


def _parse(path: str | Path) -> tuple[ElementTree.Element, ElementTree.Element]:
    """Returns the root of a file, and the <world> in it."""
    try:
        root = user_file.read_xml(path)
    except OSError as error:
        raise WorldFileError(f"{path}: {error.strerror}") from error
    except ElementTree.ParseError as error:
        raise WorldFileError(f"{path} is not XML: {error}") from error
    world = root.find("world") if root.tag == "sdf" else None
    if world is None:
        raise WorldFileError(f"{path} holds no <sdf> with a <world>")
    return root, world


def _leave_out_floors(world: ElementTree.Element, stands: bool) -> list[str]:
    """Removes all floors but one, or all if the world has one already; returns their names."""
    floors = [e for e in world if e.tag in ("model", "include") and _is_floor(e)]
    spare = floors if stands else floors[1:]
    for element in spare:
        world.remove(element)
    return [_name(element) for element in spare]


def _is_floor(element: ElementTree.Element) -> bool:
    uri = element.findtext("uri", "").strip().rstrip("/")
    return _name(element) == FLOOR or uri.rpartition("/")[2] == FLOOR


def _free_names(names: Collection[str], standing: Collection[str]) -> dict[str, str]:
    """Maps each numbered name that is taken to the one with the lowest free number."""
    used = {*names, *standing}
    out: dict[str, str] = {}
    for name in names:
        kind, _ = kind_and_number(name)
        if not kind or name not in standing:
            continue
        free = next(n for n in map(f"{kind}{{}}".format, count(1)) if n not in used)
        used.add(free)
        out[name] = free
    return out


def _move(
    path: str | Path, element: ElementTree.Element, at: tuple[float, float], yaw: float
) -> None:
    """Moves a model or an include, unless its pose is relative to another one."""
    pose = element.find("pose")
    if not (any(at) or yaw) or (pose is not None and pose.get("relative_to", "world") != "world"):
        return
    if pose is None:
        pose = ElementTree.SubElement(element, "pose")
    try:
        x, y, z, roll, pitch, own_yaw = map(float, (pose.text or "0 0 0 0 0 0").split())
    except ValueError:
        raise WorldFileError(
            f"{path}: the pose of {_name(element)} is '{pose.text}'; 6 numbers were expected"
        ) from None
    x, y = (
        at[0] + x * math.cos(yaw) - y * math.sin(yaw),
        at[1] + x * math.sin(yaw) + y * math.cos(yaw),
    )
    pose.text = f"{x!r} {y!r} {z!r} {roll!r} {pitch!r} {own_yaw + yaw!r}"


def _name(element: ElementTree.Element) -> str:
    """Returns the name of a <model> or an <include>, which by default is that of its file."""
    if element.tag == "include":
        uri = element.findtext("uri", "").strip()
        return element.findtext("name", uri.removeprefix("model://")).strip()
    return element.get("name", "")


def _rename(element: ElementTree.Element, renamed: dict[str, str]) -> None:
    name = renamed.get(_name(element))
    if not name:
        return
    if element.tag == "model":
        element.set("name", name)
        return
    tag = element.find("name")
    if tag is None:
        tag = ElementTree.SubElement(element, "name")
    tag.text = name


def with_values(text: str, **values: float) -> str:
    """Returns an SDF text with other values in elements of these names, each of which is there
    once. Raises ValueError for another one."""
    for name, value in values.items():
        text, count = re.subn(rf"<{name}>[^<]*</{name}>", f"<{name}>{value!r}</{name}>", text)
        if count != 1:
            raise ValueError(f"<{name}> is there {count} times; once was expected")
    return text
