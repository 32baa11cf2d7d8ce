# SPDX-License-Identifier: Apache-2.0
"""What is wrong becomes alarms: since when, the cause, what to do, the person that saw it."""

import stat

import pytest
from sample_messages import fleet

from warehouse_layout.message_enums import EventKind
from warehouse_msgs.msg import CoordinatorState, ForecastResult, StationState
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.watch import alarm_file, troubles
from warehouse_viewer.watch.alarm_book import GRACE, AlarmBook, Trouble
from warehouse_viewer.watch.alarm_file import AlarmFile
from warehouse_viewer.watch.alarm_kinds import KINDS, SEVERITIES

BROKEN = Trouble("ROBOT_BROKEN", "kiva3", "kiva3: drive")
NOTICE = Trouble("NOTICE", "order 7 is refused", "order 7 is refused")


def test_an_alarm_keeps_its_number_and_its_beginning_while_it_lasts():
    book = AlarmBook()
    book.update(10, [BROKEN])
    (first,) = book.as_json()
    book.update(50, [BROKEN._replace(text="kiva3: drive, lift stuck")])
    (now,) = book.as_json()
    assert (now["id"], now["since"]) == (first["id"], 10)
    assert now["text"] == "kiva3: drive, lift stuck" and now["to_do"]
    book.update(60, [])
    assert book.as_json() == []
    book.update(70, [BROKEN])
    assert book.as_json()[0]["id"] != first["id"]


def test_all_see_who_has_seen_it():
    book = AlarmBook()
    book.update(10, [BROKEN])
    number = book.as_json()[0]["id"]
    assert book.see(number, "Anna")["seen_by"] == "Anna"
    book.update(30, [BROKEN])
    assert (book.as_json()[0]["seen_by"], book.as_json()[0]["seen_at"]) == ("Anna", 10)
    assert book.see(number, "")["seen_by"] == ""
    assert book.see(number + 1000, "Anna") is None


def test_the_worst_comes_first_and_of_those_the_oldest():
    book = AlarmBook()
    book.update(10, [NOTICE])
    book.update(20, [NOTICE, BROKEN])
    book.update(30, [NOTICE, BROKEN, BROKEN._replace(subject="kiva1", since=15.0)])
    assert [(item["kind"], item["subject"]) for item in book.as_json()][:2] == [
        ("ROBOT_BROKEN", "kiva1"),
        ("ROBOT_BROKEN", "kiva3"),
    ]


def test_what_ends_by_itself_at_once_is_no_alarm():
    book, blocked = AlarmBook(), Trouble("ROBOT_BLOCKED", "kiva1", "…")
    book.update(10, [blocked])
    assert book.as_json() == []
    book.update(10 + KINDS["ROBOT_BLOCKED"].after, [blocked])
    assert len(book.as_json()) == 1


def test_every_kind_says_what_to_do():
    for name, kind in KINDS.items():
        assert kind.severity in SEVERITIES and kind.title and kind.to_do.endswith("."), name
    kinds = {kind for _, kind in troubles.SENTENCES} | set(troubles.MOMENTS.values())
    assert kinds < set(KINDS)


@pytest.mark.parametrize(
    ("text", "kind", "subject"),
    [
        ("kiva3: drive, lift stuck", "ROBOT_BROKEN", "kiva3"),
        ("kiva7 does not move", "ROBOT_STALLED", "kiva7"),
        (
            "kiva7 does not move: it refuses what it is sent (orderError: 'no')",
            "ROBOT_STALLED",
            "kiva7",
        ),
        ("kiva7 is off the floor, at -37.0, -4.0 m: put it back", "ROBOT_LOST", "kiva7"),
        ("kiva7 was pushed and does not find back: put it straight", "ROBOT_LOST", "kiva7"),
        ("pick1 has waited for a person for 40 s", "STATION_UNATTENDED", "pick1"),
        ("item4 lies on the floor, off storage_unit1", "ITEM_FALLEN", "item4"),
        (
            "storage_unit7 stands across cells at (3.0, 1.4): put it straight",
            "OBSTACLE",
            "storage_unit7",
        ),
        (
            "storage_unit7 stands in a street at (3.0, 1.0): bring it to a storage place",
            "OBSTACLE",
            "storage_unit7",
        ),
        ("a plan was refused: two robots in a cell", "PLAN_REFUSED", "a plan was refused"),
        ("the floor has no way out", "COORDINATOR", "the floor has no way out"),
    ],
)
def test_the_coordinators_sentences_are_understood(text, kind, subject):
    assert troubles.of_sentence(text)[:2] == (kind, subject)


def test_a_robot_that_waits_for_long_is_reported_with_its_reason():
    state = CoordinatorState(
        waiting_kiva=[1, 2, 3],
        waiting_since=[0.0, 190.0, 0.0],
        waiting_text=["behind kiva9", "…", "in the queue of pick1 behind kiva4"],
    )
    state.header.stamp.secs = 200
    assert list(troubles.of_coordinator(state)) == [
        Trouble("ROBOT_WAITS", "kiva1", "kiva1 waits behind kiva9", 0.0)
    ]


def test_robots_that_need_help_are_reported():
    message = fleet()
    message.failures, message.last_end = bytes([0, 2]), bytes([EventKind.BLOCKED] * 2)
    kinds = [(trouble.kind, trouble.subject) for trouble in troubles.of_fleet(message)]
    assert kinds == [("ROBOT_BROKEN", "kiva2"), ("ROBOT_BLOCKED", "kiva1")]


def test_a_station_that_waits_says_for_whom():
    manual = StationState(name="pick1", kind="PICK", shelf_id=4, waiting=80.0)
    empty = StationState(name="pick2", kind="PICK", orders=[1, 2], inbound=[7])
    pending = list(troubles.of_stations([manual, empty], 300.0, {"pick2": 10.0}))
    assert [(trouble.kind, trouble.since) for trouble in pending] == [
        ("STATION_UNATTENDED", 220.0),
        ("STATION_STARVED", 10.0),
    ]
    assert "unit 4" in pending[0].text and "1 on their way" in pending[1].text


def test_orders_that_a_forecast_says_late_are_an_alarm_while_it_counts():
    bands = {"late_p10": [1.0, 3.0], "late_p50": [1.0, 6.0], "late_p90": [2.0, 9.0]}
    result = ForecastResult(made_at=600.0, minutes=60.0, runs=9, **bands)
    (trouble,) = troubles.of_forecast(result, 700.0)
    text = "5 orders (2 to 7) will become late by 1:10, by a forecast"
    assert (trouble.kind, trouble.text, trouble.since) == ("ORDERS_WILL_BE_LATE", text, 600.0)
    assert not [*troubles.of_forecast(result, 600.0 + troubles.FORECAST)]
    result.changes = ["+0 close pick1"]  # what would be is no fault
    assert not [*troubles.of_forecast(result, 700.0)]
    assert not [*troubles.of_forecast(ForecastResult(made_at=600.0, minutes=60.0), 700.0)]
    assert not [*troubles.of_forecast(None, 700.0)]


def test_what_happened_in_a_moment_is_told_for_a_while_and_counted():
    moments = troubles.Moments()
    event = {"kind": "COLLISION", "model": "kiva1", "text": "touched wall", "time": 100.0}
    moments.take_event(event)
    moments.take_event(event | {"time": 150.0})
    moments.take_event(event | {"kind": "DONE"})
    (trouble,) = moments.lasting(200.0)
    assert (trouble.kind, trouble.text) == ("COLLISION", "kiva1: touched wall (2 times)")
    assert moments.lasting(150.0 + troubles.LASTING) == []


def test_the_watchdog_is_told_when_it_acts_again():
    moments = troubles.Moments()
    moments.take_watchdog(4, 10.0)
    assert moments.lasting(11.0) == []
    moments.take_watchdog(5, 20.0)
    assert [trouble.kind for trouble in moments.lasting(21.0)] == ["WATCHDOG"]


def test_alarms_outlast_a_restart_with_who_saw_and_did_what(tmp_path):
    book, file = AlarmBook(), AlarmFile(tmp_path / "alarms" / "run.json")
    assert file.read() is None
    book.update(5, [NOTICE])
    book.update(10, [BROKEN._replace(consequences=("1 robot waits behind it: kiva4",))])
    number = book.as_json()[0]["id"]
    book.see(number, "Anna")
    book.note("kiva3", "Anna", "Tow")
    file.write(book.state())
    assert stat.S_IMODE((tmp_path / "alarms" / "run.json").stat().st_mode) == 0o600
    again = AlarmBook()
    again.restore(file.read())
    again.update(20, [])  # what raised it is not known yet
    (alarm,) = again.as_json()
    assert (alarm["id"], alarm["since"], alarm["seen_by"]) == (number, 10, "Anna")
    assert alarm["consequences"] == ["1 robot waits behind it: kiva4"]
    assert alarm["actions"] == [{"time": 10, "by": "Anna", "what": "Tow"}]
    assert [row["cause"] for row in again.history()] == [NOTICE.text]
    again.update(20 + GRACE, [NOTICE])
    assert [row["cause"] for row in again.history()] == [BROKEN.text, NOTICE.text]
    assert again.time_to_repair() == (1, 20)
    assert again.as_json()[0]["id"] > number


@pytest.mark.parametrize("text", ["", "[]", '{"alarms": [{}], "ended": [], "last": 1, "now": 1}'])
def test_a_damaged_file_of_alarms_is_an_error(tmp_path, text):
    (tmp_path / "run.json").write_text(text)
    with pytest.raises((ValueError, KeyError, TypeError)):
        AlarmBook().restore(AlarmFile(tmp_path / "run.json").read())


def test_files_of_old_launches_go(tmp_path):
    for number in range(alarm_file.KEPT + 3):
        AlarmFile(tmp_path / f"{number}.json").write(AlarmBook().state())
    assert len(list(tmp_path.iterdir())) == alarm_file.KEPT
    path = alarm_file.default_path("a1-b2", "/sim1/", {"ROS_HOME": "/home"})
    assert str(path) == "/home/warehouse/alarms/a1-b2_sim1.json"


def test_what_begins_and_ends_is_news_once():
    book = AlarmBook()
    book.update(10, [BROKEN])
    begun, ended = book.news()
    assert ([row["subject"] for row in begun], ended) == (["kiva3"], [])
    assert book.news() == ([], [])
    book.update(30, [])
    begun, ended = book.news()
    assert (begun, [row["duration"] for row in ended]) == ([], [20])


def test_a_model_keeps_its_troubles_where_many_events_pass():
    journal = Journal(kept=3)
    event = {"time": 1.0, "command": 0, "other": "", "text": ""}
    journal.add(event | {"kind": "FAILED", "model": "kiva3"})
    journal.add(event | {"kind": "DONE", "model": "kiva3"})
    for _ in range(5):
        journal.add(event | {"kind": "DONE", "model": "kiva4"})
    assert [e["kind"] for e in journal.since(0, "kiva3")] == ["FAILED"]
    journal.add(event | {"kind": "REPAIRED", "model": "kiva3"})
    assert [e["kind"] for e in journal.since(0, "kiva3")] == ["FAILED", "REPAIRED"]
    assert [e["kind"] for e in journal.since(1, "kiva3")] == ["REPAIRED"]
    assert len(journal.since(0)) == 3
