# SPDX-License-Identifier: Apache-2.0
"""Instant actions (6.9): each is reported, and carried out at once."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.orders import action_of
from warehouse_vda5050.conform.probe import Probe
from warehouse_vda5050.conform.verdict import Unsupported, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("instant")
case = chapter.case


@case("state_request", "6.8.2")
def state_request(probe: Probe) -> None:
    """stateRequest is FINISHED once the state was sent."""
    probe.finished(probe.instant("stateRequest"))


@case("reported", "6.9")
def reported(probe: Probe) -> None:
    """An instant action appears in actionStates with its id and type."""
    id = probe.instant("stateRequest")
    state = probe.until(lambda s: view.status(s, id), f"{id} in actionStates")
    row = next(a for a in view.rows(state, "actionStates") if a.get("actionId") == id)
    demand(row.get("actionType") == "stateRequest", f"actionType is {row.get('actionType')!r}")


@case("two", "6.9")
def two(probe: Probe) -> None:
    """All actions of one message are carried out."""
    ids = [probe.new_id("stateRequest") for _ in range(2)]
    actions = [action_of("stateRequest", id, "NONE") for id in ids]
    probe.send(Kind.INSTANT_ACTIONS, {"actions": actions})
    for id in ids:
        probe.finished(id)


@case("unknown", "6.9")
def unknown(probe: Probe) -> None:
    """An action that the vehicle does not know is FAILED."""
    id = probe.instant("conformUnknown")
    status = probe.over(id)
    demand(status == "FAILED", f"the unknown action is {status}")


@case("unknown_error", "6.10.5")
def unknown_error(probe: Probe) -> None:
    """An action that the vehicle does not know comes with an error."""
    id = probe.new_id("unknown")
    error = probe.refused(lambda: probe.instant("conformUnknown", id=id), refer=id)
    pairs = view.references(error)
    demand(id in pairs.values(), f"references are {pairs}; actionId was expected")


@case("known_beside_unknown", "6.9", strict=True)
def known_beside_unknown(probe: Probe) -> None:
    """Beside an unknown action the others are carried out."""
    id = probe.new_id("stateRequest")
    actions = [action_of("conformUnknown", probe.new_id("unknown"), "NONE")]
    probe.send(Kind.INSTANT_ACTIONS, {"actions": [*actions, action_of("stateRequest", id, "NONE")]})
    probe.finished(id)


@case("during_order", "6.9", edges=2)
def during_order(probe: Probe) -> None:
    """An instant action changes nothing of the order under way."""
    order = probe.new_order(probe.way(2))
    probe.accept(order)
    probe.driving()
    probe.finished(probe.instant("stateRequest"))
    demand(view.has(probe.state, order), "the order is another one")
    probe.finish(order)


@case("log_report", "6.8.2")
def log_report(probe: Probe) -> None:
    """logReport is FINISHED, and resultDescription names the log."""
    probe.need("logReport", "INSTANT")
    id = probe.instant("logReport", [("reason", "conform")])
    state = probe.finished(id, probe.settings.edge)
    row = next(a for a in view.rows(state, "actionStates") if a.get("actionId") == id)
    demand(row.get("resultDescription"), "resultDescription is empty")


@case("init_elsewhere", "6.8.2")
def init_elsewhere(probe: Probe) -> None:
    """initPosition on a map that the vehicle does not have is FAILED."""
    probe.need("initPosition", "INSTANT")
    position = probe.state.get("agvPosition") or {"x": 0.0, "y": 0.0, "theta": 0.0}
    pose = [(key, position[key]) for key in ("x", "y", "theta")]
    node = ("lastNodeId", str(probe.state.get("lastNodeId")))
    id = probe.instant("initPosition", [*pose, ("mapId", "conform_no_such_map"), node])
    status = probe.over(id)
    demand(status == "FAILED", f"it is {status}")


@case("init_without", "6.8.1")
def init_without(probe: Probe) -> None:
    """initPosition without x, y, theta is FAILED."""
    probe.need("initPosition", "INSTANT")
    status = probe.over(probe.instant("initPosition"))
    demand(status == "FAILED", f"it is {status}")


@case("charging", "6.8.2")
def charging(probe: Probe) -> None:
    """startCharging ends; FINISHED means charging true, FAILED comes with an error."""
    if not probe.supports("startCharging", "INSTANT"):
        raise Unsupported("the factsheet has no startCharging for INSTANT")
    id = probe.instant("startCharging")
    state = probe.until(lambda s: view.is_over(s, id), f"{id} over", probe.settings.edge)
    if view.status(state, id) == "FINISHED":
        demand((state.get("batteryState") or {}).get("charging") is True, "charging is not true")
        if probe.supports("stopCharging", "INSTANT"):
            probe.over(probe.instant("stopCharging"), seconds=probe.settings.edge)
    else:
        demand(view.rows(state, "errors"), "it is FAILED, and errors is empty")


@case("many", "6.15.1")
def many(probe: Probe) -> None:
    """More instant actions than maxArrayLens says are refused, or all carried out."""
    limits = (probe.sheet.get("protocolLimits") or {}).get("maxArrayLens") or {}
    most = limits.get("instantActions")
    if not isinstance(most, int) or not 0 < most <= 200:
        raise Unsupported(f"maxArrayLens has {most} for instantActions")
    ids = [probe.new_id("stateRequest") for _ in range(most + 1)]
    actions = [action_of("stateRequest", id, "NONE") for id in ids]
    before = len(view.rows(probe.state, "errors"))
    probe.send(Kind.INSTANT_ACTIONS, {"actions": actions})
    probe.until(
        lambda s: len(view.rows(s, "errors")) > before or all(view.is_over(s, id) for id in ids),
        "an error, or all actions over",
    )
