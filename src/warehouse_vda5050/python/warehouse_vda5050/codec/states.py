# SPDX-License-Identifier: Apache-2.0
"""Messages of vehicles in the JSON of 2.1.0: state, connection, visualization."""

from typing import Any

from warehouse_vda5050.codec.base import header_json, without_nothing
from warehouse_vda5050.codec.orders import enum_of, position_json, read_position
from warehouse_vda5050.codec.paths import read_intermediate, read_planned
from warehouse_vda5050.codec.zones import read_zone_request, read_zone_set_state
from warehouse_vda5050.errors import Error, ErrorLevel
from warehouse_vda5050.model import (
    ActionState,
    ActionStatus,
    AgvPosition,
    Battery,
    Connection,
    ConnectionState,
    EdgeState,
    Header,
    Load,
    NodeState,
    OperatingMode,
    VehicleState,
    Velocity,
    Visualization,
)
from warehouse_vda5050.validation.fields import Fields


def state_json(state: VehicleState) -> dict[str, Any]:
    """Returns the object of a state.

    A paused action is reported as RUNNING, with `paused` beside it: the published schema of 2.1.0
    lacks PAUSED, and masters drop what does not fit it.
    """
    return {
        **header_json(state.header),
        "maps": [{"mapId": name, "mapVersion": "1", "mapStatus": "ENABLED"} for name in state.maps],
        "orderId": state.order_id,
        "orderUpdateId": state.order_update,
        "lastNodeId": state.last_node,
        "lastNodeSequenceId": state.last_node_sequence,
        "driving": state.driving,
        "paused": state.paused,
        "newBaseRequest": state.new_base_request,
        **without_nothing(distanceSinceLastNode=state.distance_since_last_node),
        "operatingMode": state.mode.value,
        "nodeStates": [_node_state_json(node) for node in state.nodes],
        "edgeStates": [
            {"edgeId": edge.id, "sequenceId": edge.sequence, "released": edge.released}
            for edge in state.edges
        ],
        **_motion_json(state.position, state.velocity),
        "loads": [{"loadId": load.id, "loadType": load.type} for load in state.loads],
        "actionStates": [_action_state_json(action) for action in state.actions],
        "batteryState": {
            "batteryCharge": state.battery.charge,
            "charging": state.battery.charging,
        },
        "errors": [_error_json(error) for error in state.errors],
        "information": [],
        "safetyState": {
            "eStop": "REMOTE" if state.emergency_stop else "NONE",
            "fieldViolation": state.field_violation,
        },
    }


def _node_state_json(node: NodeState) -> dict[str, Any]:
    position = node.position and position_json(node.position)
    fields = {"nodeId": node.id, "sequenceId": node.sequence, "released": node.released}
    return {**fields, **without_nothing(nodePosition=position)}


def _action_state_json(action: ActionState) -> dict[str, Any]:
    status = action.status
    if status in (ActionStatus.PAUSED, ActionStatus.RETRIABLE):
        status = ActionStatus.RUNNING
    return {
        "actionId": action.id,
        "actionType": action.type,
        "actionStatus": status.value,
        **without_nothing(resultDescription=action.result),
    }


def _error_json(error: Error) -> dict[str, Any]:
    return {
        "errorType": error.type,
        "errorLevel": error.level.value,
        **without_nothing(errorDescription=error.description, errorHint=error.hint),
        "errorReferences": [
            {"referenceKey": key, "referenceValue": value} for key, value in error.references
        ],
    }


def _motion_json(position: AgvPosition | None, velocity: Velocity | None) -> dict[str, Any]:
    motion: dict[str, Any] = {}
    if position:
        motion["agvPosition"] = {
            "x": position.x,
            "y": position.y,
            "theta": position.theta,
            "mapId": position.map_id,
            "positionInitialized": position.initialized,
        }
    if velocity:
        motion["velocity"] = {"vx": velocity.vx, "vy": velocity.vy, "omega": velocity.omega}
    return motion


def connection_json(connection: Connection) -> dict[str, Any]:
    """Returns the object of a connection."""
    return {**header_json(connection.header), "connectionState": connection.state.value}


def visualization_json(message: Visualization) -> dict[str, Any]:
    """Returns the object of a visualization."""
    return {**header_json(message.header), **_motion_json(message.position, message.velocity)}


def read_state(fields: Fields, header: Header) -> VehicleState:
    """Returns a state; what a vehicle leaves out has its default. Raises MessageError."""
    fields.skip("zoneSetId", "information", "maps")
    fields.skip("edgeRequests", "zoneActionStates")
    safety, battery = fields.object("safetyState") or Fields({}), fields.object("batteryState")
    state = VehicleState(
        fields.text("orderId", ""),
        fields.natural("orderUpdateId", 0),
        fields.text("lastNodeId", ""),
        fields.natural("lastNodeSequenceId", 0),
        tuple(_read_node_state(node) for node in fields.objects("nodeStates", ())),
        tuple(_read_edge_state(edge) for edge in fields.objects("edgeStates", ())),
        tuple(_read_action_state(item) for item in fields.objects("actionStates", ())),
        fields.flag("driving", False),
        fields.flag("paused", False),
        fields.flag("newBaseRequest", False),
        _read_agv_position(fields.object("agvPosition")),
        _read_velocity(fields.object("velocity")),
        tuple(_read_load(load) for load in fields.objects("loads", ())),
        _read_battery(battery),
        enum_of(fields, "operatingMode", OperatingMode, OperatingMode.AUTOMATIC),
        tuple(_read_error(error) for error in fields.objects("errors", ())),
        safety.text("eStop", "NONE").upper() != "NONE",
        safety.flag("fieldViolation", False),
        distance_since_last_node=fields.number("distanceSinceLastNode", None),
        zone_sets=tuple(map(read_zone_set_state, fields.objects("zoneSets", ()))),
        planned=read_planned(fields.object("plannedPath")),
        intermediate=read_intermediate(fields.object("intermediatePath")),
        zone_requests=tuple(map(read_zone_request, fields.objects("zoneRequests", ()))),
        header=header,
    )
    fields.close()
    return state


def _read_node_state(fields: Fields) -> NodeState:
    return NodeState(
        fields.text("nodeId"),
        fields.natural("sequenceId"),
        fields.flag("released", True),
        read_position(fields.object("nodePosition") or fields.object("position")),
    )


def _read_edge_state(fields: Fields) -> EdgeState:
    return EdgeState(
        fields.text("edgeId"), fields.natural("sequenceId"), fields.flag("released", True)
    )


def _read_action_state(fields: Fields) -> ActionState:
    return ActionState(
        fields.text("actionId"),
        fields.text("actionType", ""),
        enum_of(fields, "actionStatus", ActionStatus, ActionStatus.WAITING),
        fields.text("resultDescription", ""),
        fields.flag("instant", False),  # 3.0 keeps them apart; its codec marks them
    )


def _read_agv_position(fields: Fields | None) -> AgvPosition | None:
    if fields is None:
        return None
    return AgvPosition(
        fields.number("x"),
        fields.number("y"),
        fields.number("theta", 0.0),
        fields.text("mapId", ""),
        fields.flag("positionInitialized", True),
    )


def _read_velocity(fields: Fields | None) -> Velocity | None:
    if fields is None:
        return None
    return Velocity(fields.number("vx", 0.0), fields.number("vy", 0.0), fields.number("omega", 0.0))


def _read_load(fields: Fields) -> Load:
    return Load(fields.text("loadId", ""), fields.text("loadType", ""))


def _read_battery(fields: Fields | None) -> Battery:
    if fields is None:
        return Battery()
    return Battery(fields.number("batteryCharge", 100.0), fields.flag("charging", False))


def _read_error(fields: Fields) -> Error:
    return Error(
        fields.text("errorType"),
        enum_of(fields, "errorLevel", ErrorLevel, ErrorLevel.WARNING),
        fields.text("errorDescription", ""),
        fields.text("errorHint", ""),
        tuple(
            (item.text("referenceKey", ""), str(item.any("referenceValue", "")))
            for item in fields.objects("errorReferences", ())
        ),
    )


def read_connection(fields: Fields, header: Header) -> Connection:
    """Returns a connection. Raises MessageError."""
    state = enum_of(fields, "connectionState", ConnectionState, ConnectionState.OFFLINE)
    fields.close()
    return Connection(state, header)


def read_visualization(fields: Fields, header: Header) -> Visualization:
    """Returns a visualization. Raises MessageError."""
    position = _read_agv_position(fields.object("agvPosition"))
    velocity = _read_velocity(fields.object("velocity"))
    return Visualization(position, velocity, header, fields.natural("referenceStateHeaderId", 0))
