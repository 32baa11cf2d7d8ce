# SPDX-License-Identifier: Apache-2.0
"""Orders (6.6): taken, reported node by node, driven to their end; or refused."""

import math
from collections.abc import Iterator
from typing import Any

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Probe
from warehouse_vda5050.conform.verdict import demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("order")
case = chapter.case


@case("one_node", "6.6.2", edges=1)
def one_node(probe: Probe) -> None:
    """An order of the node where the vehicle stands is taken, and over."""
    order = probe.new_order(probe.way(0))
    state = probe.drive(order)
    demand(state.get("lastNodeId") == order["nodes"][0]["nodeId"], "lastNodeId is another")


@case("one_edge", "6.6.2", edges=1)
def one_edge(probe: Probe) -> None:
    """An order of two nodes is driven to its end."""
    order = probe.new_order(probe.way(1))
    state = probe.drive(order)
    demand(state.get("lastNodeId") == order["nodes"][1]["nodeId"], "lastNodeId is another")
    demand(state.get("lastNodeSequenceId") == 2, "lastNodeSequenceId is not 2")


@case("many_nodes", "6.6.2", edges=3)
def many_nodes(probe: Probe) -> None:
    """An order of several nodes is driven to its end."""
    order = probe.new_order(probe.way(3))
    state = probe.drive(order)
    demand(state.get("lastNodeSequenceId") == 6, "lastNodeSequenceId is not 6")


@case("there_and_back", "6.6.2", edges=1)
def there_and_back(probe: Probe) -> None:
    """An order may come to a node twice: sequenceId tells them apart."""
    a, b = probe.way(1)
    order = probe.new_order([a, b, a])
    state = probe.drive(order)
    demand(state.get("lastNodeSequenceId") == 4, "lastNodeSequenceId is not 4")


@case("nodes_reported", "6.10.1", edges=2)
def nodes_reported(probe: Probe) -> None:
    """nodeStates has the nodes to be traversed, as they were ordered."""
    order = probe.new_order(probe.way(2))
    state = probe.accept(order)
    reported = [(n.get("nodeId"), n.get("sequenceId")) for n in view.rows(state, "nodeStates")]
    nodes = [(n["nodeId"], n["sequenceId"]) for n in order["nodes"]]
    demand(
        reported and reported == nodes[-len(reported) :],
        f"nodeStates has {reported}; {nodes} was ordered",
    )
    demand(len(reported) >= len(nodes) - 1, f"nodeStates lacks some of {nodes}")
    probe.finish(order)


@case("edges_reported", "6.10.1", edges=2)
def edges_reported(probe: Probe) -> None:
    """edgeStates has the edges to be driven, as they were ordered."""
    order = probe.new_order(probe.way(2))
    state = probe.accept(order)
    reported = [(e.get("edgeId"), e.get("sequenceId")) for e in view.rows(state, "edgeStates")]
    edges = [(e["edgeId"], e["sequenceId"]) for e in order["edges"]]
    demand(reported == edges, f"edgeStates has {reported}; {edges} was ordered")
    probe.finish(order)


@case("released_reported", "6.10.6", edges=2)
def released_reported(probe: Probe) -> None:
    """What is released is reported as released."""
    order = probe.new_order(probe.way(2))
    state = probe.accept(order)
    parts = [*view.rows(state, "nodeStates"), *view.rows(state, "edgeStates")]
    demand(all(part.get("released") is True for part in parts), "released is not true")
    probe.finish(order)


@case("node_leaves", "6.10.2", edges=2)
def node_leaves(probe: Probe) -> None:
    """A traversed node is lastNodeId, and no longer in nodeStates."""
    for state in _drive(probe, probe.new_order(probe.way(2))):
        last, left = view.reached(state), view.sequences(state, "nodeStates")
        demand(all(k > last for k in left), f"lastNodeSequenceId {last} is among {left}")


@case("edge_leaves", "6.10.2", edges=2)
def edge_leaves(probe: Probe) -> None:
    """An edge leaves edgeStates with its end node."""
    for state in _drive(probe, probe.new_order(probe.way(2))):
        last, left = view.reached(state), view.sequences(state, "edgeStates")
        demand(all(k > last for k in left), f"after node {last} the edges {left} are left")


@case("last_node", "6.10.2", edges=3)
def last_node(probe: Probe) -> None:
    """lastNodeId and lastNodeSequenceId belong together."""
    order = probe.new_order(probe.way(3))
    names = {node["sequenceId"]: node["nodeId"] for node in order["nodes"]}
    for state in _drive(probe, order):
        number, name = state.get("lastNodeSequenceId"), state.get("lastNodeId")
        demand(names.get(number) == name, f"node {number} is {names.get(number)}, not {name}")


def _drive(probe: Probe, order: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Drives an order; yields the states that came of it from its first node on."""
    mark = len(probe.log.entries)
    probe.drive(order)
    for state in probe.log.values(Kind.STATE, mark):
        if view.has(state, order) and view.reached(state) >= 0:
            yield state


@case("not_early", "6.10.2", edges=2)
def not_early(probe: Probe) -> None:
    """A node counts as traversed when the vehicle is there, not before."""
    order = probe.new_order(probe.way(2))
    at = {n["sequenceId"]: n["nodePosition"] for n in order["nodes"]}
    mark = len(probe.log.entries)
    probe.drive(order)
    before = 0
    for state in probe.log.values(Kind.STATE, mark):
        number, position = max(0, view.reached(state)), view.at(state)
        if view.has(state, order) and number != before and position and number in at:
            far = math.dist(position, (at[number]["x"], at[number]["y"]))
            text = f"node {number} was traversed {far:.2f} m from it"
            demand(far < 0.6 * probe.settings.spacing, text)
            before = number


@case("copy", "6.6.4.3", edges=2)
def copy(probe: Probe) -> None:
    """The same order once more is ignored: no error, nothing driven twice."""
    order = probe.new_order(probe.way(2))
    probe.accept(order)
    probe.driving()
    probe.order(order)
    probe.answer("a copy")
    state = probe.finish(order)
    demand(state.get("lastNodeSequenceId") == 4, "lastNodeSequenceId is not 4")
    errors = [e for e in view.rows(state, "errors") if order["orderId"] in str(e)]
    demand(not errors, f"an error for it: {errors[:1]}")


@case("copy_after_end", "6.6.4.3", edges=1)
def copy_after_end(probe: Probe) -> None:
    """The same order after its end is ignored."""
    order = probe.new_order(probe.way(1))
    probe.drive(order)
    probe.order(order)
    probe.never(lambda s: s.get("driving") or s.get("nodeStates"), "it is driven again", 2.0)


@case("other_active", "6.6.2", edges=2)
def other_active(probe: Probe) -> None:
    """While an order is under way, another one is refused."""
    way = probe.way(2)
    order = probe.new_order(way)
    probe.accept(order)
    probe.driving()
    probe.refuses(probe.new_order(way), "orderError", "orderUpdateError", "validationError")
    probe.finish(order)


@case("other_goes_on", "6.6.2", edges=2)
def other_goes_on(probe: Probe) -> None:
    """An order goes on when another one was refused."""
    way = probe.way(2)
    order = probe.new_order(way)
    probe.accept(order)
    probe.order(probe.new_order(way[:1]))
    state = probe.finish(order)
    demand(state.get("lastNodeSequenceId") == 4, "it did not come to its end")


@case("next", "6.6.2", edges=1)
def next_order(probe: Probe) -> None:
    """After the end of an order, the next is taken."""
    probe.drive(probe.new_order(probe.way(1)))
    probe.drive(probe.new_order(probe.way(1)))


@case("elsewhere", "6.6.2", edges=2)
def elsewhere(probe: Probe) -> None:
    """An order that begins where the vehicle does not stand is refused."""
    way = probe.way(2)
    probe.refuses(probe.new_order(way[1:]), "noRouteError", "orderError", "validationError")
    probe.never(lambda s: s.get("driving"), "the vehicle drives", 2.0)


@case("elsewhere_node", "6.6.2", edges=2)
def elsewhere_node(probe: Probe) -> None:
    """An order of one node, where the vehicle does not stand, is refused."""
    way = probe.way(2)
    probe.refuses(probe.new_order(way[2:]), "noRouteError", "orderError", "validationError")


@case("refused_kept", "6.6.4.2", edges=2)
def refused_kept(probe: Probe) -> None:
    """After a refusal the last order's ids are reported still."""
    way = probe.way(2)
    order = probe.new_order(way[:1])
    probe.drive(order)
    probe.order(probe.new_order(way[1:]))
    demand(view.has(probe.answer(), order), "the state has another order")


@case("stands_at_end", "6.6.2", edges=2)
def stands_at_end(probe: Probe) -> None:
    """The vehicle stands at the last released node, and drives no farther."""
    order = probe.new_order(probe.way(1))
    probe.drive(order)
    goal = order["nodes"][-1]["nodePosition"]
    probe.wait(1.5)
    probe.instant("stateRequest")
    position = view.at(probe.answer())
    far = math.dist(position, (goal["x"], goal["y"])) if position else 0.0
    demand(far < 0.3 * probe.settings.spacing, f"it is {far:.2f} m from the last node")
