# SPDX-License-Identifier: Apache-2.0
"""Reads layouts in VDMA's Layout Interchange Format, `.lif.json`, versions 1 and 2.

Nodes become cells, edges the directions of streets; a long edge becomes a street of several cells.
A node's actions, its station, and the words in their names say what stands there.
"""

from collections import Counter
from dataclasses import dataclass, field

from warehouse_layout.convert import json_fields
from warehouse_layout.convert.common import FormatError, PathName, plural
from warehouse_layout.convert.graphs.lif_floor import Edge, Graph, Node, floor_of
from warehouse_layout.convert.json_fields import Fields
from warehouse_layout.file.layout_file import LayoutFile

# What a place is for, by words in its name or description; the first that fits.
WORDS = {
    "charging": ("charg", "battery"),
    "parking": ("park",),
    "storage": ("storage", "rack", "shelf", "shelv"),
    "replenish": ("replenish", "inbound", "goods in"),
}
LIFTING, CHARGING = {"pick", "drop"}, {"startCharging"}
# What edges and nodes may have that a layout has no words for.
EDGE_EXTRAS = ("trajectory", "maxSpeed", "corridor", "maxRotationSpeed")


@dataclass
class _Reading:
    graph: Graph = field(default_factory=Graph)
    types: set[str] = field(default_factory=set)  # of vehicles
    extras: Counter[str] = field(default_factory=Counter)
    stations: dict[str, list[str]] = field(default_factory=dict)  # names, by node


def read(path: PathName) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a LIF file, and what it can't hold. Raises FormatError."""
    root = json_fields.read(path)
    layouts = [entry for origin in _origins(root) for entry in origin.each("layouts")]
    if not layouts:
        root.fail("layouts", "is missing or empty; a layout with nodes was expected")
    levels = {entry.text("layoutLevelId", "") for entry in layouts}
    if len(levels) > 1:
        root.fail("layouts", f"have {len(levels)} levels; robots here drive on one floor")
    reading = _Reading()
    for layout in layouts:
        _take_nodes(layout, reading)
    for layout in layouts:
        _take_edges(layout, reading)
        _take_stations(layout, reading)
    if not reading.graph.nodes:
        root.fail("layouts[0].nodes", "is missing or empty; nodes were expected")
    name = layouts[0].text("layoutName", layouts[0].text("layoutId", ""))
    file, notes = floor_of(path, reading.graph, name)
    return file, [*notes, *_unsaid(reading)]


def _origins(root: Fields) -> list[Fields]:
    """Returns what holds the layouts: the file itself, or in version 2 its origins."""
    if "origins" not in root:
        return [root]
    origins = list(root.each("origins"))
    if len(origins) > 1:
        root.fail("origins", f"are {len(origins)}; one system of coordinates was expected")
    return origins


def _take_nodes(layout: Fields, reading: _Reading) -> None:
    for node in layout.each("nodes"):
        number = node.text("nodeId")
        if number in reading.graph.nodes:
            node.fail("nodeId", f"is '{number}', as that of another node")
        at = node.inner("nodePosition")
        actions = set()
        for types in node.each("vehicleTypeNodeProperties", "mobileRobotTypeNodeProperties"):
            reading.types |= set(_types(types))
            actions |= {a.text("actionType") for a in types.each("actions", "feasibleActions")}
        words = f"{node.text('nodeName', '')} {node.text('nodeDescription', '')}"
        kind = kind_of(words, "")
        if actions & CHARGING:
            kind = "charging"
        elif actions >= LIFTING and not kind:
            kind = "storage"
        reading.graph.nodes[number] = Node(at.number("x"), at.number("y"), kind)


def _types(properties: Fields) -> list[str]:
    """Returns the types of vehicles, as either version has them."""
    if "vehicleTypeId" in properties:
        return [properties.text("vehicleTypeId")]
    each = properties.each("mobileRobotTypes")
    return [f"{t.text('manufacturer', '')} {t.text('seriesName', '')}".strip() for t in each]


def kind_of(words: str, default: str) -> str:
    """Returns what a place is for by the words that name and describe it."""
    lower = words.lower()
    return next((kind for kind, ws in WORDS.items() if any(w in lower for w in ws)), default)


def _take_edges(layout: Fields, reading: _Reading) -> None:
    for edge in layout.each("edges"):
        ends = [edge.text(name) for name in ("startNodeId", "endNodeId")]
        for name, number in zip(("startNodeId", "endNodeId"), ends):
            if number not in reading.graph.nodes:
                edge.fail(name, f"is '{number}', which is not a node")
        loaded = False
        for types in edge.each("vehicleTypeEdgeProperties", "mobileRobotTypeEdgeProperties"):
            reading.types |= set(_types(types))
            reading.extras.update(name for name in EDGE_EXTRAS if name in types)
            restricted = "loadRestriction" in types
            loaded |= not restricted or types.inner("loadRestriction").flag("loaded", True)
        reading.graph.edges.append(Edge(edge.text("edgeId", "?"), ends[0], ends[1], loaded))


def _take_stations(layout: Fields, reading: _Reading) -> None:
    """Marks the nodes of stations: charging, parking and storage, or adds one to serve units."""
    for station in layout.each("stations"):
        number = station.text("stationId")
        name = station.text("stationName", "") or number
        about = station.text("stationDescription", station.text("stationDescriptor", ""))
        nodes = station.texts("interactionNodeIds")
        if not nodes or not set(nodes) <= reading.graph.nodes.keys():
            station.fail("interactionNodeIds", "name no node that there is")
        height = f" at {station.number('stationHeight'):g} m" if "stationHeight" in station else ""
        for node in nodes:
            reading.stations.setdefault(node, []).append(name + height)
        kinds = {reading.graph.nodes[n].kind for n in nodes}
        kind = kind_of(f"{name} {about}", "charging" if "charging" in kinds else "pick")
        if kind not in ("pick", "replenish"):
            for node in nodes:
                reading.graph.nodes[node].kind = kind
            continue
        for node in nodes:
            reading.graph.nodes[node].kind = ""
        reading.graph.stations.append((name, kind, nodes[0]))
        if len(nodes) > 1:
            reading.extras[f"further nodes of station {name}"] += len(nodes) - 1


def _unsaid(reading: _Reading) -> list[str]:
    out = [
        f"a layout holds no {name}: left out {plural(n, 'time')}"
        for name, n in reading.extras.items()
    ]
    out += _heights(reading)
    if len(reading.types) > 1:
        names = ", ".join(sorted(reading.types))
        out.append(f"robots are all of one type here; there: {names}")
    return out


def _heights(reading: _Reading) -> list[str]:
    """Returns in one sentence which nodes have several places, with those of the first."""
    several = {node: names for node, names in reading.stations.items() if len(names) > 1}
    if not several:
        return []
    node, names = next(iter(several.items()))
    text = f"a cell has one place, on the floor; node {node} has {len(names)}: {', '.join(names)}"
    others = len(several) - 1
    return [f"{text}; {plural(others, 'other node')} too" if others else text]


__all__ = ["FormatError", "kind_of", "read"]
