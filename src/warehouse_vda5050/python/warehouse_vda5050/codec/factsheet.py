# SPDX-License-Identifier: Apache-2.0
"""Factsheets in the JSON of 2.1.0."""

from typing import Any

from warehouse_vda5050.codec.base import header_json, without_nothing
from warehouse_vda5050.model import (
    BlockingType,
    Factsheet,
    Header,
    Lengths,
    LoadSet,
    SupportedAction,
)
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.fields import Fields

# Of physicalParameters, with which masters here reckon.
BODY = ("length", "width", "heightMax", "speedMax", "accelerationMax", "decelerationMax")


def factsheet_json(sheet: Factsheet) -> dict[str, Any]:
    """Returns the object of a factsheet."""
    return {
        **header_json(sheet.header),
        "typeSpecification": {
            "seriesName": sheet.series,
            "seriesDescription": sheet.description,
            "agvKinematic": sheet.kinematics,
            "agvClass": sheet.vehicle_class,
            "maxLoadMass": sheet.max_load_mass,
            "localizationTypes": list(sheet.localization),
            "navigationTypes": list(sheet.navigation),
        },
        "physicalParameters": {
            "speedMin": 0.0,
            "speedMax": sheet.max_speed,
            "accelerationMax": sheet.max_acceleration,
            "decelerationMax": sheet.max_deceleration,
            "heightMin": sheet.height,
            "heightMax": sheet.height,
            "width": sheet.width,
            "length": sheet.length,
        },
        "protocolLimits": _limits_json(sheet),
        "protocolFeatures": {
            "optionalParameters": [
                {"parameter": name, "support": support, "description": text}
                for name, support, text in sheet.parameters
            ],
            "agvActions": [_action_json(action) for action in sheet.actions],
        },
        "agvGeometry": {"envelopes2d": [_outline_json(sheet)]},
        "loadSpecification": _loads_json(sheet),
        "vehicleConfig": {
            "versions": [{"key": key, "value": value} for key, value in sheet.versions]
        },
    }


def _limits_json(sheet: Factsheet) -> dict[str, Any]:
    return {
        "maxStringLens": {"msgLen": sheet.max_message},
        "maxArrayLens": {
            "order.nodes": sheet.max_nodes,
            "order.edges": sheet.max_nodes,
            "node.actions": sheet.max_actions,
            "edge.actions": 0,
            "instantActions": sheet.max_actions,
            "trajectory.knotVector": 0,
            "trajectory.controlPoints": 0,
            "state.nodeStates": sheet.max_nodes,
            "state.edgeStates": sheet.max_nodes,
            "state.loads": 1,
            "state.errors": sheet.max_errors,
        },
        "timing": {
            "minOrderInterval": sheet.order_interval,
            "minStateInterval": 0.0,
            "defaultStateInterval": sheet.state_interval,
        },
    }


def _action_json(action: SupportedAction) -> dict[str, Any]:
    return {
        "actionType": action.type,
        "actionDescription": _described(action),
        "actionScopes": list(action.scopes),
        "actionParameters": [
            {"key": key, "valueDataType": kind, "isOptional": optional, "description": text}
            for key, kind, optional, text in action.parameters
        ],
        # No blockingTypes: there is no value that fits the published schema of 2.1.0.
    }


def _described(action: SupportedAction) -> str:
    types = ", ".join(kind.value for kind in action.blocking if kind is not BlockingType.SINGLE)
    return f"{action.description}; blocking types: {types}"


def _outline_json(sheet: Factsheet) -> dict[str, Any]:
    x, y = sheet.length / 2, sheet.width / 2
    corners = [(x, y), (-x, y), (-x, -y), (x, -y)]
    return {"set": "chassis", "polygonPoints": [{"x": x, "y": y} for x, y in corners]}


def _loads_json(sheet: Factsheet) -> dict[str, Any]:
    length, width = sheet.load_size
    unit = LoadSet("unit", sheet.load_type, length, width, max_mass=sheet.max_load_mass)
    sets = [_load_set_json(loads, sheet) for loads in sheet.load_sets or (unit,)]
    return {"loadPositions": ["lift"], "loadSets": sets}


def _load_set_json(loads: LoadSet, sheet: Factsheet) -> dict[str, Any]:
    size = without_nothing(length=loads.length, width=loads.width, height=loads.height)
    fields = without_nothing(
        setName=loads.name,
        loadType=loads.load_type,
        loadDimensions=size if {"length", "width"} <= size.keys() else None,
        maxWeight=loads.max_mass,
        agvSpeedLimit=loads.max_speed,
    )
    return {**fields, "pickTime": sheet.lift_time, "dropTime": sheet.lift_time}


def read_factsheet(fields: Fields, header: Header) -> Factsheet:
    """Returns a factsheet, as far as masters here make use of it. Raises MessageError."""
    kind = fields.object("typeSpecification") or Fields({})
    body = fields.object("physicalParameters") or Fields({})
    features = fields.object("protocolFeatures") or Fields({})
    limits = fields.object("protocolLimits") or Fields({})
    loads = fields.object("loadSpecification") or Fields({})
    lengths = limits.object("maxArrayLens") or Fields({})
    timing = limits.object("timing") or Fields({})
    default = Factsheet()
    return Factsheet(
        kind.text("seriesName", ""),
        kind.text("seriesDescription", ""),
        kind.text("agvKinematic", ""),
        kind.text("agvClass", ""),
        kind.number("maxLoadMass", 0.0),
        body.number("length", default.length),
        body.number("width", default.width),
        body.number("heightMax", default.height),
        body.number("speedMax", default.max_speed),
        body.number("accelerationMax", default.max_acceleration),
        body.number("decelerationMax", default.max_deceleration),
        actions=tuple(_read_action(action) for action in features.objects("agvActions", ())),
        parameters=tuple(_read_support(row) for row in features.objects("optionalParameters", ())),
        max_nodes=_read_limit(lengths, default.max_nodes),
        zone_types=_read_words(kind, "supportedZones"),
        max_zones=lengths.natural("zoneSet.zones", 0),
        order_interval=max(0.0, timing.number("minOrderInterval", 0.0)),
        load_sets=tuple(_read_load_set(row) for row in loads.objects("loadSets", ())),
        silent=tuple(name for name in BODY if not body.has(name)),
        header=header,
        lengths=_read_lengths(limits.object("maxStringLens") or Fields({}), lengths),
    )


def _read_lengths(strings: Fields, arrays: Fields) -> Lengths:
    return Lengths(
        message=strings.natural("msgLen", 0),
        id=strings.natural("idLen", 0),
        is_numeric=strings.flag("idNumericalOnly", False),
        word=strings.natural("enumLen", 0),
        load_id=strings.natural("loadIdLen", 0),
        node_actions=arrays.natural("node.actions", 0),
        parameters=arrays.natural("actions.actionsParameters", 0),
        instant_actions=arrays.natural("instantActions", 0),
    )


def _read_load_set(fields: Fields) -> LoadSet:
    size = fields.object("loadDimensions") or Fields({})
    speed = "agvSpeedLimit" if fields.has("agvSpeedLimit") else "speedMax"  # 3.0's, renamed
    return LoadSet(
        fields.text("setName", ""),
        fields.text("loadType", ""),
        size.number("length", None),
        size.number("width", None),
        size.number("height", None),
        fields.number("maxWeight", None),
        fields.number(speed, None),
    )


def _read_support(fields: Fields) -> tuple[str, str, str]:
    text = fields.text("description", "")
    return fields.text("parameter"), fields.text("support", "SUPPORTED"), text


def _read_limit(lengths: Fields, default: int) -> int:
    """Returns how many nodes an order may have; 0 or none stands for no limit."""
    nodes = lengths.natural("order.nodes", 0) or default
    edges = lengths.natural("order.edges", 0) or default
    return min(nodes, edges + 1)


def _read_words(fields: Fields, key: str) -> tuple[str, ...]:
    words = fields.any(key, [])
    return tuple(str(word) for word in words) if isinstance(words, list) else ()


def _read_action(fields: Fields) -> SupportedAction:
    names = _read_words(fields, "actionScopes")
    type, text = fields.text("actionType"), fields.text("actionDescription", "")
    rows = fields.objects("actionParameters", ())
    words = _read_words(fields, "blockingTypes")
    blocking = tuple(word for word in BlockingType if word.value in words)
    if words and not blocking:
        allowed = ", ".join(word.value for word in BlockingType)
        where, said = fields.path_of("blockingTypes"), ", ".join(words)[:60]
        raise MessageError(f"{where} is {said}; some of {allowed} were expected")
    return SupportedAction(type, names, text, tuple(_read_parameter(r) for r in rows), blocking)


def _read_parameter(fields: Fields) -> tuple[str, str, bool, str]:
    """Returns a parameter; one that is not said to be required is optional."""
    return (
        fields.text("key"),
        fields.text("valueDataType", ""),
        fields.flag("isOptional", True),
        fields.text("description", ""),
    )
