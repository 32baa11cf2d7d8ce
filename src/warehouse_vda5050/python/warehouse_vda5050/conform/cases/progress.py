# SPDX-License-Identifier: Apache-2.0
"""What all states of the run say one after another (6.10, 6.11)."""

import math
from collections.abc import Iterator
from itertools import pairwise

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("progress")
case = chapter.case
SHOWING = (Kind.STATE, Kind.VISUALIZATION)  # what says where the vehicle is
NEAR = 0.1  # longest time between two positions that are compared [s]
# What an action may become; the same is always allowed.
FOLLOWS = {
    "WAITING": {"INITIALIZING", "RUNNING", "PAUSED", "FINISHED", "FAILED"},
    "INITIALIZING": {"RUNNING", "PAUSED", "FINISHED", "FAILED"},
    "RUNNING": {"PAUSED", "FINISHED", "FAILED"},
    "PAUSED": {"INITIALIZING", "RUNNING", "FINISHED", "FAILED"},
    "FINISHED": set(),
    "FAILED": set(),
}


def _states(probe: Probe) -> list[Json]:
    states = probe.log.values(Kind.STATE)
    if len(states) < 2:
        raise Untestable("fewer than two states came")
    return states


def _of_one_order(probe: Probe) -> list[tuple[Json, Json]]:
    """Pairs of states, one after another, of one order."""
    pairs = pairwise(_states(probe))
    return [(a, b) for a, b in pairs if a.get("orderId") == b.get("orderId") and a.get("orderId")]


@case("ascending", "6.10.6", audit=True)
def ascending(probe: Probe) -> None:
    """nodeStates and edgeStates are in the sequence of the order."""
    for state in _states(probe):
        for name in ("nodeStates", "edgeStates"):
            numbers = view.sequences(state, name)
            demand(numbers == sorted(set(numbers)), f"{name} has {numbers}")


@case("base_first", "6.6.2", audit=True)
def base_first(probe: Probe) -> None:
    """The base comes before the horizon in nodeStates."""
    for state in _states(probe):
        flags = [bool(node.get("released")) for node in view.rows(state, "nodeStates")]
        demand(flags == sorted(flags, reverse=True), f"released is {flags}")


@case("parity", "6.6.2", audit=True)
def parity(probe: Probe) -> None:
    """Nodes have even sequenceIds, edges odd ones."""
    for state in _states(probe):
        nodes, edges = view.sequences(state, "nodeStates"), view.sequences(state, "edgeStates")
        demand(not any(k % 2 for k in nodes), f"nodeStates has {nodes}")
        demand(all(k % 2 for k in edges), f"edgeStates has {edges}")


@case("counts", "6.10.1", audit=True)
def counts(probe: Probe) -> None:
    """There are as many edges left as nodes."""
    for state in _states(probe):
        nodes, edges = view.sequences(state, "nodeStates"), view.sequences(state, "edgeStates")
        demand(0 <= len(nodes) - len(edges) <= 1, f"nodes {nodes} with edges {edges}")


@case("onwards", "6.10.2", audit=True)
def onwards(probe: Probe) -> None:
    """lastNodeSequenceId never goes back within an order."""
    for a, b in _of_one_order(probe):
        before, after = view.reached(a), view.reached(b)
        demand(before <= after, f"lastNodeSequenceId {after} follows {before}")


@case("updates_onwards", "6.6.4.3", audit=True)
def updates_onwards(probe: Probe) -> None:
    """orderUpdateId never goes back within an order."""
    for a, b in _of_one_order(probe):
        before, after = a["orderUpdateId"], b["orderUpdateId"]
        demand(before <= after, f"orderUpdateId {after} follows {before}")


@case("life_cycle", "6.11", audit=True)
def life_cycle(probe: Probe) -> None:
    """An action's status never goes back: what is over stays over."""
    known: dict[str, str] = {}
    for state in _states(probe):
        for row in view.rows(state, "actionStates"):
            id, status = str(row.get("actionId")), str(row.get("actionStatus"))
            before = known.get(id, status)
            allowed = before == status or status in FOLLOWS.get(before, {status})
            demand(allowed, f"{id} is {status} after {before}")
            known[id] = status


@case("once", "6.11", audit=True)
def once(probe: Probe) -> None:
    """An action is in actionStates once."""
    for state in _states(probe):
        ids = [row.get("actionId") for row in view.rows(state, "actionStates")]
        demand(len(set(ids)) == len(ids), f"actionStates has {sorted(map(str, ids))!r:.200}")


@case("moves_driving", "6.10.6", audit=True)
def moves_driving(probe: Probe) -> None:
    """While the position changes, driving is true."""
    for a, b in pairwise(_states(probe)):
        here, there = view.at(a), view.at(b)
        stands = a.get("driving") is False and b.get("driving") is False
        if stands and here and there and a.get("orderId") == b.get("orderId"):
            far = math.dist(here, there)
            demand(far < 0.5 * probe.settings.spacing, f"it moved {far:.2f} m, driving false")


@case("paused_stands", "6.8.2", audit=True)
def paused_stands(probe: Probe) -> None:
    """Once startPause is FINISHED, driving is false until stopPause."""
    for a, b in pairwise(_states(probe)):
        stood = a.get("paused") and not a.get("driving") and b.get("paused")
        demand(not (stood and b.get("driving")), "driving is true while it is paused")


@case("gaps", "6.10", audit=True)
def gaps(probe: Probe) -> None:
    """Between two states are never more than 30 s."""
    times = [entry.time for entry in probe.log.heard(Kind.STATE)]
    longest = max((b - a for a, b in pairwise(times)), default=0.0)
    demand(longest <= probe.settings.idle, f"{longest:.1f} s between two states")


def _between(a: Entry, b: Entry) -> float:
    """Returns the longest time that may lie between two messages [s]. The network, or a busy
    machine, may deliver together what was sent one after another; some vehicles stamp whole
    seconds."""
    return max(abs(a.time - b.time), abs((a.stamp - b.stamp).total_seconds()))


def _apart(probe: Probe) -> Iterator[tuple[float, float]]:
    """Yields the time [s] and the distance [m] between a state and a visualization, where one is
    the newest of its kind when the other comes, and both are nearly of one moment."""
    last: dict[Kind, tuple[Entry, tuple[float, float]]] = {}
    for entry in probe.log.entries:
        value = entry.value or {}
        position = view.at(value) if "timestamp" in value and entry.kind in SHOWING else None
        if position is None or entry.sent:
            continue
        last[entry.kind] = entry, position
        if len(last) == len(SHOWING):
            (a, here), (b, there) = last.values()
            if (seconds := _between(a, b)) < NEAR:
                yield seconds, math.dist(here, there)


@case("agreement", "6.13", audit=True)
def agreement(probe: Probe) -> None:
    """visualization and state have the vehicle at one place."""
    pairs = [*_apart(probe)]
    if not pairs:
        raise Untestable(f"no visualization came within {NEAR} s of a state")
    fastest = (probe.sheet.get("physicalParameters") or {}).get("speedMax", 0.0)
    were_apart = len(pairs) == 1
    for seconds, far in pairs:
        are_apart = far >= 0.5 * probe.settings.spacing + fastest * seconds
        # Once may be a vehicle that was held up between measuring and sending.
        text = f"they are {far:.2f} m apart, {seconds:.2f} s after one another"
        demand(not (are_apart and were_apart), text)
        were_apart = are_apart
