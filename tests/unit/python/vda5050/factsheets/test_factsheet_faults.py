# SPDX-License-Identifier: Apache-2.0
"""A factsheet that is invalid is reported, by the field and what was expected."""

import json

import pytest
from test_master_vehicle import Bench

from warehouse_vda5050.broker_topic import masters_message
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.model import Factsheet, Header, InvalidFactsheet
from warehouse_vda5050.mqtt.master_link import MasterLink
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.schemas.factsheet_faults import factsheet_faults
from warehouse_vda5050.topics import Identity, Topics, prefix_of
from warehouse_vda5050.vehicle.abilities import completed

WHO = Identity("acme", "7")


def written(version="2.1.0"):
    """Returns the JSON of a valid factsheet, to be damaged."""
    header = Header(1, "2026-01-01T00:00:00.00Z", version, "acme", "7")
    sheet = completed(Factsheet(header=header), zones=version == "3.0.0")
    return json.loads(codec_for(version).encode(sheet))


def faults(value, version="2.1.0"):
    return factsheet_faults(json.dumps(value).encode(), version)


@pytest.mark.parametrize("version", ["2.0.0", "2.1.0", "3.0.0"])
def test_our_own_is_valid(version):
    assert faults(written(version), version) == ()


@pytest.mark.parametrize(
    ("section", "field", "value", "fault"),
    [
        ("physicalParameters", "speedMax", "fast", "is 'fast'; a number was expected"),
        ("physicalParameters", "speedMax", None, "is missing; a number was expected"),
        ("physicalParameters", "speedMax", 0, "is 0; more than 0 was expected"),
        ("physicalParameters", "width", -0.5, "is -0.5; more than 0 was expected"),
        ("typeSpecification", "maxLoadMass", -3, "is -3; 0 or more was expected"),
        (
            "typeSpecification",
            "agvKinematic",
            "LEGS",
            "is 'LEGS'; one of DIFF, OMNI, THREEWHEEL was expected",
        ),
        ("protocolFeatures", "agvActions", {}, "is an object; a list was expected"),
    ],
)
def test_a_fault_names_the_field_and_what_was_expected(section, field, value, fault):
    sheet = written()
    sheet[section][field] = value
    if value is None:
        del sheet[section][field]
    assert faults(sheet) == (f"{section}.{field} {fault}",)


def test_a_fault_in_a_list_says_where():
    sheet = written()
    del sheet["protocolFeatures"]["agvActions"][1]["actionType"]
    (fault,) = faults(sheet)
    assert fault == ("protocolFeatures.agvActions[1].actionType is missing; a text was expected")


def test_many_faults_are_counted():
    *named, rest = faults({})
    assert len(named) == 5 and rest.endswith("fields more")


def test_blocking_types_fit_although_the_schema_of_2_has_none_that_does():
    sheet = written()
    sheet["protocolFeatures"]["agvActions"][0]["blockingTypes"] = ["HARD"]
    assert faults(sheet) == ()


def heard(payload, version="2.1.0"):
    """Returns what a master hears of a factsheet."""
    got = []
    topics, codec = Topics(prefix_of(version)), codec_for(version)
    broker = BrokerSettings("localhost", 1)
    link = MasterLink("m", [WHO], codec, topics, broker, lambda _who, message: got.append(message))
    link._on_message(f"{topics.prefix}/acme/7/factsheet", payload, True)
    return got


def test_the_link_hands_on_what_is_invalid_and_what_can_not_be_read():
    sheet = written()
    sheet["typeSpecification"]["agvClass"] = "SPOON"
    (read,) = heard(json.dumps(sheet).encode())
    assert read.max_speed == 1.5 and "agvClass is 'SPOON'" in read.faults[0]
    sheet["physicalParameters"]["speedMax"] = "fast"
    assert heard(json.dumps(sheet).encode()) == [
        InvalidFactsheet("physicalParameters.speedMax is 'fast'; a number was expected")
    ]
    assert heard(b"") == []


def test_the_vehicle_reports_it_once_and_the_page_as_long_as_it_is_so():
    bench = Bench()
    sheet = Factsheet(faults=("physicalParameters.width is -1; more than 0 was expected",))
    for _ in range(2):
        bench.vehicle.take_factsheet(sheet)
    assert bench.events() == [("REFUSED", f"its factsheet is invalid: {sheet.faults[0]}")]
    errors = masters_message([bench.vehicle], "here", 0.0).errors
    assert errors == [f"factsheet: {sheet.faults[0]}"]
    bench.vehicle.take_factsheet(Factsheet())
    assert bench.events() == [] and masters_message([bench.vehicle], "here", 0.0).errors == [""]


def test_one_that_can_not_be_read_leaves_what_was_known():
    bench = Bench()
    bench.vehicle.take_factsheet(Factsheet(max_nodes=3))
    for _ in range(2):
        bench.vehicle.refuse_factsheet("speedMax is 'fast'; a number was expected")
    text = "its factsheet can't be read: speedMax is 'fast'; a number was expected"
    assert bench.events() == [("REFUSED", text)]
    assert bench.vehicle.abilities.max_nodes == 3 and bench.vehicle.sheet_faults
