# SPDX-License-Identifier: Apache-2.0
"""What our vehicle and our master send as 3.0.0 fits the official schemas."""

import paper_master
import paper_vehicle
from official_schemas import faults

from warehouse_vda5050.conform.cases import cases_of
from warehouse_vda5050.conform.master.cases import cases_of as master_cases_of
from warehouse_vda5050.topics import ABOUT_ZONES, TO_VEHICLE, Kind

VERSION = "3.0.0"
CHAPTERS = ("order", "update", "cancel", "instant", "errors", "version_3")
# The published schema says otherwise than the specification's own table: booleans, and a plural.
CONTRADICTED = ("pauseAllowed", "cancelAllowed", "mobileRobotKinematic")


def test_the_vehicles_messages():
    runner = paper_vehicle.runner_for(VERSION)
    assert [*runner.run([c for c in cases_of(VERSION) if c.chapter in CHAPTERS])]
    entries = [entry for entry in runner.probe.log.entries if not entry.sent]
    assert {entry.kind for entry in entries} == {*Kind} - {*TO_VEHICLE, *ABOUT_ZONES}
    wrong = {text for e in entries for text in faults(e.kind, e.payload, VERSION)}
    assert not [text for text in wrong if not any(word in text for word in CONTRADICTED)]


def test_the_masters_messages():
    runner = paper_master.runner_for(VERSION)
    cases = [c for c in master_cases_of(VERSION) if c.chapter in ("modes", "horizon")]
    assert [*runner.run(cases)]
    entries = [e for kind in TO_VEHICLE for e in runner.stage.received(kind)]
    assert {entry.kind for entry in entries} == {*TO_VEHICLE}
    assert not {text for e in entries for text in faults(e.kind, e.payload, VERSION)}
