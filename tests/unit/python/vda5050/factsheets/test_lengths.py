# SPDX-License-Identifier: Apache-2.0
"""The master keeps to the lengths of strings and arrays of a vehicle's factsheet."""

import json
import re

import pytest
from test_abilities import bench_of

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.master.commands import Follow, Lift, Stop
from warehouse_vda5050.master.text_limits import zones_too_long
from warehouse_vda5050.model import Factsheet, InstantActions, Lengths, VehicleOrder, ZoneSet
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.zones.zone import Zone, ZoneType


def drive(bench, count=4):
    points = [(float(x), 0.0) for x in range(count)]
    bench.vehicle.command(Follow(9, 0, tuple(points), count))
    return sent(bench, VehicleOrder)


def sent(bench, kind):
    return [message for message in bench.sent(0.1) if isinstance(message, kind)]


@pytest.mark.parametrize(
    ("lengths", "text"),
    [
        (Lengths(id=4), "orderId 'run-21-1' has 8 characters, and idLen of its factsheet is 4"),
        (Lengths(is_numeric=True), "orderId 'run-21-1' is no number"),
    ],
)
def test_an_id_that_a_vehicle_can_not_take_is_refused_by_its_field(lengths, text):
    bench = bench_of(Factsheet(lengths=lengths))
    bench.vehicle.take_events()
    assert drive(bench) == []
    (refused,) = [e.text for e in bench.vehicle.take_events() if e.kind.value == "REFUSED"]
    assert refused.startswith(f"an order that it can't take: {text}")
    assert bench.vehicle.is_idle


@pytest.mark.parametrize(
    ("lengths", "text"),
    [
        (Lengths(load_id=5), "loadId 'storage_unit7' has 13 characters, and loadIdLen"),
        (Lengths(word=5), "has 11 characters, and enumLen of its factsheet is 5"),
        (Lengths(parameters=1), "pick has 3 parameters, and actions.actionsParameters of its"),
    ],
)
def test_a_lift_that_a_vehicle_can_not_take_is_refused(lengths, text):
    bench = bench_of(Factsheet(lengths=lengths))
    bench.vehicle.command(Lift(True, 7))
    assert sent(bench, VehicleOrder) == []
    texts = [e.text for e in bench.vehicle.take_events() if e.kind.value == "REFUSED"]
    assert len(texts) == 1 and text in texts[0]


def test_limits_that_are_met_and_zero_change_nothing():
    wide = Lengths(100_000, 64, False, 32, 32, 1, 5, 10)
    for lengths in (Lengths(), wide):
        (order,) = drive(bench_of(Factsheet(lengths=lengths)))
        assert len(order.nodes) == 4


def test_an_order_is_as_short_as_the_longest_message_asks():
    bench = bench_of(Factsheet(lengths=Lengths(message=5000)))
    (order,) = drive(bench, 30)
    assert len(codec_for().encode(order)) <= 5000 and 2 <= len(order.nodes) < 30


def test_instant_actions_beyond_the_most_of_a_message_come_in_the_next():
    bench = bench_of(Factsheet(lengths=Lengths(instant_actions=1)))
    instants = bench.vehicle._instants
    for kind in ("stateRequest", "startPause"):
        instants.ask(kind)
    messages = [instants.due(1000.0) for _ in range(3)]
    types = [[action.type for action in message.actions] for message in messages if message]
    assert types[-2:] == [["stateRequest"], ["startPause"]]


@pytest.mark.parametrize(
    ("lengths", "pattern"),
    [
        (Lengths(), r"run-21-i\d"),
        (Lengths(id=6), r"n?-?21-i\d"),
        (Lengths(is_numeric=True), r"\d{15}"),
        (Lengths(id=8, is_numeric=True), r"\d{8}"),
    ],
)
def test_ids_of_instant_actions_are_as_short_as_the_vehicle_asks(lengths, pattern):
    bench = bench_of(Factsheet(lengths=lengths))
    sent(bench, InstantActions)
    bench.vehicle.command(Stop(True))
    (message,) = sent(bench, InstantActions)
    ids = [action.id for action in message.actions if action.type == "startPause"]
    assert re.fullmatch(pattern, ids[0]) and len(ids) == 1
    bench.vehicle.command(Stop(False))
    assert [action.id for action in sent(bench, InstantActions)[0].actions] != ids


@pytest.mark.parametrize(
    ("lengths", "text"),
    [
        (Lengths(id=8), "zoneSetId 'warehouse-run-1-1' has 17 characters, and idLen of its"),
        (Lengths(message=500), "1 zones need 800 bytes, and its most are 500"),
        (Lengths(is_numeric=True), "zoneSetId 'warehouse-run-1-1' is no number"),
        (Lengths(message=900, id=20), ""),
    ],
)
def test_a_zone_set_that_a_vehicle_can_not_take_is_refused_by_its_field(lengths, text):
    corners = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    zones = ZoneSet("warehouse-run-1-1", "hall", (Zone("closed1", ZoneType.BLOCKED, corners),))
    assert zones_too_long(zones, lengths).startswith(text)
    assert bool(zones_too_long(zones, lengths)) == bool(text)
    assert len(codec_for("3.0.0").encode(zones)) <= 800


@pytest.mark.parametrize("version", ["2.1.0", "3.0.0"])
def test_lengths_are_read_from_a_factsheet(version):
    is_new = version.startswith("3")
    codec = codec_for(version)
    value = codec.to_json(Factsheet())
    limits = value["protocolLimits"]
    strings = limits["maximumStringLengths" if is_new else "maxStringLens"]
    arrays = limits["maximumArrayLengths" if is_new else "maxArrayLens"]
    strings |= {"maximumIdLength" if is_new else "idLen": 30, "idNumericalOnly": True}
    strings |= {"maximumLoadIdLength" if is_new else "loadIdLen": 12}
    arrays |= {"node.actions": 2, "actions.actionsParameters": 3, "instantActions": 4}
    read = codec.decode(Kind.FACTSHEET, json.dumps(value).encode()).message
    assert read.lengths == Lengths(1 << 20, 30, True, 0, 12, 2, 3, 4)
