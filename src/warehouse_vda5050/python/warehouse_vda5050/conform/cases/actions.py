# SPDX-License-Identifier: Apache-2.0
"""Actions at nodes and edges, and their states (6.8, 6.11)."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.orders import action_of
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import Unsupported, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("actions")
case = chapter.case


def _ordered(probe: Probe, edges: int, index: int) -> tuple[Json, Json]:
    """An order that was accepted, with a harmless action at one of its nodes."""
    action = probe.harmless()
    order = probe.new_order(probe.way(edges), actions={index: [action]})
    probe.accept(order)
    return order, action


def _end(probe: Probe, order: Json, action: Json) -> Json:
    probe.running(action)
    probe.finish_actions()
    return probe.finish(order)


@case("reported", "6.11", edges=1)
def reported(probe: Probe) -> None:
    """Each action of an order is in actionStates once the order is taken."""
    action = probe.harmless()
    order = probe.new_order(probe.way(1), actions={1: [action]})
    state = probe.accept(order)
    rows = [a for a in view.rows(state, "actionStates") if a.get("actionId") == action["actionId"]]
    demand(len(rows) == 1, f"it is there {len(rows)} times")
    type = rows[0].get("actionType", action["actionType"])
    demand(type == action["actionType"], f"actionType is {type}")
    _end(probe, order, action)


@case("waiting", "6.11", edges=2)
def waiting(probe: Probe) -> None:
    """Before its node is reached an action is WAITING."""
    mark = len(probe.log.entries)
    order, action = _ordered(probe, 2, 2)
    _end(probe, order, action)
    for state in probe.log.values(Kind.STATE, mark):
        if view.has(state, order) and state.get("lastNodeSequenceId") != 4:
            status = view.status(state, action["actionId"])
            demand(status == "WAITING", f"before its node it is {status or 'not reported'}")


@case("first_node", "6.10.2", edges=1)
def first_node(probe: Probe) -> None:
    """An action of the first node begins at once."""
    order, action = _ordered(probe, 1, 0)
    _end(probe, order, action)


@case("middle_node", "6.10.2", edges=2)
def middle_node(probe: Probe) -> None:
    """An action of a node on the way begins there, and the order goes on."""
    order, action = _ordered(probe, 2, 1)
    state = probe.running(action)
    demand(state.get("lastNodeSequenceId") == 2, "it runs at another node")
    probe.finish_actions()
    demand(probe.finish(order).get("lastNodeSequenceId") == 4, "it did not come to its end")


@case("last_node", "6.10.2", edges=1)
def last_node(probe: Probe) -> None:
    """An action of the last node begins there."""
    order, action = _ordered(probe, 1, 1)
    state = probe.running(action)
    demand(state.get("lastNodeSequenceId") == 2, "it runs at another node")
    probe.finish_actions()
    probe.finish(order)


@case("finished", "6.11", edges=1)
def finished(probe: Probe) -> None:
    """An action that is over is FINISHED."""
    order, action = _ordered(probe, 1, 0)
    state = _end(probe, order, action)
    status = view.status(state, action["actionId"])
    demand(status == "FINISHED", f"it is {status}")


@case("holds_order", "6.6.2", edges=1)
def holds_order(probe: Probe) -> None:
    """An order is under way until its last action is over: no other is taken."""
    order, action = _ordered(probe, 1, 1)
    probe.running(action)
    if not probe.is_held:
        raise Unsupported("no action waits for a trigger")
    probe.refuses(probe.new_order(probe.way(0)))
    probe.finish_actions()
    probe.finish(order)


@case("kept", "6.10.6", edges=1)
def kept(probe: Probe) -> None:
    """actionStates of an order are kept after its end."""
    order, action = _ordered(probe, 1, 0)
    _end(probe, order, action)
    probe.instant("stateRequest")
    demand(view.status(probe.answer(), action["actionId"]), "it is gone")


@case("cleared", "6.10.6", edges=1)
def cleared(probe: Probe) -> None:
    """A new order clears the actionStates of the last one."""
    order, action = _ordered(probe, 1, 0)
    _end(probe, order, action)
    after = probe.new_order(probe.way(0))
    probe.drive(after)
    demand(not view.status(probe.state, action["actionId"]), "it is there still")


@case("unknown", "6.6.4.2", edges=1)
def unknown(probe: Probe) -> None:
    """An order with an unknown action is refused: orderError."""
    action = action_of("conformUnknown", probe.new_id("unknown"))
    probe.refuses(probe.new_order(probe.way(1), actions={1: [action]}), "orderError")


@case("unknown_reference", "6.6.4.2", edges=1)
def unknown_reference(probe: Probe) -> None:
    """The error of an unknown action refers to it."""
    action = action_of("conformUnknown", probe.new_id("unknown"))
    error = probe.refuses(probe.new_order(probe.way(1), actions={1: [action]}))
    pairs = view.references(error)
    demand(action["actionId"] in pairs.values(), f"references are {pairs}")


@case("wrong_scope", "6.6.4.2", edges=1)
def wrong_scope(probe: Probe) -> None:
    """An order with an action that is instant alone is refused."""
    if probe.supports("stateRequest", "NODE"):
        raise Unsupported("the vehicle has stateRequest at nodes")
    action = action_of("stateRequest", probe.new_id("stateRequest"))
    probe.refuses(probe.new_order(probe.way(1), actions={1: [action]}), "orderError")


@case("edge", "6.6.4.2", edges=1)
def edge(probe: Probe) -> None:
    """An action of an edge is carried out there, or the order is refused."""
    action = probe.harmless("NONE")
    order = probe.new_order(probe.way(1))
    order["edges"][0]["actions"] = [action]
    if not probe.supports(action["actionType"], "EDGE"):
        probe.refuses(order, "orderError")
        return
    probe.accept(order)
    probe.running(action)
    probe.finish_actions()
    probe.finish(order)


@case("parameter", "6.6.4.2", edges=1)
def parameter(probe: Probe) -> None:
    """An order with a parameter that the vehicle can't use is refused."""
    action = probe.harmless()
    action["actionParameters"] = [{"key": "conformUnknown", "value": "x"}]
    probe.refuses(probe.new_order(probe.way(0), actions={0: [action]}), "orderError")


@case("height", "6.6.4.2", edges=1)
def height(probe: Probe) -> None:
    """A pick at a height that the vehicle can't reach is refused."""
    probe.need("pick", "NODE")
    action = action_of("pick", probe.new_id("pick"), "HARD", [("height", 999.0)])
    probe.refuses(probe.new_order(probe.way(0), actions={0: [action]}), "orderError")


@case("device", "6.6.4.2", edges=1)
def device(probe: Probe) -> None:
    """A pick by a load handling device that the vehicle does not have is refused."""
    probe.need("pick", "NODE")
    action = action_of("pick", probe.new_id("pick"), "HARD", [("lhd", "conform_no_such")])
    probe.refuses(probe.new_order(probe.way(0), actions={0: [action]}), "orderError")


@case("drop_nothing", "6.8.2", edges=1)
def drop_nothing(probe: Probe) -> None:
    """A drop without a load is FAILED, with an error; or the order is refused."""
    probe.need("drop", "NODE")
    if probe.state.get("loads"):
        raise Unsupported("the vehicle carries a load")
    action = action_of("drop", probe.new_id("drop"))
    order = probe.new_order(probe.way(0), actions={0: [action]})
    probe.order(order)
    state = probe.until(lambda s: s.get("errors"), "an error in a state", probe.settings.edge)
    status = view.status(state, action["actionId"])
    demand(status in ("FAILED", ""), f"the drop is {status}")


@case("failed_reference", "7.1", edges=1)
def failed_reference(probe: Probe) -> None:
    """The error of a failed action refers to it."""
    probe.need("drop", "NODE")
    if probe.state.get("loads"):
        raise Unsupported("the vehicle carries a load")
    action = action_of("drop", probe.new_id("drop"))
    probe.order(probe.new_order(probe.way(0), actions={0: [action]}))
    state = probe.until(lambda s: s.get("errors"), "an error in a state", probe.settings.edge)
    pairs = [view.references(error) for error in view.rows(state, "errors")]
    known = any(action["actionId"] in each.values() for each in pairs)
    demand(known, f"references are {pairs}; actionId was expected")
