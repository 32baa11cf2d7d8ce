# SPDX-License-Identifier: Apache-2.0
"""Which fields orders and instant actions must have, and of which type, by the names of 2.1.0."""

from __future__ import annotations

from typing import Any

from warehouse_vda5050.conform.form import (
    HEADER,
    Form,
    anything,
    faults_of,
    flag,
    natural,
    number,
    text,
    word_of,
)
from warehouse_vda5050.topics import Kind

BLOCKING = ("NONE", "SOFT", "HARD")
Json = dict[str, Any]
PLACE: Form = {
    "x": number,
    "y": number,
    "theta?": number,
    "mapId": text,
    "allowedDeviationTheta?": number,
    "allowedDeviationXY?": anything,  # a number, in 3.0 an ellipse
}


def faults(kind: Kind, value: Json | None, version: str) -> list[str]:
    """Returns what is wrong with a message of a master, a line each."""
    if value is None:
        return ["it is no JSON object"]
    is_new = version.startswith("3")
    if kind is Kind.ORDER:
        return faults_of(_order(is_new), value)
    if version == "2.0.0" and "actions" not in value and "instantActions" in value:
        value = {**value, "actions": value["instantActions"]}
    return faults_of({**HEADER, "actions": [_action(is_new)]}, value)


def _order(is_new: bool) -> Form:
    action = _action(is_new)
    node: Form = {
        "nodeId": text,
        "sequenceId": natural,
        "released": flag,
        "nodePosition?": PLACE,
        "actions": [action],
    }
    ends: Form = {} if is_new else {"startNodeId": text, "endNodeId": text}
    edge: Form = {
        "edgeId": text,
        "sequenceId": natural,
        "released": flag,
        **ends,
        "maxSpeed?": number,
        "maxHeight?": number,
        "minHeight?": number,
        "orientation?": number,
        "rotationAllowed?": flag,
        "maxRotationSpeed?": number,
        "length?": number,
        "actions": [action],
    }
    return {
        **HEADER,
        "orderId": text,
        "orderUpdateId": natural,
        "zoneSetId?": text,
        "nodes": [node],
        "edges": [edge],
    }


def _action(is_new: bool) -> Form:
    words = (*BLOCKING, "SINGLE") if is_new else BLOCKING
    return {
        "actionType": text,
        "actionId": text,
        "blockingType": word_of(*words),
        "actionParameters?": [{"key": text, "value": anything}],
    }
