# SPDX-License-Identifier: Apache-2.0
"""The handover note says what holds, what happened, and who did what."""

from types import SimpleNamespace

from warehouse_msgs.msg import CoordinatorState, Kpis
from warehouse_viewer.api.handover import Situation, written

ALARM = {"title": "Robot is broken", "text": "kiva3 is broken (drive)", "since": 3000.0}
COMMAND = {"address": "127.0.0.1", "method": "POST", "body": "{}", "status": 200}


def situation(**fields):
    past = ALARM | {"until": 3100.0, "duration": 100.0, "actions": [{"by": "Ann", "what": "Tow"}]}
    usual = {
        "name": "small",
        "since": 1800.0,
        "now": 3600.0,
        "stop": None,
        "alarms": [ALARM | {"seen_by": ""}],
        "past": [past, past | {"until": 100.0, "text": "long ago"}],
        "robots": [SimpleNamespace(id=3, failures=["MOTOR"], charge=0.1)],
        "stations": [{"name": "pick1", "open": False, "mode": "AUTOMATIC"}],
        "commands": [
            COMMAND | {"time": 2000.0, "by": "Ann", "path": "/robots/3/tow"},
            COMMAND | {"time": 2000.0, "by": "Bob", "path": "/robots/4/tow", "status": 409},
        ],
        "coordinator": CoordinatorState(out_of_service_kiva=[7]),
        "kpis": Kpis(orders_completed=12, orders_waiting=3, orders_late=1, items_picked=40),
    }
    return Situation(**usual | fields)


def test_what_holds_and_what_happened():
    note = written(situation(), "2026-11-27 04:30")
    assert note.startswith("# Handover, 2026-11-27 04:30\n\nsmall: from 0:30:00 to 1:00:00")
    for text in (
        "- Robot is broken: kiva3 is broken (drive), for 10 min; seen by no one yet",
        "- Out of service: kiva7\n- Broken: kiva3\n- Battery below 20 %: kiva3\n- pick1 is closed",
        "- 12 orders done, 3 open, 1 of them late",
        "- 0:50:00, for 2 min: kiva3 is broken (drive); Ann: Tow",
        "- 0:33:20 Ann: POST /robots/3/tow {}",
        "## Remarks",
    ):
        assert text in note, note
    assert "long ago" not in note and "Bob" not in note


def test_an_emergency_stop_comes_first():
    note = written(situation(stop="Ann"), "")
    assert "## Look after\n\n- Emergency stop, by Ann: no robot moves" in note


def test_without_a_shift_it_says_so():
    note = written(situation(kpis=None, coordinator=None, robots=(), stations=()), "")
    assert "- no shift is running" in note


def test_closed_zones_are_named():
    zone = {"reason": "spill", "closed_by": "Ann", "until": None}
    note = written(situation(zones=[zone, zone | {"closed_by": "", "until": 3720.0}]), "")
    assert "- Zone 'spill' is closed until it is opened, by Ann\n" in note
    assert "- Zone 'spill' is closed until 1:02:00\n" in note
