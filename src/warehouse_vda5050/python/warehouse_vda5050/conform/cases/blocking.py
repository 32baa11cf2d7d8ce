# SPDX-License-Identifier: Apache-2.0
"""Blocking types, and the sequence of actions (6.12)."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import Unsupported, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("blocking")
case = chapter.case


def _pair(probe: Probe, first: str, second: str) -> tuple[Json, Json, Json]:
    """An order with two harmless actions at its first node."""
    if not probe.is_held:
        raise Unsupported("no action waits for a trigger")
    a, b = probe.harmless(first), probe.harmless(second)
    order = probe.new_order(probe.way(1), actions={0: [a, b]})
    probe.accept(order)
    return order, a, b


def _end(probe: Probe, order: Json) -> Json:
    """Lets all actions come to their end, one after another."""
    for action in order["nodes"][0]["actions"]:
        _end_one(probe, action["actionId"])
    return probe.finish(order)


def _end_one(probe: Probe, id: str) -> None:
    probe.until(lambda s: view.status(s, id) != "WAITING", "its turn")
    if not view.is_over(probe.state, id):
        probe.finish_actions()
    probe.over(id)


@case("hard_stands", "6.12", edges=1)
def hard_stands(probe: Probe) -> None:
    """HARD: the vehicle does not drive while the action runs."""
    _stands(probe, "HARD")


@case("soft_stands", "6.12", edges=1)
def soft_stands(probe: Probe) -> None:
    """SOFT: the vehicle does not drive while the action runs."""
    _stands(probe, "SOFT")


def _stands(probe: Probe, blocking: str) -> None:
    action = probe.harmless(blocking)
    order = probe.new_order(probe.way(1), actions={0: [action]})
    mark = len(probe.log.entries)
    probe.accept(order)
    probe.running(action)
    probe.wait(1.5)
    probe.finish_actions()
    probe.finish(order)
    for state in probe.log.values(Kind.STATE, mark):
        runs = view.status(state, action["actionId"]) in ("WAITING", "INITIALIZING", "RUNNING")
        drives = state.get("driving") and view.has(state, order)
        demand(not (runs and drives), "it drives while the action runs")


@case("hard_stops", "6.12", edges=2)
def hard_stops(probe: Probe) -> None:
    """HARD on the way: the vehicle stops at the node."""
    action = probe.harmless("HARD")
    order = probe.new_order(probe.way(2), actions={1: [action]})
    mark = len(probe.log.entries)
    probe.accept(order)
    probe.running(action)
    probe.wait(1.5)
    probe.finish_actions()
    probe.finish(order)
    for state in probe.log.values(Kind.STATE, mark):
        runs = view.status(state, action["actionId"]) == "RUNNING"
        demand(not (runs and state.get("driving")), "it drives while the action runs")


@case("none_drives", "6.12", edges=1)
def none_drives(probe: Probe) -> None:
    """NONE: the vehicle drives while the action runs."""
    if not probe.is_held:
        raise Unsupported("no action waits for a trigger")
    action = probe.harmless("NONE")
    order = probe.new_order(probe.way(1), actions={0: [action]})
    probe.accept(order)
    probe.running(action)
    probe.until(
        lambda s: view.reached(s) == 2 and view.has(s, order),
        "the next node while the action runs",
        probe.settings.edge,
    )
    demand(view.status(probe.state, action["actionId"]) == "RUNNING", "the action runs no longer")
    probe.finish_actions()
    probe.finish(order)


@case("sequence", "6.12", edges=1)
def sequence(probe: Probe) -> None:
    """HARD after HARD: the second waits until the first is over."""
    order, a, b = _pair(probe, "HARD", "HARD")
    probe.running(a)
    waits = view.status(probe.state, b["actionId"])
    demand(waits == "WAITING", f"the second is {waits} while the first runs")
    _end(probe, order)


@case("order_kept", "6.12", edges=1)
def order_kept(probe: Probe) -> None:
    """The order in the list is the sequence of execution."""
    mark = len(probe.log.entries)
    order, a, b = _pair(probe, "HARD", "HARD")
    _end(probe, order)
    for state in probe.log.values(Kind.STATE, mark):
        later = view.status(state, b["actionId"]) in ("RUNNING", "FINISHED")
        demand(not later or view.is_over(state, a["actionId"]), "the second came first")


@case("hard_after_none", "6.12", edges=1)
def hard_after_none(probe: Probe) -> None:
    """HARD after NONE waits: it runs beside no other action."""
    order, a, b = _pair(probe, "NONE", "HARD")
    probe.running(a)
    probe.wait(1.0)
    both = [view.status(probe.state, action["actionId"]) for action in (a, b)]
    demand(both.count("RUNNING") < 2, "both run")
    _end(probe, order)


@case("none_after_hard", "6.12", edges=1)
def none_after_hard(probe: Probe) -> None:
    """NONE after HARD waits: HARD runs beside no other action."""
    order, a, b = _pair(probe, "HARD", "NONE")
    probe.running(a)
    probe.wait(1.0)
    waits = view.status(probe.state, b["actionId"])
    demand(waits == "WAITING", f"the second is {waits} while HARD runs")
    _end(probe, order)


@case("before_driving", "6.12", edges=1)
def before_driving(probe: Probe) -> None:
    """The next edge is driven when blocking actions are over."""
    order, a, b = _pair(probe, "SOFT", "HARD")
    _end(probe, order)
    states = [view.status(probe.state, action["actionId"]) for action in (a, b)]
    demand(states == ["FINISHED", "FINISHED"], f"they are {states}")
