# SPDX-License-Identifier: Apache-2.0
"""World files, as far as it takes to add one to the world that runs."""

import os
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from warehouse_sim.models import FLOOR


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


def insertable(path, standing):
    """What a world file adds to a world: its SDF text, and the names of its models.

    Its floor is left out where the world has one already (`standing` names the world's models).
    """
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise WorldFileError(f"{path} is no XML: {error}") from error
    parent = root.find("world") if root.tag == "sdf" else None
    if parent is None:
        raise WorldFileError(f"{path} holds no <sdf> with a <world>")
    for model in list(parent):
        if _name(model) == FLOOR and FLOOR in standing:
            parent.remove(model)
    names = [_name(model) for model in parent if model.tag in ("model", "include")]
    return ElementTree.tostring(root, encoding="unicode"), names


def _name(element):
    """Of a <model> or an <include>; an include without a name takes that of its file."""
    if element.tag == "include":
        uri = element.findtext("uri", "").strip()
        return element.findtext("name", uri.removeprefix("model://")).strip()
    return element.get("name")
