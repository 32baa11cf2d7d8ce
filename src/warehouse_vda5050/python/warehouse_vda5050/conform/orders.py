# SPDX-License-Identifier: Apache-2.0
"""Orders as JSON with the names of 2.1.0."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from warehouse_vda5050.conform.ground import Place

Json = dict[str, Any]


def order_of(
    id: str, way: Sequence[Place], *, released: int | None = None, update: int = 0, first: int = 0
) -> Json:
    """Returns an order along a way. released: count of the nodes of its base, all by default;
    first: number of its first node in the order, not 0 in an update."""
    base = len(way) if released is None else released
    nodes = [_node(place, 2 * (first + k), k < base) for k, place in enumerate(way)]
    edges = [_edge(a, b) for a, b in zip(nodes, nodes[1:])]
    return {"orderId": id, "orderUpdateId": update, "nodes": nodes, "edges": edges}


def _node(place: Place, sequence: int, released: bool) -> Json:
    position = {"x": place.x, "y": place.y, "mapId": place.map_id}
    return {
        "nodeId": place.id,
        "sequenceId": sequence,
        "released": released,
        "nodePosition": position,
        "actions": [],
    }


def _edge(a: Json, b: Json) -> Json:
    return {
        "edgeId": f"{a['nodeId']}-{b['nodeId']}",
        "sequenceId": a["sequenceId"] + 1,
        "released": b["released"],
        "startNodeId": a["nodeId"],
        "endNodeId": b["nodeId"],
        "actions": [],
    }


def action_of(
    type: str, id: str, blocking: str = "HARD", parameters: Iterable[tuple[str, Any]] = ()
) -> Json:
    """Returns an action of a node, an edge, or instant actions."""
    return {
        "actionType": type,
        "actionId": id,
        "blockingType": blocking,
        "actionParameters": [{"key": key, "value": value} for key, value in parameters],
    }
