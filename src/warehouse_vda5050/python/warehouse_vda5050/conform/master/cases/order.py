# SPDX-License-Identifier: Apache-2.0
"""Orders as they are built (6.6.1, 6.6.2), judged one by one at the end of the run."""

import math
from typing import Any

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.master.facts import held_for, value_of
from warehouse_vda5050.conform.master.orders import Ordered, orders_of
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import demand

chapter = Chapter("order")
case = chapter.case
DEVIATION = 0.5  # from a first node without allowedDeviationXY [m]
SAME = 1e-3  # between two positions of one node [m]
OLD = ("2.0.0", "2.1.0")


@case("nodes", "6.6.1", audit=True)
def nodes(stage: Stage) -> None:
    """An order has one node at least."""
    for order in orders_of(stage):
        demand(order.nodes, f"{order.name} has none")


@case("edges", "6.6.1", audit=True)
def edges(stage: Stage) -> None:
    """An order has one edge less than nodes."""
    for order in orders_of(stage):
        counts = len(order.nodes), len(order.edges)
        demand(counts[1] == counts[0] - 1, f"{order.name} has {counts[0]} nodes, {counts[1]} edges")


@case("first_released", "6.6.2", audit=True)
def first_released(stage: Stage) -> None:
    """The first node of each message is released: the vehicle is there, or will be."""
    for order in orders_of(stage):
        demand(order.nodes[0]["released"], f"{order.name}: its first node is not")


@case("base_first", "6.6.1", audit=True)
def base_first(stage: Stage) -> None:
    """After what is not released nothing released follows."""
    for order in orders_of(stage):
        parts = sorted([*order.nodes, *order.edges], key=lambda part: part["sequenceId"])
        released = [part["released"] for part in parts]
        gap = released.index(False) if False in released else len(released)
        demand(not any(released[gap:]), f"{order.name}: released are {released}")


@case("edge_released", "6.6.1", audit=True)
def edge_released(stage: Stage) -> None:
    """An edge is released only if both its nodes are, and a node only with the edge to it."""
    for order in orders_of(stage):
        for edge, a, b in zip(order.edges, order.nodes, order.nodes[1:]):
            both = a["released"] and b["released"]
            demand(edge["released"] == both, f"{order.name}: edge {edge['edgeId']} is not so")


@case("edge_ends", "6.6.6", audit=True, versions=OLD)
def edge_ends(stage: Stage) -> None:
    """startNodeId and endNodeId are the nodes before and after the edge."""
    for order in orders_of(stage):
        for edge, a, b in zip(order.edges, order.nodes, order.nodes[1:]):
            ends = edge["startNodeId"], edge["endNodeId"]
            expected = a["nodeId"], b["nodeId"]
            demand(ends == expected, f"{order.name}: {ends} between {expected}")


@case("sequence", "6.6.2", audit=True)
def sequence(stage: Stage) -> None:
    """sequenceId runs over nodes and edges by turns: nodes have the even numbers."""
    for order in orders_of(stage):
        first = order.nodes[0]["sequenceId"]
        demand(first % 2 == 0, f"{order.name} begins with sequenceId {first}")
        _demand_rising(order, order.nodes, first)
        _demand_rising(order, order.edges, first + 1)


def _demand_rising(order: Ordered, parts: list[dict[str, Any]], first: int) -> None:
    counted = [part["sequenceId"] for part in parts]
    expected = [first + 2 * k for k in range(len(parts))]
    demand(counted == expected, f"{order.name}: sequenceIds are {counted}, not {expected}")


@case("sequence_zero", "6.6.2", audit=True)
def sequence_zero(stage: Stage) -> None:
    """The first node of an order has the sequenceId 0."""
    for order in orders_of(stage):
        first = order.nodes[0]["sequenceId"]
        demand(order.before or first == 0, f"{order.name} begins with sequenceId {first}")


@case("start", "6.6.1", audit=True)
def start(stage: Stage) -> None:
    """The first node of an order is where the vehicle stands."""
    for order in orders_of(stage):
        if order.is_new and not order.is_copy and _has_settled(stage, order):
            off = _distance(order)
            allowed = _deviation(order.nodes[0])
            at_node = order.nodes[0]["nodeId"] == value_of(order.scene, "node")
            near = off is None or off <= allowed
            text = f"{order.name} begins {off or 0:.2f} m from the vehicle"
            demand(at_node if off is None else near, text)


def _has_settled(stage: Stage, order: Ordered) -> bool:
    """Returns whether the master can know where the vehicle stands."""
    now, reaction = order.entry.time, stage.settings.reaction
    stays = held_for(order.scene, "pushed", now) >= reaction
    return stays and not value_of(order.scene, "busy") and bool(value_of(order.scene, "online"))


def _distance(order: Ordered) -> float | None:
    place = order.nodes[0].get("nodePosition")
    if not place:
        return None
    x, y = value_of(order.scene, "at")
    return math.hypot(place["x"] - x, place["y"] - y)


def _deviation(node: dict[str, Any]) -> float:
    value = (node.get("nodePosition") or {}).get("allowedDeviationXY")
    if isinstance(value, dict):
        value = value.get("a")
    return max(DEVIATION, value) if isinstance(value, (int, float)) else DEVIATION


@case("ids", "6.6.6", audit=True)
def ids(stage: Stage) -> None:
    """A new order has an orderId that no order of the vehicle had before."""
    for order in orders_of(stage):
        had = value_of(order.scene, "order")
        again = order.id in order.earlier and had not in ("", order.id) and not order.is_copy
        demand(not again, f"{order.name} comes after order {had}")


@case("one_at_a_time", "6.6.2", audit=True)
def one_at_a_time(stage: Stage) -> None:
    """While an order is under way, no other is sent."""
    for order in orders_of(stage):
        busy, had = value_of(order.scene, "busy"), value_of(order.scene, "order")
        demand(not (busy and order.is_new), f"{order.name} came while {had} was under way")


@case("place", "6.6.6", audit=True)
def place(stage: Stage) -> None:
    """A nodeId is one place of a map."""
    known: dict[tuple[str, str, str], tuple[float, float]] = {}
    for order in orders_of(stage):
        for node in order.nodes:
            at = node.get("nodePosition")
            if at:
                key = order.entry.vehicle, node["nodeId"], at["mapId"]
                before = known.setdefault(key, (at["x"], at["y"]))
                off = math.dist(before, (at["x"], at["y"]))
                demand(off <= SAME, f"{order.name}: {node['nodeId']} is {off:.3f} m elsewhere")


@case("map", "6.7", audit=True)
def map_id(stage: Stage) -> None:
    """mapId is the map that the vehicle reports."""
    maps = {actor.name: actor.map_id for actor in stage.actors}
    for order in orders_of(stage):
        for node in order.nodes:
            at = node.get("nodePosition") or {}
            expected = maps[order.entry.vehicle]
            name = at.get("mapId", expected)
            demand(name == expected, f"{order.name}: mapId is {name!r}, not {expected!r}")


@case("angles", "6.6.6", audit=True)
def angles(stage: Stage) -> None:
    """Angles are radians from -pi to pi."""
    for order in orders_of(stage):
        for node in order.nodes:
            at = node.get("nodePosition") or {}
            _demand_angle(order, "theta", at.get("theta"))
            _demand_angle(order, "allowedDeviationTheta", at.get("allowedDeviationTheta"))
        for edge in order.edges:
            _demand_angle(order, "orientation", edge.get("orientation"))


def _demand_angle(order: Ordered, name: str, value: Any) -> None:
    fits = value is None or abs(value) <= math.pi + 1e-6
    demand(fits, f"{order.name}: {name} is {value}")


@case("distinct", "6.6.6", audit=True)
def distinct(stage: Stage) -> None:
    """Each edge leads to another node than it begins at."""
    for order in orders_of(stage):
        for a, b in zip(order.nodes, order.nodes[1:]):
            demand(a["nodeId"] != b["nodeId"], f"{order.name}: {a['nodeId']} follows itself")


@case("first_update", "6.1.2", audit=True, versions=("3.0.0",))
def first_update(stage: Stage) -> None:
    """A new order begins with orderUpdateId 0."""
    for order in orders_of(stage):
        demand(order.before or order.update == 0, f"{order.name} is the first of its order")


@case("no_ends", "7.3", audit=True, versions=("3.0.0",))
def no_ends(stage: Stage) -> None:
    """Edges have no startNodeId and endNodeId."""
    for order in orders_of(stage):
        for edge in order.edges:
            left = {"startNodeId", "endNodeId"} & edge.keys()
            demand(not left, f"{order.name}: an edge has {', '.join(sorted(left))}")
