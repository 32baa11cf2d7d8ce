# SPDX-License-Identifier: Apache-2.0
"""What states say, whatever a vehicle leaves out."""

from __future__ import annotations

import math
from collections.abc import Iterable
from datetime import datetime
from typing import Any

Json = dict[str, Any]
OVER = ("FINISHED", "FAILED")


def rows(value: Json | None, key: str) -> list[Json]:
    """Returns the objects of a list, none if it is missing."""
    items = (value or {}).get(key)
    return [row for row in items if isinstance(row, dict)] if isinstance(items, list) else []


def status(state: Json, action_id: str) -> str:
    """Returns the status of an action, '' if the state does not have it."""
    known = [a for a in rows(state, "actionStates") if a.get("actionId") == action_id]
    return str(known[-1].get("actionStatus", "")) if known else ""


def is_over(state: Json, action_id: str) -> bool:
    """Returns whether an action is FINISHED or FAILED."""
    return status(state, action_id) in OVER


def sequences(state: Json, key: str) -> list[int]:
    """Returns the sequenceIds of nodeStates or edgeStates."""
    return [row.get("sequenceId", -1) for row in rows(state, key)]


def reached(state: Json) -> int:
    """Returns the number of the last traversed node; -1 as long as an order that was just taken has
    not begun, whose state has the last node of the order before it still."""
    if 0 in sequences(state, "nodeStates"):
        return -1
    return int(state.get("lastNodeSequenceId", -1))


def has(state: Json, order: Json) -> bool:
    """Returns whether a state is of an order and its update."""
    keys = ("orderId", "orderUpdateId")
    return all(state.get(key) == order[key] for key in keys)


def references(error: Json) -> dict[str, str]:
    """Returns the references of an error."""
    pairs = rows(error, "errorReferences")
    return {str(p.get("referenceKey")): str(p.get("referenceValue")) for p in pairs}


def node_actions(order: Json) -> list[str]:
    """Returns the ids of an order's actions."""
    parts = [*order["nodes"], *order["edges"]]
    return [action["actionId"] for part in parts for action in part["actions"]]


def is_driven(state: Json, order: Json) -> bool:
    """Returns whether an order is over: no nodes, no edges, no action under way, and it stands."""
    over = all(is_over(state, id) for id in node_actions(order))
    left = state.get("nodeStates") or state.get("edgeStates") or state.get("driving")
    return has(state, order) and over and not left


def at(state: Json) -> tuple[float, float] | None:
    """Returns the position [m], None if the state has none."""
    position = state.get("agvPosition")
    try:
        return float(position["x"]), float(position["y"])  # type: ignore[index]
    except (TypeError, KeyError, ValueError):
        return None


def fastest_on(states: Iterable[Json], order: Json, edge: int) -> float:
    """Returns the highest speed of a vehicle on an edge of an order that it has driven [m/s]: that
    of its states there; by their times, if none has a velocity. Those are of the broker's clock,
    and simulated vehicles may be faster by that."""
    start, end = order["nodes"][edge : edge + 2]
    own = [state for state in states if has(state, order)]
    begun = [state for state in own if reached(state) >= start["sequenceId"]]
    after = [state for state in begun if reached(state) >= end["sequenceId"]]
    # The first state may be of the moment in which the node is reached.
    within = begun[1 : len(begun) - len(after)]
    velocities = [v for state in within if isinstance(v := state.get("velocity"), dict)]
    speeds = [math.hypot(v.get("vx", 0.0), v.get("vy", 0.0)) for v in velocities]
    return max(speeds) if speeds else _mean_speed(start, end, begun[0], after[0])


def _mean_speed(start: Json, end: Json, first: Json, last: Json) -> float:
    a, b = start["nodePosition"], end["nodePosition"]
    begin, over = (datetime.fromisoformat(str(s["timestamp"])) for s in (first, last))
    duration = (over - begin).total_seconds()
    return math.hypot(b["x"] - a["x"], b["y"] - a["y"]) / max(duration, 0.1)
