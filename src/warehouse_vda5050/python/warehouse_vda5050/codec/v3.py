# SPDX-License-Identifier: Apache-2.0
"""VDA 5050 3.0.0: other names than 2.1.0, and more specific error types.

Names are those of the schemas published with the specification. Corridors are refused
(field_rules).
"""

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from warehouse_vda5050.codec.paths import paths_json
from warehouse_vda5050.codec.v2 import CodecV2
from warehouse_vda5050.codec.zones import (
    read_responses,
    read_zone_set,
    responses_json,
    zone_set_json,
    zones_of_state_json,
)
from warehouse_vda5050.errors import LEVELS, Error, former_type, precise_type
from warehouse_vda5050.model import (
    ActionState,
    Factsheet,
    Header,
    Message,
    Responses,
    VehicleState,
    Visualization,
    ZoneSet,
)
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation.fields import Fields

# Of 2.1.0 and of 3.0.0, in whatever object of a message of that kind.
DESCRIPTIONS = {
    "nodeDescription": "nodeDescriptor",
    "edgeDescription": "edgeDescriptor",
    "actionDescription": "actionDescriptor",
}
NAMES: dict[Kind, dict[str, str]] = {
    Kind.ORDER: {
        **DESCRIPTIONS,
        "maxSpeed": "maximumSpeed",
        "maxHeight": "maximumMobileRobotHeight",
        "minHeight": "minimumLoadHandlingDeviceHeight",
        "maxRotationSpeed": "maximumRotationSpeed",
    },
    Kind.INSTANT_ACTIONS: DESCRIPTIONS,
    Kind.STATE: {
        **DESCRIPTIONS,
        "agvPosition": "mobileRobotPosition",
        "positionInitialized": "localized",
        "batteryState": "powerSupply",
        "batteryCharge": "stateOfCharge",
        "reach": "range",
        "resultDescription": "actionResult",
        "eStop": "activeEmergencyStop",
    },
    Kind.VISUALIZATION: {
        "agvPosition": "mobileRobotPosition",
        "positionInitialized": "localized",
    },
    Kind.CONNECTION: {},
    Kind.ZONE_SET: {},
    Kind.RESPONSES: {},
    Kind.FACTSHEET: {
        "agvKinematic": "mobileRobotKinematics",
        "agvClass": "mobileRobotClass",
        "maxLoadMass": "maximumLoadMass",
        "speedMin": "minimumSpeed",
        "speedMax": "maximumSpeed",
        "accelerationMax": "maximumAcceleration",
        "decelerationMax": "maximumDeceleration",
        "heightMin": "minimumHeight",
        "heightMax": "maximumHeight",
        "maxStringLens": "maximumStringLengths",
        "msgLen": "maximumMessageLength",
        "idLen": "maximumIdLength",
        "loadIdLen": "maximumLoadIdLength",
        "maxArrayLens": "maximumArrayLengths",
        "minOrderInterval": "minimumOrderInterval",
        "minStateInterval": "minimumStateInterval",
        "agvActions": "mobileRobotActions",
        "agvGeometry": "mobileRobotGeometry",
        "set": "envelope2dId",
        "polygonPoints": "vertices",
        "maxWeight": "maximumWeight",
        "vehicleConfig": "mobileRobotConfiguration",
    },
}
# Values of enumerations, by the name of their field in 2.1.0.
VALUES: dict[str, dict[str, str]] = {
    "actionType": {"initPosition": "initializePosition"},
    "connectionState": {"CONNECTIONBROKEN": "CONNECTION_BROKEN"},
    "operatingMode": {"TEACHIN": "TEACH_IN"},
    "agvKinematic": {"DIFF": "DIFFERENTIAL", "OMNI": "OMNIDIRECTIONAL"},
}
# What 3.0.0 knows and 2.1.0 has no word for, as the nearest that it has.
NEAREST: dict[str, dict[str, str]] = {
    "connectionState": {"HIBERNATING": "ONLINE"},
    "operatingMode": {"STARTUP": "SERVICE", "INTERVENED": "MANUAL"},
    "errorLevel": {"URGENT": "WARNING", "CRITICAL": "FATAL"},
    "actionStatus": {"RETRIABLE": "FAILED"},
}
# Errors name fields of orders.
FIELD = re.compile(rf"\b({'|'.join(NAMES[Kind.ORDER])})\b")
KINDS = {
    "VehicleState": Kind.STATE,
    "VehicleOrder": Kind.ORDER,
    "InstantActions": Kind.INSTANT_ACTIONS,
}
KINDS |= {"Connection": Kind.CONNECTION, "Visualization": Kind.VISUALIZATION}
KINDS |= {"Factsheet": Kind.FACTSHEET, "ZoneSet": Kind.ZONE_SET, "Responses": Kind.RESPONSES}
WRITERS: dict[type, Callable[[Any], dict[str, Any]]] = {
    ZoneSet: zone_set_json,
    Responses: responses_json,
}
READERS: dict[Kind, Callable[[Fields, Header], Any]] = {
    Kind.ZONE_SET: read_zone_set,
    Kind.RESPONSES: read_responses,
}


class CodecV3(CodecV2):
    """3.0.0."""

    def newer(self, kind: Kind, value: dict[str, Any]) -> dict[str, Any]:
        """Returns a message with the names of 3.0.0."""
        value = _renamed(value, NAMES[kind], VALUES)
        for node in _objects(value, "nodes"):
            _give_axes(node.get("nodePosition"))
        for edge in _objects(value, "edges"):
            edge.pop("startNodeId", None), edge.pop("endNodeId", None)
        return value

    def to_json(self, message: Message) -> dict[str, Any]:
        """Returns the object that stands for a message."""
        if write := WRITERS.get(type(message)):
            return write(message)
        kind = KINDS[type(message).__name__]
        value = self.newer(kind, super().to_json(message))
        if isinstance(message, VehicleState):
            _part_actions(value, message.actions)
            value |= {**zones_of_state_json(message), **paths_json(message)}
            for row, error in zip(value["errors"], message.errors):
                _write_error(row, error)
        if isinstance(message, Visualization):
            value["referenceStateHeaderId"] = message.state_id
        if isinstance(message, Factsheet):
            _add_zones(value, message)
            for loads in value["loadSpecification"]["loadSets"]:
                if "agvSpeedLimit" in loads:
                    loads["maximumSpeed"] = loads.pop("agvSpeedLimit")
            action_rows = value["protocolFeatures"]["mobileRobotActions"]
            for row, action in zip(action_rows, message.actions):
                row["blockingTypes"] = [blocking.value for blocking in action.blocking]
                row["pauseAllowed"], row["cancelAllowed"] = action.can_pause, action.can_cancel
        return value

    def of_json(self, kind: Kind, value: dict[str, Any]) -> dict[str, Any]:
        """Converts an object of 3.0.0 to 2.1.0."""
        names = {new: old for old, new in NAMES[kind].items()}
        values = {key: {new: old for old, new in pairs.items()} for key, pairs in VALUES.items()}
        for key, pairs in NEAREST.items():
            values[key] = {**values.get(key, {}), **pairs}
        value = _renamed(value, names, values)
        instant = value.pop("instantActionStates", None)
        if kind is Kind.STATE and isinstance(instant, list):
            marked = [{**item, "instant": True} for item in instant if isinstance(item, dict)]
            reported = value.get("actionStates")
            value["actionStates"] = [*(reported if isinstance(reported, list) else ()), *marked]
        return value

    def read(self, kind: Kind, fields: Fields) -> Any:
        """Returns the message that an object stands for. Raises MessageError."""
        if read := READERS.get(kind):
            return read(fields, self.read_header(fields))
        message = super().read(kind, fields)
        if isinstance(message, VehicleState):
            return replace(message, errors=tuple(_former(error) for error in message.errors))
        return message


def _add_zones(value: dict[str, Any], sheet: Factsheet) -> None:
    """Adds to a factsheet which zones the vehicle keeps to."""
    if sheet.zone_types:
        value["typeSpecification"]["supportedZones"] = [*sheet.zone_types]
        lengths = value["protocolLimits"]["maximumArrayLengths"]
        lengths["zoneSet.zones"] = sheet.max_zones


def _renamed(value: Any, names: dict[str, str], values: dict[str, dict[str, str]]) -> Any:
    """Returns JSON with other names of fields, and other words in those named in `values`."""
    if isinstance(value, list):
        return [_renamed(item, names, values) for item in value]
    if not isinstance(value, dict):
        return value
    return {names.get(key, key): _word(key, item, names, values) for key, item in value.items()}


def _word(key: str, item: Any, names: dict[str, str], values: dict[str, dict[str, str]]) -> Any:
    words = values.get(key) or values.get(names.get(key, ""))
    if words and isinstance(item, str):
        return words.get(item, item)
    return item if key == "actionParameters" else _renamed(item, names, values)


def _objects(value: dict[str, Any], key: str) -> list[dict[str, Any]]:
    items = value.get(key)
    return [item for item in items if isinstance(item, dict)] if isinstance(items, list) else []


def _give_axes(position: Any) -> None:
    """Makes a radius the ellipse that 3.0 has for it."""
    radius = position.get("allowedDeviationXY") if isinstance(position, dict) else None
    if isinstance(radius, (int, float)):
        position["allowedDeviationXY"] = {"a": radius, "b": radius, "theta": 0.0}


def _write_error(fields: dict[str, Any], error: Error) -> None:
    """Gives an error the type and level that 3.0 has for it, and fields their names there."""
    names = NAMES[Kind.ORDER]
    fields["errorType"] = precise_type(error)
    fields["errorLevel"] = LEVELS.get(fields["errorType"], fields["errorLevel"])
    if "errorDescription" in fields:
        fields["errorDescription"] = FIELD.sub(lambda m: names[m[1]], fields["errorDescription"])
    for reference in fields["errorReferences"]:
        if reference["referenceKey"] == "field":
            name = reference["referenceValue"]
            reference["referenceValue"] = names.get(name, name)


def _former(error: Error) -> Error:
    type, precise = former_type(error.type)
    return replace(error, type=type, precise=precise)


def _part_actions(value: dict[str, Any], actions: tuple[ActionState, ...]) -> None:
    """Separates the states of instant actions from the order's, and marks paused ones."""
    reported = value.pop("actionStates")
    for item, action in zip(reported, actions):
        item["actionStatus"] = action.status.value
    value["actionStates"] = [a for a, b in zip(reported, actions) if not b.instant]
    value["instantActionStates"] = [a for a, b in zip(reported, actions) if b.instant]
