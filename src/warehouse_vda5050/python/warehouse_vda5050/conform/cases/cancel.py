# SPDX-License-Identifier: Apache-2.0
"""cancelOrder in every state (6.6.3)."""

import math

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Actions, Json, Probe
from warehouse_vda5050.conform.verdict import demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("cancel")
case = chapter.case


def _under_way(probe: Probe, edges: int = 2, actions: Actions | None = None) -> Json:
    order = probe.new_order(probe.way(edges), actions=actions)
    probe.accept(order)
    probe.driving()
    return order


def _cancel(probe: Probe) -> Json:
    return probe.finished(probe.instant("cancelOrder"), probe.settings.edge)


@case("idle", "6.6.3.2")
def idle(probe: Probe) -> None:
    """cancelOrder without an order is FAILED."""
    status = probe.over(probe.instant("cancelOrder"))
    demand(status == "FAILED", f"it is {status}")


@case("idle_error", "6.6.3.2")
def idle_error(probe: Probe) -> None:
    """cancelOrder without an order gives a warning noOrderToCancel, with actionId."""
    id = probe.new_id("cancelOrder")
    error = probe.refused(lambda: probe.instant("cancelOrder", id=id), ("noOrderToCancel",), id)
    pairs = view.references(error)
    demand(id in pairs.values(), f"references are {pairs}; actionId was expected")


@case("driving", "6.6.3", edges=2)
def driving(probe: Probe) -> None:
    """While driving: the vehicle stops, and cancelOrder is FINISHED."""
    _under_way(probe)
    demand(_cancel(probe).get("driving") is False, "driving is true when it is FINISHED")


@case("states_empty", "6.6.3", edges=2)
def states_empty(probe: Probe) -> None:
    """A cancelled order leaves no nodeStates and edgeStates."""
    _under_way(probe)
    state = _cancel(probe)
    for name in ("nodeStates", "edgeStates"):
        demand(not state.get(name), f"{name} has {view.sequences(state, name)}")


@case("ids_kept", "6.6.3", edges=2)
def ids_kept(probe: Probe) -> None:
    """orderId and orderUpdateId are kept."""
    order = _under_way(probe)
    demand(view.has(_cancel(probe), order), "orderId or orderUpdateId has changed")


@case("stands", "6.6.3", edges=3)
def stands(probe: Probe) -> None:
    """After it is FINISHED the vehicle stays where it is."""
    _under_way(probe, 3)
    before = view.at(_cancel(probe))
    probe.wait(2.0)
    probe.instant("stateRequest")
    after = view.at(probe.answer())
    far = math.dist(before, after) if before and after else 0.0
    demand(far < 0.1, f"it moved by {far:.2f} m")


@case("soon", "6.8.1", edges=3)
def soon(probe: Probe) -> None:
    """It stops as soon as it can: at the next node at the latest."""
    _under_way(probe, 3)
    before = max(0, view.reached(probe.state))
    after = _cancel(probe).get("lastNodeSequenceId", 0)
    demand(after <= before + 4, f"it was at node {before}, and stopped at {after}")
    demand(after < 6, "it drove to the end")


@case("running_first", "6.6.3", edges=3)
def running_first(probe: Probe) -> None:
    """While the vehicle moves, cancelOrder is not FINISHED."""
    _under_way(probe, 3)
    mark = len(probe.log.entries)
    id = probe.instant("cancelOrder")
    probe.finished(id, probe.settings.edge)
    for state in probe.log.values(Kind.STATE, mark):
        early = view.status(state, id) == "FINISHED" and state.get("driving")
        demand(not early, "it is FINISHED while driving is true")


@case("waiting_actions", "6.6.3", edges=2)
def waiting_actions(probe: Probe) -> None:
    """Scheduled actions are FAILED."""
    action = probe.harmless()
    _under_way(probe, actions={2: [action]})
    state = _cancel(probe)
    status = view.status(state, action["actionId"])
    demand(status == "FAILED", f"the action is {status or 'not reported'}")


@case("running_action", "6.6.3", edges=1)
def running_action(probe: Probe) -> None:
    """A running action is FAILED, or comes to its end, before FINISHED."""
    action = probe.harmless()
    probe.accept(probe.new_order(probe.way(1), actions={0: [action]}))
    probe.running(action)
    state = _cancel(probe)
    demand(view.is_over(state, action["actionId"]), "an action runs on")


@case("trigger_fails", "6.8.2", edges=1)
def trigger_fails(probe: Probe) -> None:
    """waitForTrigger is FAILED if the order was cancelled."""
    probe.need("waitForTrigger", "NODE")
    action = {**probe.harmless(), "actionType": "waitForTrigger"}
    probe.accept(probe.new_order(probe.way(1), actions={0: [action]}))
    probe.running(action)
    status = view.status(_cancel(probe), action["actionId"])
    demand(status == "FAILED", f"it is {status or 'not reported'}")


@case("paused", "6.6.3", edges=3)
def paused(probe: Probe) -> None:
    """A paused order is cancelled, and cancelOrder ends."""
    _under_way(probe, 3)
    probe.instant("startPause")
    probe.until(lambda s: s.get("paused") and not s.get("driving"), "paused", probe.settings.edge)
    state = _cancel(probe)
    demand(not state.get("nodeStates"), "nodeStates is not empty")


@case("base_end", "6.6.3", edges=2)
def base_end(probe: Probe) -> None:
    """An order that waits at the end of its base is cancelled."""
    probe.accept(probe.new_order(probe.way(2), released=2))
    seconds = probe.settings.edge + probe.settings.answer
    probe.until(lambda s: view.reached(s) == 2, "the end of the base", seconds)
    demand(not _cancel(probe).get("nodeStates"), "nodeStates is not empty")


@case("after_end", "6.6.3.2", edges=1)
def after_end(probe: Probe) -> None:
    """A cancelOrder fails after the order has ended."""
    probe.drive(probe.new_order(probe.way(0)))
    status = probe.over(probe.instant("cancelOrder"))
    demand(status == "FAILED", f"it is {status}")


@case("twice", "6.6.3.2", edges=2)
def twice(probe: Probe) -> None:
    """A cancelled order is not cancelled again: FAILED."""
    _under_way(probe)
    _cancel(probe)
    status = probe.over(probe.instant("cancelOrder"))
    demand(status == "FAILED", f"it is {status}")


@case("next_order", "6.6.3.1", edges=2)
def next_order(probe: Probe) -> None:
    """After a cancellation the vehicle takes a new order."""
    _under_way(probe)
    _cancel(probe)
    x, y = view.at(probe.state) or (0.0, 0.0)
    assert probe.ground
    here = probe.ground.places[probe.ground.nearest(x, y)]
    start = type(here)(probe.new_id("here"), x, y, here.map_id)
    order = probe.new_order([start])
    probe.drive(order)


@case("update_after", "6.6.3", edges=2)
def update_after(probe: Probe) -> None:
    """An update of a cancelled order is refused."""
    way = probe.way(2)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    probe.driving()
    _cancel(probe)
    update = probe.update(order, way, 1)
    probe.refused(lambda: probe.order(update), refer=order["orderId"])
    probe.never(lambda s: s.get("driving"), "it drives", 1.0)


@case("no_errors", "6.6.3", edges=2)
def no_errors(probe: Probe) -> None:
    """A cancelled order leaves no error."""
    _under_way(probe, actions={2: [probe.harmless()]})
    before = len(view.rows(probe.state, "errors"))
    state = _cancel(probe)
    demand(len(view.rows(state, "errors")) <= before, f"errors: {state.get('errors')!r:.200}")
