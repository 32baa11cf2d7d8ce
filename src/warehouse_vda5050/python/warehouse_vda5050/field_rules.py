# SPDX-License-Identifier: Apache-2.0
"""What becomes of each field of a message: driven, checked, refused, or for people alone.

A vehicle cannot ignore an optional field (2.1, 6.1.1). The codec reads what stands here, and
validation.demands checks it; a field that is not here is unknown, and warned of. Names are those of
2.1.0, and of 3.0.0 where that alone has the field.
"""

from dataclasses import dataclass
from enum import StrEnum


class Use(StrEnum):
    """What a vehicle makes of a field."""

    DRIVEN = "driven"  # it does what the field says
    CHECKED = "checked"  # as long as it does so anyway; otherwise the order is refused
    REFUSED = "refused"  # an order with the field is refused
    SHOWN = "for people"  # descriptions, which change nothing


class Kind(StrEnum):
    """The JSON type of a demand; its value is the method of Fields that reads it."""

    NUMBER = "number"
    FLAG = "flag"
    TEXT = "text"
    ANY = "any"


@dataclass(frozen=True)
class Rule:
    """What becomes of one field, in words. Fields with a `kind` are demands of a node or edge."""

    name: str
    use: Use
    text: str
    kind: Kind | None = None

    @property
    def is_optional(self) -> bool:
        """Whether a node or edge may go without it, and demands something by it."""
        return self.kind is not None or self.name == "theta"


ORDER = (
    Rule("orderId", Use.DRIVEN, "updates, copies and late copies are known by it"),
    Rule("orderUpdateId", Use.DRIVEN, "3.0.0: a new order begins with 0"),
    Rule("orderDescription", Use.SHOWN, ""),
    Rule("zoneSetId", Use.REFUSED, "no zones are known; an empty one is let pass"),
    Rule("nodes", Use.DRIVEN, "1 to 1000"),
    Rule("edges", Use.DRIVEN, "one less than nodes"),
)
NODE = (
    Rule("nodeId", Use.CHECKED, "one like c3_4 has to be the cell of the nodePosition"),
    Rule("sequenceId", Use.CHECKED, "in order, without gaps"),
    Rule("released", Use.DRIVEN, "the base comes before the horizon"),
    Rule("nodeDescription", Use.SHOWN, ""),
    Rule("nodeDescriptor", Use.SHOWN, ""),
    Rule("nodePosition", Use.DRIVEN, "left out: nodeId says where"),
    Rule("actions", Use.DRIVEN, "at most 20"),
)
POSITION = (
    Rule("x", Use.DRIVEN, "the middle of a cell, within 0.1 m"),
    Rule("y", Use.DRIVEN, "the middle of a cell, within 0.1 m"),
    Rule("theta", Use.CHECKED, "the heading in which the robot comes to the node"),
    Rule("mapId", Use.CHECKED, "the map of this floor; 3.0.0: UNKNOWN_MAP_ID"),
    Rule("mapDescription", Use.SHOWN, ""),
    Rule(
        "allowedDeviationXY",
        Use.CHECKED,
        "refused below what the robot keeps, except 0; in 3.0.0 an ellipse",
        Kind.ANY,
    ),
    Rule("allowedDeviationTheta", Use.CHECKED, "how far from theta it may be", Kind.NUMBER),
)
EDGE = (
    Rule("edgeId", Use.DRIVEN, "reported in edgeStates"),
    Rule("sequenceId", Use.CHECKED, "in order, without gaps"),
    Rule("released", Use.CHECKED, "as the node at its end"),
    Rule("startNodeId", Use.CHECKED, "the node before it"),
    Rule("endNodeId", Use.CHECKED, "the node after it"),
    Rule("edgeDescription", Use.SHOWN, ""),
    Rule("edgeDescriptor", Use.SHOWN, ""),
    Rule("actions", Use.REFUSED, "actions belong to nodes"),
    Rule("maxSpeed", Use.DRIVEN, "0.01 m/s or more, from node to node", Kind.NUMBER),
    Rule("maxHeight", Use.CHECKED, "refused below the robot's height, with its load", Kind.NUMBER),
    Rule("minHeight", Use.CHECKED, "refused above 0: the lift is moved at nodes", Kind.NUMBER),
    Rule("orientation", Use.CHECKED, "forwards along the edge", Kind.NUMBER),
    Rule("orientationType", Use.CHECKED, "GLOBAL or TANGENTIAL", Kind.TEXT),
    Rule("direction", Use.REFUSED, "for vehicles that follow lines", Kind.TEXT),
    Rule("rotationAllowed", Use.DRIVEN, "robots turn at nodes alone", Kind.FLAG),
    Rule("reachOrientationBeforeEntering", Use.DRIVEN, "robots turn at nodes alone", Kind.FLAG),
    Rule("maxRotationSpeed", Use.DRIVEN, "robots do not turn on an edge", Kind.NUMBER),
    Rule("length", Use.CHECKED, "the distance of its nodes", Kind.NUMBER),
    Rule("trajectory", Use.REFUSED, "edges are straight", Kind.ANY),
    Rule("corridor", Use.REFUSED, "robots do not leave their edge", Kind.ANY),
)
ACTION = (
    Rule("actionType", Use.DRIVEN, "one of the factsheet's"),
    Rule("actionId", Use.DRIVEN, "identifies it in actionStates"),
    Rule("actionDescription", Use.SHOWN, ""),
    Rule("actionDescriptor", Use.SHOWN, ""),
    Rule("blockingType", Use.DRIVEN, "lifting and charging hold the robot in any case"),
    Rule("actionParameters", Use.CHECKED, "those of the factsheet; others are refused"),
    Rule("retriable", Use.DRIVEN, "3.0.0: if it fails it waits for retry or skipRetry"),
)
INSTANT_ACTIONS = (
    Rule("actions", Use.DRIVEN, "at most 20 a message; instantActions means the same"),
    Rule("instantActions", Use.DRIVEN, "as some peers of 2.0.0 send it"),
)
HEADER = (
    Rule("headerId", Use.SHOWN, "strict: required"),
    Rule("timestamp", Use.SHOWN, "strict: required"),
    Rule("version", Use.CHECKED, "the same major version; strict: required"),
    Rule("manufacturer", Use.CHECKED, "the vehicle's own; strict: required"),
    Rule("serialNumber", Use.CHECKED, "the vehicle's own; strict: required"),
)
# By where in a message the fields stand.
TABLE: dict[str, tuple[Rule, ...]] = {
    "order": (*HEADER, *ORDER),
    "order.nodes": NODE,
    "order.nodes.nodePosition": POSITION,
    "order.edges": EDGE,
    "order.nodes.actions": ACTION,
    "instantActions": (*HEADER, *INSTANT_ACTIONS),
    "instantActions.actions": ACTION,
}
# Fields of a state that only some vehicles report, and these do not.
NOT_TOLD = (
    "zoneSetId",
    "information",
    "nodeStates.nodeDescription",
    "edgeStates.edgeDescription",
    "edgeStates.trajectory",
    "agvPosition.mapDescription",
    "agvPosition.localizationScore",
    "agvPosition.deviationRange",
    "loads.loadPosition",
    "loads.boundingBoxReference",
    "loads.loadDimensions",
    "loads.weight",
    "actionStates.actionDescription",
    "batteryState.batteryVoltage",
    "batteryState.batteryHealth",
    "batteryState.reach",
    "maps.mapDescription",
)


def shown(rules: tuple[Rule, ...]) -> tuple[str, ...]:
    """Returns the names of fields that are for people alone."""
    return tuple(rule.name for rule in rules if rule.use is Use.SHOWN)


def demands(rules: tuple[Rule, ...]) -> dict[str, str]:
    """Returns the names of the optional fields that a node or edge may demand something by, and the
    method of Fields that reads each."""
    return {rule.name: rule.kind.value for rule in rules if rule.kind}
