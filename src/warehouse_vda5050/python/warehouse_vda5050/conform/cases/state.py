# SPDX-License-Identifier: Apache-2.0
"""When a state comes, and what stands in it (6.10)."""

import math

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("state")
case = chapter.case
MODES = {"AUTOMATIC", "SEMIAUTOMATIC", "MANUAL", "SERVICE", "TEACHIN"}


@case("interval", "6.10")
def interval(probe: Probe) -> None:
    """A state comes at the latest 30 s after the last one."""
    times = [entry.time for entry in probe.log.heard(Kind.STATE)]
    demand(times, "no state came")
    limit = probe.settings.idle
    end = times[-1] + limit
    while probe.now() < end:
        probe.wait(0.2)
        if [*probe.log.heard(Kind.STATE)][-1].time > times[-1]:
            return
    demand(False, f"no state within {limit:.0f} s")


@case("on_request", "6.8.1")
def on_request(probe: Probe) -> None:
    """stateRequest is answered by a state at once."""
    probe.instant("stateRequest")
    probe.answer("stateRequest")


@case("on_order", "6.10", edges=1)
def on_order(probe: Probe) -> None:
    """Receiving an order triggers a state."""
    order = probe.new_order(probe.way(0))
    probe.order(order)
    probe.answer("an order")
    probe.finish(order)


@case("on_copy", "6.10", edges=1, strict=True)
def on_copy(probe: Probe) -> None:
    """Receiving the same order again triggers a state, too."""
    order = probe.new_order(probe.way(0))
    probe.drive(order)
    probe.order(order)
    probe.answer("a copy of the order")


@case("on_node", "6.10", edges=3)
def on_node(probe: Probe) -> None:
    """Driving over a node triggers a state: each node is lastNodeId once."""
    way = probe.way(min(3, probe.ground.edges if probe.ground else 3))
    order = probe.new_order(way)
    mark = len(probe.log.entries)
    probe.drive(order)
    states = probe.log.values(Kind.STATE, mark)
    last = {s.get("lastNodeSequenceId") for s in states if view.has(s, order)}
    missing = [n["sequenceId"] for n in order["nodes"] if n["sequenceId"] not in last]
    demand(not missing, f"no state had lastNodeSequenceId {missing}")


@case("on_driving", "6.10", edges=1)
def on_driving(probe: Probe) -> None:
    """driving becomes true at the start, and false at the end."""
    order = probe.new_order(probe.way(1))
    mark = len(probe.log.entries)
    probe.drive(order)
    values = [s.get("driving") for s in probe.log.values(Kind.STATE, mark)]
    demand(True in values, "driving was never true")
    demand(values[-1] is False, "driving is true at the end")


@case("on_nodes", "6.10", edges=2)
def on_nodes(probe: Probe) -> None:
    """A change of nodeStates or edgeStates triggers a state."""
    order = probe.new_order(probe.way(2))
    mark = len(probe.log.entries)
    probe.drive(order)
    states = [s for s in probe.log.values(Kind.STATE, mark) if view.has(s, order)]
    counts = {len(view.rows(s, "nodeStates")) for s in states}
    edges = {len(view.rows(s, "edgeStates")) for s in states}
    demand({0, 1, 2} <= counts, f"states had {sorted(counts)} nodeStates; 2, 1, 0 were expected")
    demand({0, 1, 2} <= edges, f"states had {sorted(edges)} edgeStates; 2, 1, 0 were expected")


@case("position", "6.10.6")
def position(probe: Probe) -> None:
    """agvPosition has numbers, a map, theta from -pi to pi, and is initialized."""
    position = probe.state.get("agvPosition")
    if position is None:
        raise Untestable("agvPosition is optional, and this vehicle has none")
    numbers = [position.get(key) for key in ("x", "y", "theta")]
    demand(all(_is_number(n) for n in numbers), f"x, y, theta are {numbers}")
    demand(abs(numbers[2]) <= math.pi + 1e-9, f"theta is {numbers[2]}")
    demand(position.get("mapId"), "mapId is empty")
    demand(position.get("positionInitialized") is True, "positionInitialized is not true")


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


@case("maps", "6.7.2", versions=("2.1.0", "3.0.0"))
def maps(probe: Probe) -> None:
    """The map of the position is among maps, and ENABLED."""
    if "maps" not in probe.state:
        raise Untestable("maps is optional, and this vehicle has none")
    here = (probe.state.get("agvPosition") or {}).get("mapId")
    known = {m.get("mapId"): m.get("mapStatus") for m in view.rows(probe.state, "maps")}
    demand(here in known, f"mapId {here} is not among {sorted(map(str, known))}")
    demand(known[here] == "ENABLED", f"map {here} is {known[here]}")


@case("idle", "6.10.1")
def idle(probe: Probe) -> None:
    """A vehicle without an order has empty nodeStates and edgeStates, and driving is false."""
    state: Json = probe.state
    for name in ("nodeStates", "edgeStates"):
        demand(state.get(name) == [], f"{name} is {state.get(name)!r:.80}")
    demand(state.get("driving") is False, "driving is not false")


@case("mode", "6.10.6")
def mode(probe: Probe) -> None:
    """operatingMode is one of the five; AUTOMATIC takes orders."""
    value = probe.state.get("operatingMode")
    demand(value in MODES, f"operatingMode is {value!r}")


@case("battery", "6.10.6")
def battery(probe: Probe) -> None:
    """batteryCharge is 0 to 100 percent, charging true or false."""
    battery = probe.state.get("batteryState") or {}
    charge = battery.get("batteryCharge", -1.0)
    demand(_is_number(charge) and 0 <= charge <= 100, f"batteryCharge is {charge!r}")
    demand(isinstance(battery.get("charging"), bool), f"charging is {battery.get('charging')!r}")


@case("safety", "6.10.6")
def safety(probe: Probe) -> None:
    """safetyState has eStop and fieldViolation."""
    state = probe.state.get("safetyState") or {}
    stops = {"NONE", "AUTOACK", "MANUAL", "REMOTE"}
    demand(state.get("eStop") in stops, f"eStop is {state.get('eStop')!r}")
    demand(isinstance(state.get("fieldViolation"), bool), "fieldViolation is no boolean")


@case("first_node", "6.6.1")
def first_node(probe: Probe) -> None:
    """A vehicle says by lastNodeId or agvPosition where an order may begin."""
    known = probe.state.get("lastNodeId") or probe.state.get("agvPosition")
    demand(known, "neither lastNodeId nor agvPosition is there")


@case("order_kept", "6.10.6", edges=1)
def order_kept(probe: Probe) -> None:
    """orderId and orderUpdateId are kept after the end of an order."""
    order = probe.new_order(probe.way(0))
    probe.drive(order)
    probe.instant("stateRequest")
    demand(view.has(probe.answer(), order), "orderId or orderUpdateId is lost")


@case("where", "6.10.6", edges=1)
def where(probe: Probe) -> None:
    """agvPosition follows the vehicle: at the end it is at the last node."""
    order = probe.new_order(probe.way(1))
    state = probe.drive(order)
    goal = order["nodes"][-1]["nodePosition"]
    position = view.at(state)
    demand(position, "the state has no agvPosition")
    assert position
    far = math.dist(position, (goal["x"], goal["y"]))
    demand(far < 0.3 * probe.settings.spacing, f"it is {far:.2f} m from the last node")
