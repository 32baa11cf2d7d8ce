# SPDX-License-Identifier: Apache-2.0
"""Reads plant models of openTCS, `.xml`: points become cells, paths the directions of streets.

Locations are served at the points that they are linked to. Their purpose follows from the words in
their names and types, and from the operations that these allow.
"""

import math
from xml.etree.ElementTree import Element

from warehouse_layout.convert.common import FormatError, PathName, plural
from warehouse_layout.convert.graphs.lif import kind_of
from warehouse_layout.convert.graphs.lif_floor import Edge, Graph, Node, floor_of
from warehouse_layout.convert.rawsim.xml_fields import read_root
from warehouse_layout.file.layout_file import LayoutFile

MILLIMETRE = 0.001
PARKING = "PARK_POSITION"
IGNORED = ("block", "staticRoute", "group")


def read(path: PathName) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a plant model, and what it can't hold. Raises FormatError."""
    root = read_root(path, "model")
    graph, notes = Graph(), list[str]()
    for point in root.findall("point"):
        _take_point(path, point, graph)
    if not graph.nodes:
        raise FormatError(f"{path}: no point; a plant model of openTCS was expected")
    for each in root.findall("path"):
        _take_path(path, each, graph, notes)
    operations = {
        _name(path, kind): " ".join(a.get("name", "") for a in kind.findall("allowedOperation"))
        for kind in root.findall("locationType")
    }
    for location in root.findall("location"):
        _take_location(path, location, operations, graph, notes)
    file, unsaid = floor_of(path, graph, root.get("name", ""))
    return file, [*notes, *unsaid, *_left_out(root)]


def _take_point(path: PathName, point: Element, graph: Graph) -> None:
    name = _name(path, point)
    if name in graph.nodes:
        raise FormatError(f"{path}: point '{name}' is there twice")
    x, y = (MILLIMETRE * _number(path, point, axis) for axis in "XY")
    graph.nodes[name] = Node(x, y, "parking" if point.get("type") == PARKING else "")


def _take_path(path: PathName, each: Element, graph: Graph, notes: list[str]) -> None:
    name = _name(path, each)
    begin, end = each.get("sourcePoint", ""), each.get("destinationPoint", "")
    for point in (begin, end):
        if point not in graph.nodes:
            raise FormatError(f"{path}: path '{name}': there is no point '{point}'")
    if each.get("locked") == "true":
        notes.append(f"path '{name}' is locked: left out")
        return
    ways = (("maxVelocity", begin, end), ("maxReverseVelocity", end, begin))
    for speed, a, b in ways:
        default = 1.0 if speed == "maxVelocity" else 0.0
        if _attribute(path, each, speed, default) > 0:
            graph.edges.append(Edge(name, a, b))


def _take_location(
    path: PathName, element: Element, operations: dict[str, str], graph: Graph, notes: list[str]
) -> None:
    name, sort = _name(path, element), element.get("type", "")
    points = [link.get("point", "") for link in element.findall("link")]
    unknown = [point for point in points if point not in graph.nodes]
    if unknown:
        raise FormatError(f"{path}: location '{name}': there is no point '{unknown[0]}'")
    if not points:
        notes.append(f"location '{name}' has no link to a point: left out")
        return
    kind = kind_of(f"{name} {sort} {operations.get(sort, '')}", "pick")
    if kind in ("pick", "replenish"):
        graph.nodes[points[0]].kind = ""
        graph.stations.append((name, kind, points[0]))
        if len(points) > 1:
            notes.append(f"location '{name}': of {len(points)} points the first serves it")
        return
    for point in points:
        graph.nodes[point].kind = kind


def _left_out(root: Element) -> list[str]:
    out = []
    if count := len(root.findall("vehicle")):
        out.append(f"{plural(count, 'vehicle')}: say in robots how many there are")
    for tag in IGNORED:
        if count := len(root.findall(tag)):
            out.append(f"{plural(count, tag)} left out: robots here keep apart by themselves")
    return out


def _name(path: PathName, element: Element) -> str:
    name = element.get("name")
    if not name:
        raise FormatError(f"{path}: a {element.tag} without a name")
    return name


def _number(path: PathName, point: Element, axis: str) -> float:
    """Returns a coordinate of a point, by its name in models of today or of before version 5."""
    today = f"position{axis}"
    return _attribute(path, point, today if today in point.attrib else f"{axis.lower()}Position")


def _attribute(path: PathName, element: Element, name: str, default: float | None = None) -> float:
    text = element.get(name)
    if text is None and default is not None:
        return default
    try:
        value = float(text or "")
    except ValueError:
        value = math.nan
    if not abs(value) < 1e12:
        raise FormatError(
            f"{path}: {element.tag} '{element.get('name')}': {name} is {text!r}; a number was"
            " expected"
        )
    return value
