# SPDX-License-Identifier: Apache-2.0
"""World files, as far as it takes to add one to the world that runs."""

import os
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from warehouse_layout.models import FLOOR, kind_and_number


class WorldFileError(ValueError):
    """No such file, or no SDF in it; the message names the file."""


def find(world, worlds, cwd=None):
    """The file that `world` means: a path, or a name in the folder `worlds`. Or WorldFileError.

    A relative path is looked up from `cwd`: PWD by default, because roslaunch starts its nodes in
    another folder than the one in which a person typed.
    """
    cwd = Path(cwd or os.environ.get("PWD", "."))
    tried = [cwd / world, Path(worlds) / world, Path(worlds) / f"{world}.sdf"]
    for path in tried:
        if path.is_file():
            return path
    raise WorldFileError(f"there is no world '{world}'; tried {', '.join(map(str, tried))}")


@dataclass(frozen=True)
class Insertion:
    """What a world file adds to a world: its SDF text, and the names of its models there.

    Robots, storage units, items and belts whose name is taken get the lowest free number: `renamed`
    maps names in the file to theirs. `left_out` names floors: the world keeps its own.
    """

    xml: str
    names: list
    renamed: dict
    left_out: list


def insertable(path, standing):
    """The Insertion of a world file where the models `standing` stand already.

    Raises WorldFileError, where other models have their names too.
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
    for element in world.iter():
        if element.get("relative_to") in renamed:
            element.set("relative_to", renamed[element.get("relative_to")])
    xml = ElementTree.tostring(root, encoding="unicode")
    return Insertion(xml, [_name(e) for e in elements], renamed, left_out)


def _parse(path):
    """The root of a file, and the <world> in it."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise WorldFileError(f"{path} is no XML: {error}") from error
    world = root.find("world") if root.tag == "sdf" else None
    if world is None:
        raise WorldFileError(f"{path} holds no <sdf> with a <world>")
    return root, world


def _leave_out_floors(world, stands):
    """Takes all floors but one out, or all if one stands there; returns their names."""
    floors = [e for e in world if e.tag in ("model", "include") and _is_floor(e)]
    spare = floors if stands else floors[1:]
    for element in spare:
        world.remove(element)
    return [_name(element) for element in spare]


def _is_floor(element):
    uri = element.findtext("uri", "").strip().rstrip("/")
    return _name(element) == FLOOR or uri.rpartition("/")[2] == FLOOR


def _free_names(names, standing):
    """{name: another one} of the numbered names that are taken; lowest free numbers."""
    used, out = {*names, *standing}, {}
    for name in names:
        kind, _ = kind_and_number(name)
        if not kind or name not in standing:
            continue
        free = next(n for n in map(f"{kind}{{}}".format, count(1)) if n not in used)
        used.add(free)
        out[name] = free
    return out


def _name(element):
    """Of a <model> or an <include>; an include without a name takes that of its file."""
    if element.tag == "include":
        uri = element.findtext("uri", "").strip()
        return element.findtext("name", uri.removeprefix("model://")).strip()
    return element.get("name", "")


def _rename(element, renamed):
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
