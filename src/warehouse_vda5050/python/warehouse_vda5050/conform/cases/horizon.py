# SPDX-License-Identifier: Apache-2.0
"""Base and horizon (6.6.2): nothing is driven that is not released."""

import math

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Probe
from warehouse_vda5050.conform.verdict import demand

chapter = Chapter("horizon")
case = chapter.case


@case("stops", "6.6.2", edges=2)
def stops(probe: Probe) -> None:
    """The vehicle stops at the end of its base."""
    order = probe.new_order(probe.way(2), released=2)
    probe.accept(order)
    seconds = probe.settings.edge + probe.settings.answer
    probe.until(lambda s: view.reached(s) == 2, "the end of the base", seconds)
    probe.wait(2.0)
    probe.instant("stateRequest")
    state = probe.answer()
    demand(state.get("driving") is False, "it drives on")
    goal, position = order["nodes"][1]["nodePosition"], view.at(state)
    far = math.dist(position, (goal["x"], goal["y"])) if position else 0.0
    demand(far < 0.3 * probe.settings.spacing, f"it is {far:.2f} m beyond the base")


@case("reported", "6.10.6", edges=2)
def reported(probe: Probe) -> None:
    """Nodes and edges of the horizon are reported with released false."""
    order = probe.new_order(probe.way(2), released=2)
    state = probe.accept(order)
    for name, number in (("nodeStates", 4), ("edgeStates", 3)):
        row = next((r for r in view.rows(state, name) if r.get("sequenceId") == number), None)
        demand(row, f"{name} lacks {number}, which is in the horizon")
        demand(row and row.get("released") is False, f"{name}: {number} is not released false")


@case("not_over", "6.6.2", edges=2)
def not_over(probe: Probe) -> None:
    """An order with a horizon is not over at the end of its base."""
    way = probe.way(2)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    seconds = probe.settings.edge + probe.settings.answer
    probe.until(lambda s: view.reached(s) == 2, "the end of the base", seconds)
    probe.never(lambda s: not s.get("nodeStates"), "nodeStates is empty", 1.0)
    probe.refuses(probe.new_order([way[1], way[0]]))


@case("nothing_released", "6.6.2", edges=1)
def nothing_released(probe: Probe) -> None:
    """A vehicle whose first node alone is released does not drive."""
    probe.accept(probe.new_order(probe.way(1), released=1))
    probe.never(lambda s: s.get("driving"), "it drives", 2.0)


@case("base_request", "6.10.3", edges=2)
def base_request(probe: Probe) -> None:
    """newBaseRequest is true or false."""
    state = probe.accept(probe.new_order(probe.way(2), released=2))
    value = state.get("newBaseRequest", False)
    demand(isinstance(value, bool), f"newBaseRequest is {value!r}")


@case("no_base_request", "6.10.3")
def no_base_request(probe: Probe) -> None:
    """A vehicle without an order asks for no base."""
    probe.instant("stateRequest")
    demand(not probe.answer().get("newBaseRequest"), "newBaseRequest is true")


@case("actions", "6.10.6", edges=2)
def actions(probe: Probe) -> None:
    """Actions of the horizon are WAITING."""
    action = probe.harmless()
    order = probe.new_order(probe.way(2), released=2, actions={2: [action]})
    state = probe.accept(order)
    status = view.status(state, action["actionId"])
    demand(status == "WAITING", f"the action is {status or 'not reported'}")
