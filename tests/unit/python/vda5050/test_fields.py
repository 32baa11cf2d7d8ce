# SPDX-License-Identifier: Apache-2.0
"""No field of an order is ignored in silence: each is driven, checked or refused."""

import json
import math

import pytest
from grid_robot import Bench, drop, order, pick, row
from official_schemas import VALIDATORS

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.field_rules import EDGE, NOT_TOLD, POSITION, TABLE, Use
from warehouse_vda5050.model import Action, BlockingType
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.demands import EDGE_CHECKS


def sent(bench, version="2.1.0", edge=None, place=None, actions=None, cells=None, **fields):
    """Returns the state after an order with further fields in its last edge or nodePosition."""
    codec = codec_for(version)
    value = codec.to_json(order("o", cells or row(0, 2), actions=actions))
    if edge:
        value["edges"][-1].update(edge)
    value["nodes"][-1]["nodePosition"].update(place or {})
    message, unknown = codec.decode(Kind.ORDER, json.dumps({**value, **fields}).encode())
    bench.vehicle.on_order(message, bench.now, unknown)
    return bench.tick()


# --- 6.1.1: the vehicle is expected to act accordingly and cannot ignore the field


@pytest.mark.parametrize(
    "field,value",
    [
        ("maxSpeed", 0.2),
        ("maxSpeed", 0),
        ("maxHeight", 0.39),
        ("minHeight", 0.1),
        ("orientation", math.pi),
        ("direction", "left"),
        ("length", 3.0),
        ("trajectory", {"degree": 1, "knotVector": [], "controlPoints": []}),
        ("corridor", {"leftWidth": 1.0, "rightWidth": 1.0}),
    ],
)
def test_the_vehicle_cannot_ignore_the_field_of_an_edge(field, value):
    """6.6.4.2: orderError with the wrong fields as error references, and the order not taken."""
    state = sent(Bench(), edge={field: value})
    (error,) = state.errors
    assert error.type == "orderError" and ("field", field) in error.references
    assert field in error.description and not state.order_id
    assert ("edgeId", "e3") in error.references


@pytest.mark.parametrize(
    "fields",
    [
        {"maxSpeed": 1.5},
        {"maxSpeed": 2},
        {"maxHeight": 0.4},
        {"minHeight": 0},
        {"orientation": 0, "orientationType": "TANGENTIAL"},
        {"orientation": 0.0, "orientationType": "GLOBAL"},
        {"rotationAllowed": False},
        {"rotationAllowed": True, "maxRotationSpeed": 0.1},
        {"reachOrientationBeforeEntering": True},
        {"direction": ""},
        {"length": 1.0},
        {"edgeDescription": "of the aisle"},
    ],
)
def test_the_vehicle_acts_accordingly(fields):
    state = sent(Bench(), edge=fields)
    assert state.order_id == "o" and not state.errors


def test_the_maximum_height_of_the_vehicle_including_the_load():
    """7.1, maxHeight. What is lifted on the way counts from there on."""
    bench = Bench(units={"7": (1, 0)})
    state = sent(bench, edge={"maxHeight": 1.0}, actions={1: [pick()]})
    assert "1.9 m high" in state.errors[0].description
    assert sent(bench, edge={"maxHeight": 2.0}, actions={1: [pick()]}).order_id == "o"
    carried = sent(Bench(), edge={"maxHeight": 1.0}, actions={0: [pick()], 1: [drop()]})
    assert carried.order_id == "o"


@pytest.mark.parametrize(
    "place,is_taken",
    [
        ({"theta": 0.0}, True),
        ({"theta": math.pi / 2}, False),
        ({"theta": math.pi / 2, "allowedDeviationTheta": 0.1}, False),
        ({"theta": math.pi / 2, "allowedDeviationTheta": math.pi / 2 + 0.01}, True),
        ({"theta": -math.pi, "allowedDeviationTheta": math.pi}, True),
        ({"theta": 0.05}, False),
        ({"theta": 0.05, "allowedDeviationTheta": 0.1}, True),
        ({"theta": 0.0, "allowedDeviationTheta": 4.0}, False),
        ({"allowedDeviationTheta": 0.1}, True),
        ({"allowedDeviationXY": 0.0}, True),
        ({"allowedDeviationXY": 0.5}, True),
        ({"allowedDeviationXY": 0.001}, False),
        ({"allowedDeviationXY": "near"}, False),
        ({"mapId": "second floor"}, False),
        ({"mapDescription": "of a floor"}, True),
    ],
)
def test_the_vehicle_has_to_assume_the_theta_angle_on_this_node(place, is_taken):
    """7.1, nodePosition. The robot comes in the direction of the edge."""
    state = sent(Bench(), place=place)
    assert (state.order_id == "o", not state.errors) == (is_taken, is_taken)


@pytest.mark.parametrize("allowed,is_taken", [(0.05, False), (0.3, True), (0.0, True)])
def test_the_vehicle_is_in_the_deviation_range_of_the_first_node(allowed, is_taken):
    """6.6.1: otherwise it does not begin there."""
    bench = Bench()
    bench.robot.extra = {"x": 0.2}
    bench.tick()
    state = sent(bench, cells=[(0, 0)], place={"allowedDeviationXY": allowed})
    assert (state.order_id == "o") is is_taken
    assert [error.type for error in state.errors] == ["noRouteError"] * (not is_taken)


def test_the_heading_is_that_of_the_last_edge():
    cells = [(0, 0), (1, 0), (1, 1)]
    assert sent(Bench(), place={"theta": math.pi / 2}, cells=cells).order_id == "o"
    assert not sent(Bench(), place={"theta": 0.0}, cells=cells).order_id


def test_a_zone_set_cannot_be_ignored():
    state = sent(Bench(), zoneSetId="zones-1")
    assert "zoneSetId" in state.errors[0].description and not state.order_id
    assert sent(Bench(), zoneSetId="").order_id == "o"


@pytest.mark.parametrize("field,value", [("maxSpeed", "fast"), ("rotationAllowed", 1)])
def test_a_demand_of_another_type_is_malformed(field, value):
    with pytest.raises(MessageError, match=rf"edges\[1\].{field}") as caught:
        sent(Bench(), edge={field: value})
    assert caught.value.error.type == "validationError"


# --- 6.6.4.2: non-executable actions: lifting height higher than the maximum lifting height


@pytest.mark.parametrize(
    "key,value",
    [
        ("height", 9.9),
        ("height", "high"),
        ("depth", 1),
        ("lhd", "LHD1"),
        ("side", "left"),
        ("loadType", "EPAL"),
        ("surprise", 1),
    ],
)
@pytest.mark.parametrize("type", ["pick", "drop"])
def test_actions_it_cannot_perform(type, key, value):
    """The vehicle reports orderError with the wrong fields as error references."""
    action = Action(type, "a", BlockingType.HARD, ((key, value),))
    state = sent(Bench(), actions={2: [action]})
    (error,) = state.errors
    assert error.type == "orderError" and not state.order_id
    assert {("field", key), ("actionId", "a")} <= set(error.references)
    assert key in error.description


def test_parameters_that_the_lift_meets_anyway():
    parameters = {"height": "0", "depth": 0, "lhd": "lift", "side": "", "loadType": "unit"}
    parameters |= {"stationType": "rack", "stationName": "S1", "loadId": "7"}
    action = Action("pick", "a", BlockingType.HARD, tuple(parameters.items()))
    assert sent(Bench(units={"7": (2, 0)}), actions={2: [action]}).order_id == "o"


def test_parameters_of_instant_actions_that_are_unknown_are_warned_of():
    state = Bench().instant("startPause", surprise=1)
    assert state.actions[0].status.value in ("RUNNING", "FINISHED")
    assert "startPause.surprise" in state.errors[0].description


# --- the table


def fields_of(part, place=""):
    """Yields (place, field) of a schema, the places named as in TABLE."""
    for name, child in part.get("properties", {}).items():
        yield place, name
        yield from fields_of(child, f"{place}.{name}")
        yield from fields_of(child.get("items", {}), f"{place}.{name}")


@pytest.mark.parametrize("kind", [Kind.ORDER, Kind.INSTANT_ACTIONS])
def test_each_field_of_the_official_schemas_has_a_rule(kind):
    schema = VALIDATORS[kind].schema
    refused = tuple(f"order.edges.{rule.name}" for rule in EDGE if rule.use is Use.REFUSED)
    missing = [
        (place, name)
        for place, name in fields_of(resolved(schema, schema), kind.value)
        if not place.startswith(refused) and not place.endswith("actionParameters")
    ]
    assert [path for path in missing if path[1] not in {rule.name for rule in TABLE[path[0]]}] == []
    assert len(missing) > (40 if kind is Kind.ORDER else 10)


def resolved(part, schema):
    """Returns a schema with its references replaced."""
    if isinstance(part, list):
        return [resolved(piece, schema) for piece in part]
    if not isinstance(part, dict):
        return part
    if "$ref" in part:
        target = schema
        for step in part["$ref"].removeprefix("#/").split("/"):
            target = target[step]
        return resolved(target, schema)
    return {key: resolved(value, schema) for key, value in part.items() if key != "definitions"}


def test_each_demand_that_is_checked_or_refused_has_a_check():
    checked = {rule.name for rule in EDGE if rule.kind and rule.use in (Use.CHECKED, Use.REFUSED)}
    assert checked | {"maxSpeed"} == EDGE_CHECKS.keys()  # driven, within limits
    assert {rule.name for rule in POSITION if rule.kind} == {
        "allowedDeviationXY",
        "allowedDeviationTheta",
    }


def test_each_field_of_a_state_is_told_or_named_as_left_out():
    bench = Bench(units={"7": (1, 0)})
    sent(bench, place={"theta": 0.0}, actions={1: [pick(), pick(id="p2")]})
    names = set()
    for state in [*bench.states, bench.tick(6), bench.instant("dance")]:
        names |= set(paths(codec_for().to_json(state)))
    schema = VALIDATORS[Kind.STATE].schema
    known = {f"{place}.{name}".strip(".") for place, name in fields_of(resolved(schema, schema))}
    silent = {path for path in known - names if not path.startswith(NOT_TOLD)}
    assert silent == set() and names <= known


def paths(value, place=""):
    items = value if isinstance(value, list) else [value]
    for item in items:
        for name, child in item.items() if isinstance(item, dict) else ():
            yield f"{place}.{name}".strip(".")
            yield from paths(child, f"{place}.{name}")


# --- strict


@pytest.mark.parametrize(
    "change",
    [
        {"headerId": None},
        {"timestamp": None},
        {"version": None},
        {"manufacturer": None},
        {"serialNumber": None},
    ],
)
def test_a_strict_vehicle_refuses_an_order_without_header(change):
    """6.3: each JSON message starts with a header."""
    value = {"headerId": 0, "timestamp": "2026-01-01T00:00:00.000Z", "version": "2.1.0"}
    value |= {"manufacturer": "kiva", "serialNumber": "7"}
    value = codec_for().to_json(order("o", row(0, 1))) | value
    whole, strict = json.dumps(value).encode(), codec_for(strict=True)
    assert strict.decode(Kind.ORDER, whole).message.id == "o"
    lacking = json.dumps({**value, **change}).encode()
    assert codec_for().decode(Kind.ORDER, lacking).message.id == "o"
    with pytest.raises(MessageError, match=f"{[*change][0]} is missing") as caught:
        strict.decode(Kind.ORDER, lacking)
    assert caught.value.error.type == "validationError"


def test_a_strict_vehicle_takes_no_other_names():
    header = {"headerId": 0, "timestamp": "x", "version": "2.1.0"}
    header |= {"manufacturer": "kiva", "serialNumber": "7"}
    pause = {"actionType": "startPause", "actionId": "a", "blockingType": "NONE"}
    strict = codec_for(strict=True)

    def read(name, action):
        return strict.decode(
            Kind.INSTANT_ACTIONS, json.dumps({**header, name: [action]}).encode()
        ).message

    assert read("actions", pause).actions
    for name, action in (
        ("instantActions", pause),
        ("actions", {**pause, "blockingType": "none"}),
        ("actions", {key: pause[key] for key in ("actionType", "actionId")}),
    ):
        with pytest.raises(MessageError):
            read(name, action)
