# SPDX-License-Identifier: Apache-2.0
"""Codecs, topics, headers: what goes over the wire, and what may come from there."""

import json

import pytest
from grid_robot import Bench, drop, order, pick, row

from warehouse_vda5050.codec import VERSIONS, VersionError, codec_for
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.model import (
    Action,
    BlockingType,
    Connection,
    ConnectionState,
    Header,
    InstantActions,
)
from warehouse_vda5050.topics import Identity, Kind, TopicError, Topics, prefix_of
from warehouse_vda5050.validation import MessageError

HEADER = Header(3, "2026-01-01T00:00:00.000Z", "2.1.0", "kiva", "7")
CODEC = codec_for("2.1.0")


def encoded(**fields):
    """Returns the JSON of a small order with other fields."""
    value = CODEC.to_json(order("o", row(0, 2), released=2))
    return json.dumps({**value, **fields}).encode()


@pytest.mark.parametrize("version", VERSIONS)
def test_orders_come_back_as_they_were(version):
    codec = codec_for(version)
    sent = order("o", row(0, 3), released=2, actions={0: [pick()], 3: [drop()]})
    got, unknown = codec.decode(Kind.ORDER, codec.encode(sent))
    assert got.nodes == sent.nodes and not unknown and got.id == "o"
    assert [edge.sequence for edge in got.edges] == [1, 3, 5]


@pytest.mark.parametrize("version", VERSIONS)
def test_states_come_back_as_they_were(version):
    codec = codec_for(version)
    bench = Bench(units={"7": (1, 0)})
    bench.order("o", row(0, 3), released=2, actions={1: [pick()]})
    bench.instant("dance")
    sent = bench.tick(5)
    got = codec.decode(Kind.STATE, codec.encode(sent)).message
    assert (got.nodes, got.edges, got.errors) == (sent.nodes, sent.edges, sent.errors)
    assert (got.position, got.battery, got.mode) == (sent.position, sent.battery, sent.mode)
    assert {(a.id, a.status) for a in got.actions} == {(a.id, a.status) for a in sent.actions}


def test_names_of_3_0():
    codec = codec_for("3.0.0")
    value = codec.to_json(Bench().instant("dance"))
    assert {"mobileRobotPosition", "powerSupply", "instantActionStates"} <= set(value)
    assert value["mobileRobotPosition"]["localized"] is True
    assert value["safetyState"]["activeEmergencyStop"] == "NONE"
    assert value["actionStates"] == [] and value["instantActionStates"][0]["actionId"] == "i1"
    broken = codec.to_json(Connection(ConnectionState.CONNECTIONBROKEN, HEADER))
    assert broken["connectionState"] == "CONNECTION_BROKEN"
    assert "startNodeId" not in codec.to_json(order("o", row(0, 1)))["edges"][0]
    again = codec.decode(Kind.CONNECTION, json.dumps({**broken, "version": "3.0.0"}).encode())
    assert again.message.state is ConnectionState.CONNECTIONBROKEN


def test_unknown_version():
    with pytest.raises(VersionError, match="one of 2.0.0, 2.1.0, 3.0.0"):
        codec_for("1.1.0")


def test_instant_actions_under_either_name():
    action = {"actionType": "startPause", "actionId": "a"}
    for name in ("actions", "instantActions"):
        got = CODEC.decode(Kind.INSTANT_ACTIONS, json.dumps({name: [action]}).encode())
        assert got.message.actions == (Action("startPause", "a", BlockingType.NONE),)
    assert "actions" in CODEC.to_json(InstantActions((Action("x", "y"),)))


def test_position_under_either_name_and_blocking_type_in_small_letters():
    node = {"nodeId": "n", "sequenceId": 0, "released": True, "position": {"x": 1, "y": 2.5}}
    node["actions"] = [{"actionType": "pick", "actionId": "a", "blockingType": "soft"}]
    got, unknown = CODEC.decode(Kind.ORDER, encoded(nodes=[node], edges=[]))
    assert got.nodes[0].position.y == 2.5 and not unknown
    assert got.nodes[0].actions[0].blocking is BlockingType.SOFT


def test_unknown_fields_are_named_and_ignored():
    got, unknown = CODEC.decode(Kind.ORDER, encoded(surprise=1))
    assert got.id == "o" and unknown == ("surprise",)


@pytest.mark.parametrize(
    "payload,text",
    [
        (b"", "not JSON"),
        (b"\xff\xfe", "not JSON"),
        (b"[]", "an object was expected"),
        (b"[" * 100_000, "deeper"),
        (b'{"a":' * 17 + b"1" + b"}" * 17, "deeper"),
        (b'{"a": NaN}', "NaN"),
        (b'{"a": -Infinity}', "Infinity"),
        (b'{"a": 1e999}', "double"),
        (b'{"a": "' + b"x" * 20_000 + b'"}', "more than 10000 characters"),
        (b" " * (1 << 21), "bytes"),
        (b'{"a":' + b"9" * 5000 + b"}", "not JSON"),
        (encoded(orderId=5), "orderId is 5; a string"),
        (encoded(orderUpdateId=-1), "whole number"),
        (encoded(orderUpdateId=1.5), "whole number"),
        (encoded(orderUpdateId=True), "a number was expected"),
        (encoded(nodes={}), "a list was expected"),
        (encoded(nodes=[5]), r"nodes\[0\] is 5; an object"),
        (encoded(nodes=[{"nodeId": "a"}]), r"nodes\[0\].sequenceId is missing"),
        (encoded(version="1.0.0"), "version is '1.0.0'; 2.1.0 was expected"),
        (encoded(headerId="x"), "headerId"),
    ],
)
def test_hostile_json_is_named(payload, text):
    with pytest.raises(MessageError, match=text) as caught:
        CODEC.decode(Kind.ORDER, payload)
    assert caught.value.error.type == "validationError"


def test_headers_count_up_and_never_go_back():
    times = iter([100.0, 50.0, 101.5])
    headers = Headers(Identity("kiva", "7"), "2.1.0", lambda: next(times))
    a, b, c = (headers.next(kind) for kind in (Kind.STATE, Kind.STATE, Kind.ORDER))
    assert [a.header_id, b.header_id, c.header_id] == [0, 1, 0]
    assert a.timestamp == b.timestamp == "1970-01-01T00:01:40.000Z"
    assert c.timestamp == "1970-01-01T00:01:41.500Z"


def test_topics():
    topics, vehicle = Topics(), Identity("kiva", "7")
    assert topics.of(vehicle, Kind.ORDER) == "uagv/v2/kiva/7/order"
    assert topics.parse("uagv/v2/kiva/7/instantActions") == (vehicle, Kind.INSTANT_ACTIONS)
    assert prefix_of("3.0.0") == "vda5050/v3"
    for topic in ("uagv/v2/kiva/order", "uagv/v3/kiva/7/order", "uagv/v2/kiva/7/orders"):
        with pytest.raises(TopicError, match="is not uagv/v2/"):
            topics.parse(topic)
    with pytest.raises(TopicError, match="serial is 'a/b'"):
        Identity("kiva", "a/b")
    with pytest.raises(TopicError, match="prefix"):
        Topics("uagv/#")
