# SPDX-License-Identifier: Apache-2.0
"""What 3.0.0 alone demands; sections are those of 3.0.0."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.orders import action_of
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("version_3")
case = chapter.case
ONLY = ("3.0.0",)
FORMER = ("agvPosition", "batteryState", "batteryCharge", "positionInitialized", "eStop")


def _type(error: Json) -> str:
    return str(error.get("errorType"))


def _demand_type(error: Json, name: str) -> None:
    demand(_type(error) == name, f"errorType is {_type(error)}; {name} was expected")


@case("cancel_other", "6.6", edges=2, versions=ONLY)
def cancel_other(probe: Probe) -> None:
    """cancelOrder with another order's orderId is FAILED; the order goes on."""
    order = probe.new_order(probe.way(2))
    probe.accept(order)
    probe.driving()
    id = probe.instant("cancelOrder", [("orderId", "conform-another")])
    status = probe.over(id)
    demand(status == "FAILED", f"it is {status}")
    probe.finish(order)


@case("cancel_own", "6.6", edges=2, versions=ONLY)
def cancel_own(probe: Probe) -> None:
    """cancelOrder with the order's own orderId cancels it."""
    order = probe.new_order(probe.way(2))
    probe.accept(order)
    probe.driving()
    id = probe.instant("cancelOrder", [("orderId", order["orderId"])])
    demand(not probe.finished(id, probe.settings.edge).get("nodeStates"), "nodes are left")


@case("initialize_position", "6.2.3.1", versions=ONLY)
def initialize_position(probe: Probe) -> None:
    """initPosition is called initializePosition; the vehicle knows one that is where it stands."""
    rows = probe.log.heard(Kind.FACTSHEET)
    names = [e.payload for e in rows]
    demand(any(b"initializePosition" in name for name in names), "the factsheet lacks it")
    position = probe.state.get("agvPosition") or {}
    pairs = [(key, position.get(key)) for key in ("x", "y", "theta", "mapId")]
    mark = len(probe.log.entries)
    id = probe.instant("initPosition", pairs)
    status = probe.over(id)
    demand(status == "FINISHED", f"it is {status}")
    states = [e.text for e in probe.log.heard(Kind.STATE, mark)]
    named = any('"initializePosition"' in text for text in states)
    demand(named, "the state calls it otherwise")


@case("clear_instant_actions", "6.2.3.1", versions=ONLY)
def clear_instant_actions(probe: Probe) -> None:
    """clearInstantActions removes the states of instant actions that are over."""
    former = probe.instant("stateRequest")
    probe.finished(former)
    state = probe.finished(probe.instant("clearInstantActions"))
    demand(not view.status(state, former), "a state of an action before is left")


@case("cleared_copy", "6.2.3.1", versions=ONLY)
def cleared_copy(probe: Probe) -> None:
    """A late copy of an instant action whose state was cleared is not carried out again."""
    id = probe.new_id("factsheetRequest")
    probe.finished(probe.instant("factsheetRequest", id=id))
    probe.finished(probe.instant("clearInstantActions"))
    mark = len(probe.log.entries)
    probe.instant("factsheetRequest", id=id)
    probe.wait(1.5)
    demand(not probe.log.values(Kind.FACTSHEET, mark), "the factsheet is sent again")


def _failing(probe: Probe) -> str:
    """Has a drop fail that may be retried, of a load that is not there; returns its id."""
    probe.need("drop", "NODE")
    probe.need("retry", "INSTANT")
    if view.rows(probe.state, "loads"):
        raise Untestable("the vehicle carries a load")
    action = {**action_of("drop", probe.new_id("drop")), "retriable": True}
    mark = len(probe.log.entries)
    probe.accept(probe.new_order(probe.way(0), actions={0: [action]}))
    _demand_retriable(probe, mark)
    return str(action["actionId"])


def _demand_retriable(probe: Probe, mark: int) -> None:
    """Demands RETRIABLE in a state from number `mark` on. Names of 2.1.0 have no such word."""
    end = probe.now() + probe.settings.answer
    while not any('"RETRIABLE"' in e.text for e in probe.log.heard(Kind.STATE, mark)):
        demand(probe.now() < end, "no action is RETRIABLE")
        probe.poll()


def _demand_failed(probe: Probe, id: str) -> None:
    probe.instant("stateRequest")
    probe.answer()
    text = [*probe.log.heard(Kind.STATE)][-1].text
    status = view.status(probe.state, id)
    demand('"RETRIABLE"' not in text and status == "FAILED", f"it is {status}, or RETRIABLE still")


@case("retriable", "6.6.9", edges=1, versions=ONLY)
def retriable(probe: Probe) -> None:
    """An action that fails and is retriable is RETRIABLE; skipRetry makes it FAILED."""
    id = _failing(probe)
    probe.finished(probe.instant("skipRetry", [("actionId", id)]))
    _demand_failed(probe, id)


@case("retry", "6.2.3.1", edges=1, versions=ONLY)
def retry(probe: Probe) -> None:
    """retry begins the action again."""
    id = _failing(probe)
    mark = len(probe.log.entries)
    probe.finished(probe.instant("retry", [("actionId", id)]))
    _demand_retriable(probe, mark)
    probe.finished(probe.instant("skipRetry", [("actionId", id)]))


@case("retriable_cancelled", "6.6.9", edges=1, versions=ONLY)
def retriable_cancelled(probe: Probe) -> None:
    """cancelOrder makes an action FAILED that is RETRIABLE."""
    id = _failing(probe)
    probe.finished(probe.instant("cancelOrder"))
    _demand_failed(probe, id)


@case("retry_unknown", "6.2.3.1", versions=ONLY)
def retry_unknown(probe: Probe) -> None:
    """retry and skipRetry of an action that is not RETRIABLE are FAILED."""
    for type in ("retry", "skipRetry"):
        probe.need(type, "INSTANT")
        status = probe.over(probe.instant(type, [("actionId", "conform-none")]))
        demand(status == "FAILED", f"{type} is {status}")


@case("reference_state", "7.9", edges=2, versions=ONLY)
def reference_state(probe: Probe) -> None:
    """A visualization has the headerId of the state that it follows."""
    mark = len(probe.log.entries)
    probe.drive(probe.new_order(probe.way(2)))
    last, shown = -1, 0
    for entry in probe.log.entries[mark:]:
        value = entry.value or {}
        if entry.sent or entry.kind not in (Kind.STATE, Kind.VISUALIZATION):
            continue
        if entry.kind is Kind.STATE:
            last = value.get("headerId", -1)
        elif last >= 0:
            shown += 1
            number = value.get("referenceStateHeaderId")
            demand(number == last, f"referenceStateHeaderId is {number}; {last} was expected")
    if not shown:
        raise Untestable("it sent no visualization")


@case("first_update", "6.2", edges=1, versions=ONLY)
def first_update(probe: Probe) -> None:
    """A new order whose orderUpdateId is not 0 is refused."""
    probe.refuses({**probe.new_order(probe.way(0)), "orderUpdateId": 5})


@case("no_order", "6.6.5.4", versions=ONLY)
def no_order(probe: Probe) -> None:
    """cancelOrder without an order: NO_ORDER_TO_CANCEL."""
    _demand_type(probe.refused(lambda: probe.instant("cancelOrder")), "NO_ORDER_TO_CANCEL")


@case("validation", "6.6.5.4", versions=ONLY)
def validation(probe: Probe) -> None:
    """A message without its form: VALIDATION_FAILURE."""
    error = probe.refused(lambda: probe.send_bytes(Kind.ORDER, b"{}"))
    _demand_type(error, "VALIDATION_FAILURE")


@case("order_action", "6.6.5.4", edges=1, versions=ONLY)
def order_action(probe: Probe) -> None:
    """An unknown action of an order: INVALID_ORDER_ACTION."""
    action = action_of("conformUnknown", probe.new_id("unknown"))
    order = probe.new_order(probe.way(0), actions={0: [action]})
    _demand_type(probe.refuses(order), "INVALID_ORDER_ACTION")


@case("instant_action", "6.6.5.4", versions=ONLY)
def instant_action(probe: Probe) -> None:
    """An unknown instant action: INVALID_INSTANT_ACTION."""
    error = probe.refused(lambda: probe.instant("conformUnknown"))
    _demand_type(error, "INVALID_INSTANT_ACTION")


@case("other_map", "6.6.5.4", edges=1, versions=ONLY)
def other_map(probe: Probe) -> None:
    """A node of an unknown map: UNKNOWN_MAP_ID."""
    order = probe.new_order(probe.way(1))
    order["nodes"][1]["nodePosition"]["mapId"] = "conform_no_such_map"
    _demand_type(probe.refuses(order), "UNKNOWN_MAP_ID")


@case("other_order", "6.6.5.4", edges=2, versions=ONLY)
def other_order(probe: Probe) -> None:
    """An order while another is active: OTHER_ORDER_ACTIVE."""
    way = probe.way(2)
    order = probe.new_order(way)
    probe.accept(order)
    probe.driving()
    _demand_type(probe.refuses(probe.new_order(way)), "OTHER_ORDER_ACTIVE")
    probe.finish(order)


@case("start", "6.6.5.4", edges=2, versions=ONLY)
def start(probe: Probe) -> None:
    """An order that begins elsewhere: START_NODE_OUT_OF_RANGE."""
    error = probe.refuses(probe.new_order(probe.way(2)[1:]))
    _demand_type(error, "START_NODE_OUT_OF_RANGE")


@case("outdated", "6.6.5.4", edges=2, versions=ONLY)
def outdated(probe: Probe) -> None:
    """A lower orderUpdateId: OUTDATED_ORDER_UPDATE."""
    way = probe.way(2)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    update = probe.update(order, way, 1)
    probe.accept(update)
    _demand_type(probe.refused(lambda: probe.order(order)), "OUTDATED_ORDER_UPDATE")
    probe.finish(update)


@case("unusable_field", "6.6.5.4", edges=1, versions=ONLY)
def unusable_field(probe: Probe) -> None:
    """A field that the vehicle can't use: UNSUPPORTED_PARAMETER."""
    order = probe.new_order(probe.way(1))
    order["edges"][0]["maxHeight"] = 0.01
    error = probe.refused(lambda: probe.order(order))
    _demand_type(error, "UNSUPPORTED_PARAMETER")


@case("apart", "6.6", versions=ONLY)
def apart(probe: Probe) -> None:
    """Instant actions are in instantActionStates, not among the order's."""
    id = probe.instant("stateRequest")
    state = probe.finished(id)
    row = next(a for a in view.rows(state, "actionStates") if a.get("actionId") == id)
    demand(row.get("instant"), "it is among the order's actionStates")


@case("names", "7.7", versions=ONLY)
def names(probe: Probe) -> None:
    """A state has the names of 3.0.0, and none of 2.1.0."""
    probe.instant("stateRequest")
    probe.answer()
    for entry in probe.log.heard(Kind.STATE):
        former = [name for name in FORMER if f'"{name}"' in entry.text]
        demand(not former, f"a state has {', '.join(former)}")
