# SPDX-License-Identifier: Apache-2.0
"""Closed zones among the events, and in the reasons of stations and transports."""

from warehouse_msgs.msg import ClosedZone, ClosedZones, StationState
from warehouse_viewer.api import zones_json
from warehouse_viewer.watch.reasons import Reasons
from warehouse_viewer.watch.zone_log import ZoneLog, held_units


def message(*events, **fields):
    columns = zip(*events) if events else ([],) * 5
    names = ("event_id", "event_time", "event_kind", "event_by", "event_text")
    return ClosedZones(**{name: list(column) for name, column in zip(names, columns)}, **fields)


CLOSED = (1, 12.5, ClosedZones.CLOSED, "Ann", "zone 'spill' is closed")
ENDED = (2, 72.5, ClosedZones.ENDED, "", "zone 'spill' is open again")


def test_each_event_comes_once_and_a_new_coordinator_begins_again():
    log = ZoneLog()
    [row] = log.news(message(CLOSED))
    assert (row["kind"], row["time"]) == ("ZONE_CLOSED", 12.5)
    assert row["text"] == "zone 'spill' is closed, by Ann"
    assert log.news(message(CLOSED)) == []
    assert [row["kind"] for row in log.news(message(CLOSED, ENDED))] == ["ZONE_ENDED"]
    assert [row["kind"] for row in log.news(message(CLOSED))] == ["ZONE_CLOSED"]


def test_the_api_says_who_is_inside_and_what_waits():
    zone = ClosedZone(
        3, "spill", "Ann", 0.5, 1.5, 4.5, 2.5, 10.0, 0.0, [7], ["pick1 gets no units"]
    )
    held = message(zones=[zone], transport_id=[5], shelf_id=[23], why=["unit 23 stands in it"])
    shown = zones_json.zones(held)
    assert shown["zones"][0]["inside"] == ["kiva7"] and shown["zones"][0]["until"] is None
    assert shown["waiting"] == [
        {"transport": 5, "storage_unit": "storage_unit23", "why": "unit 23 stands in it"}
    ]
    assert zones_json.zones(None) == {"zones": [], "waiting": []}


def test_a_station_says_that_its_unit_waits_for_a_zone():
    why = "unit 23 stands in the closed zone 'spill'"
    held = held_units(message(transport_id=[5], shelf_id=[23], why=[why]))
    reasons = Reasons()
    station = StationState(name="pick1", open=True, inbound=[23], inbound_orders=[17])
    reasons.update(100.0, None, None, [station], {}, {}, held)
    assert reasons.station("pick1").text == f"waits for unit 23; {why}"
    reasons.update(101.0, None, None, [station], {}, {})
    assert reasons.station("pick1").text == "waits for unit 23; no robot has it yet"
