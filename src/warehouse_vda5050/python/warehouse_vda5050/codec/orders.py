# SPDX-License-Identifier: Apache-2.0
"""Orders and instant actions in the JSON of 2.1.0."""

from typing import Any

from warehouse_vda5050.codec.base import header_json, without_nothing
from warehouse_vda5050.field_rules import ACTION, EDGE, NODE, ORDER, POSITION, demands, shown
from warehouse_vda5050.model import (
    Action,
    BlockingType,
    Edge,
    Header,
    InstantActions,
    Node,
    Position,
    VehicleOrder,
)
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.fields import Fields

NODE_DEMANDS, EDGE_DEMANDS = demands(POSITION), demands(EDGE)


def read_order(fields: Fields, header: Header) -> VehicleOrder:
    """Returns an order. Raises MessageError."""
    fields.skip(*shown(ORDER))
    order = VehicleOrder(
        fields.text("orderId"),
        fields.natural("orderUpdateId"),
        tuple(_read_node(node) for node in fields.objects("nodes")),
        tuple(_read_edge(edge) for edge in fields.objects("edges", ())),
        header,
        fields.text("zoneSetId", ""),
    )
    fields.close()
    return order


def _read_node(fields: Fields) -> Node:
    place = fields.object("nodePosition") or fields.lenient_object("position")
    node = Node(
        fields.text("nodeId"),
        fields.natural("sequenceId"),
        fields.flag("released"),
        read_position(place),
        tuple(read_action(action) for action in fields.objects("actions", ())),
        fields.text("nodeDescription", ""),
        _read_demands(place, NODE_DEMANDS) if place else (),
    )
    fields.skip("position", *shown(NODE))
    fields.close()
    return node


def _read_demands(fields: Fields, names: dict[str, str]) -> tuple[tuple[str, Any], ...]:
    """Returns the optional fields that are there, with their values. Raises MessageError."""
    present = [name for name in names if fields.has(name)]
    fields.skip(*names)
    return tuple((name, getattr(fields, names[name])(name)) for name in present)


def read_position(fields: Fields | None) -> Position | None:
    """Returns a position; None stands for none. Raises MessageError."""
    if fields is None:
        return None
    fields.skip(*shown(POSITION), *NODE_DEMANDS)
    position = Position(
        fields.number("x"),
        fields.number("y"),
        fields.number("theta", None),
        fields.text("mapId", ""),
    )
    fields.close()
    return position


def _read_edge(fields: Fields) -> Edge:
    fields.skip(*shown(EDGE))
    edge = Edge(
        fields.text("edgeId"),
        fields.natural("sequenceId"),
        fields.flag("released"),
        fields.text("startNodeId", ""),
        fields.text("endNodeId", ""),
        tuple(read_action(action) for action in fields.objects("actions", ())),
        _read_demands(fields, EDGE_DEMANDS),
    )
    fields.close()
    return edge


def read_action(fields: Fields, blocking: BlockingType = BlockingType.HARD) -> Action:
    """Returns an action; `blocking` is its type where the message has none. Raises MessageError."""
    action = Action(
        fields.text("actionType"),
        fields.text("actionId"),
        _read_blocking(fields, blocking),
        tuple(_read_parameter(item) for item in fields.objects("actionParameters", ())),
        fields.text("actionDescription", ""),
        fields.flag("retriable", False),
    )
    fields.skip(*shown(ACTION))
    fields.close()
    return action


def _read_blocking(fields: Fields, default: BlockingType) -> BlockingType:
    if fields.strict and not fields.has("blockingType"):
        fields.text("blockingType")
    return enum_of(fields, "blockingType", BlockingType, default)


def _read_parameter(fields: Fields) -> tuple[str, Any]:
    parameter = fields.text("key"), fields.any("value", "")
    fields.close()
    return parameter


def enum_of(fields: Fields, key: str, kind: Any, default: Any) -> Any:
    """Returns a member of an enumeration by its name in whatever letters. Raises MessageError."""
    name = fields.text(key, None)
    if name is None:
        return default
    try:
        return kind(name if fields.strict else name.upper())
    except ValueError:
        names = ", ".join(member.value for member in kind)
        raise MessageError(
            f"{fields.path_of(key)} is {name[:60]!r}; {names} was expected"
        ) from None


def read_instant_actions(fields: Fields, header: Header) -> InstantActions:
    """Returns instant actions, under either of the names that peers send. Raises MessageError."""
    key = "actions" if fields.has("actions") else "instantActions"
    if not fields.has(key) or (fields.strict and key != "actions"):
        raise MessageError("actions is missing; a list was expected")
    fields.skip("actions", "instantActions")
    actions = [read_action(item, BlockingType.NONE) for item in fields.objects(key)]
    fields.close()
    return InstantActions(tuple(actions), header)


def order_json(order: VehicleOrder) -> dict[str, Any]:
    """Returns the object of an order."""
    return {
        **header_json(order.header),
        "orderId": order.id,
        "orderUpdateId": order.update,
        **without_nothing(zoneSetId=order.zone_set),
        "nodes": [_node_json(node) for node in order.nodes],
        "edges": [_edge_json(edge) for edge in order.edges],
    }


def _node_json(node: Node) -> dict[str, Any]:
    return {
        "nodeId": node.id,
        "sequenceId": node.sequence,
        "released": node.released,
        **without_nothing(
            nodeDescription=node.description,
            nodePosition=node.position and {**position_json(node.position), **dict(node.demands)},
        ),
        "actions": [action_json(action) for action in node.actions],
    }


def position_json(position: Position) -> dict[str, Any]:
    """Returns the object of a position."""
    theta = without_nothing(theta=position.theta)
    return {"x": position.x, "y": position.y, **theta, "mapId": position.map_id}


def _edge_json(edge: Edge) -> dict[str, Any]:
    return {
        "edgeId": edge.id,
        "sequenceId": edge.sequence,
        "released": edge.released,
        "startNodeId": edge.start,
        "endNodeId": edge.end,
        **dict(edge.demands),
        "actions": [action_json(action) for action in edge.actions],
    }


def action_json(action: Action) -> dict[str, Any]:
    """Returns the object of an action."""
    return {
        "actionType": action.type,
        "actionId": action.id,
        **without_nothing(actionDescription=action.description),
        "blockingType": action.blocking.value,
        "actionParameters": [{"key": k, "value": v} for k, v in action.parameters],
        **({"retriable": True} if action.retriable else {}),
    }


def instant_actions_json(message: InstantActions) -> dict[str, Any]:
    """Returns the object of instant actions, as `actions`."""
    return {
        **header_json(message.header),
        "actions": [action_json(action) for action in message.actions],
    }
