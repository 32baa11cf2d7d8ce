# SPDX-License-Identifier: Apache-2.0
"""Writes a layout file as an SDF world in which everything stands: floor, walls, units, robots.

The world says all of it by its models and the markings on its floor. The text of the layout file
is in it too, as an element that programs which don't know it skip: of the drawings that mean the
same, from_world chooses that one.
"""

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from xml.sax.saxutils import escape

from warehouse_layout.file import files, user_file
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.models import models
from warehouse_layout.models.sdf_world import name_of
from warehouse_layout.place import placement

NAMESPACE = "urn:warehouse_layout"
DRAWING = f"{{{NAMESPACE}}}drawing"


def write(file: LayoutFile, out: str | Path) -> None:
    """Writes the world of a layout. Raises LayoutFileError where not all has room."""
    text = text_of(file)
    try:
        Path(out).write_text(text, encoding="utf-8")
    except OSError as error:
        raise LayoutFileError(f"{out}: {error.strerror}") from error


def text_of(file: LayoutFile) -> str:
    """Returns the SDF text of a layout's world. Raises LayoutFileError where not all has room."""
    layout = placement.place(file)
    parts = models.of_layout(layout)
    root = _surroundings(file, keep_floor=not layout.has_own_floor)
    world = root[0]
    taken = {name_of(element) for element in world} & {part.name for part in parts}
    if taken:
        raise LayoutFileError(f"{file.building}: {', '.join(sorted(taken))} stand there already")
    world.set("name", file.title)
    # The models are many and texts already: they are not parsed for it.
    head, end, tail = ElementTree.tostring(root, encoding="unicode").rpartition("</world>")
    drawing = (
        f"<warehouse:drawing>{escape(lf.text_of(_with_whole_paths(file)))}</warehouse:drawing>"
    )
    body = "\n".join([drawing, *(part.xml for part in parts)])
    head = head.replace("<sdf ", f'<sdf xmlns:warehouse="{NAMESPACE}" ', 1)
    return f'<?xml version="1.0"?>\n{head}{body}\n{end}{tail}\n'


def _surroundings(file: LayoutFile, keep_floor: bool) -> ElementTree.Element:
    """Returns the world around a layout: its building, or light and grid alone."""
    path = file.beside_file(file.building) if file.building else files.worlds() / "empty.sdf"
    try:
        root = user_file.read_xml(path)
    except (OSError, ElementTree.ParseError) as error:
        raise LayoutFileError(f"{path}: can't be read: {error}") from error
    if root.tag != "sdf" or len(root) != 1 or root[0].tag != "world":
        raise LayoutFileError(f"{path} holds no <sdf> with a <world>")
    world = root[0]
    for floor in [] if keep_floor else [e for e in world if name_of(e) == models.FLOOR]:
        world.remove(floor)
    for spacing in world.iterfind("plugin[@name='grid']/spacing"):
        spacing.text = repr(file.spacing)
    for uri in root.iter("uri"):
        beside = path.parent / (uri.text or "").strip()
        if beside.exists():
            uri.text = str(beside.resolve())
    return root


def _with_whole_paths(file: LayoutFile) -> LayoutFile:
    """Returns the file with paths that hold from every folder."""
    building, stock, skus = (
        str(file.beside_file(name).resolve()) if name else ""
        for name in (file.building, file.stock, file.skus)
    )
    return replace(file, building=building, stock=stock, skus=skus)
