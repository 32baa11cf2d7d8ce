# SPDX-License-Identifier: Apache-2.0
"""One alarm for each failure, with its consequences; and why each robot and station waits."""

from types import SimpleNamespace

import numpy as np
from sample_messages import coordinator_state

from warehouse_layout.message_enums import FailureKind
from warehouse_msgs.msg import FleetState, StationState
from warehouse_viewer.watch import causes, troubles
from warehouse_viewer.watch.alarm_book import AlarmBook, Trouble
from warehouse_viewer.watch.reasons import Reasons

NOW = 1000.0  # [s]


def fleet(count, broken=(), loads=None):
    """A FleetState of `count` robots; `broken`: numbers of those without a drive; `loads`: units by
    robot."""
    message = FleetState(kiva_id=list(range(1, count + 1)))
    failures = np.zeros(count, np.uint8)
    failures[[n - 1 for n in broken]] = 1 << FailureKind.MOTOR
    message.failures, message.last_end = failures.tobytes(), bytes(count)
    message.shelf_id = [(loads or {}).get(n, 0) for n in message.kiva_id]
    return message


def coordinator(waits, **fields):
    """A CoordinatorState; `waits`: {robot: (robot ahead, since, text)}."""
    return coordinator_state(
        NOW,
        waiting_kiva=list(waits),
        waiting_for=[ahead for ahead, _, _ in waits.values()],
        waiting_since=[since for _, since, _ in waits.values()],
        waiting_text=[text for _, _, text in waits.values()],
        **fields,
    )


def queue(last, head=16):
    """Robots up to `last` that stand behind each other, the first behind `head`."""
    text = "in the queue of pick4 behind kiva{}, which is broken"
    waits = {1: (head, 700.0, text.format(head))}
    return waits | {n: (n - 1, 800.0, text.format(n - 1)) for n in range(2, last + 1)}


def situation(fleet, coordinator, stations=(), starved=None, assigned=None):
    """(Reasons, the alarms by cause) of a moment."""
    reasons = Reasons()
    starved = starved or {}
    reasons.update(NOW, fleet, coordinator, stations, starved, assigned or {})
    pending = [
        *troubles.of_fleet(fleet),
        *troubles.of_coordinator(coordinator),
        *troubles.of_stations(stations, NOW, starved),
    ]
    return reasons, causes.by_cause(pending, reasons, NOW)


STATION = StationState(name="pick4", kind="PICK", open=True, orders=[17], inbound=[23])
STATION.inbound_orders = [17]


def test_a_broken_robot_is_one_alarm_with_its_queue_and_its_station():
    state = coordinator(queue(6), alarms=["kiva16: drive"])
    _, alarms = situation(fleet(20, [16], {16: 23}), state, [STATION], {"pick4": 40.0})
    (alarm,) = alarms
    assert (alarm.kind, alarm.subject) == ("ROBOT_BROKEN", "kiva16")
    assert alarm.headline == (
        "kiva16 is broken (drive): 6 robots wait behind it, pick4 stands still for 16 min"
    )
    assert "kiva1, kiva2" in alarm.consequences[0] and "unit 23" in alarm.consequences[1]


def test_a_broken_robot_that_waits_is_where_the_queue_begins():
    waits = {8: (14, 700.0, "behind kiva14, which is broken")}
    waits[14] = (8, 700.0, "behind kiva8")  # before it broke down
    waits |= {15: (8, 300.0, "in the queue of pick3 behind kiva8, in a queue behind kiva14")}
    _, (alarm,) = situation(fleet(15, [14]), coordinator(waits))
    assert alarm.headline == "kiva14 is broken (drive): 2 robots wait behind it"


def test_two_failures_are_two_alarms_each_with_its_own():
    waits = queue(3) | {8: (18, 100.0, "behind kiva18, which is broken")}
    _, alarms = situation(fleet(20, [16, 18]), coordinator(waits))
    assert {alarm.subject: alarm.queue for alarm in alarms} == {"kiva16": 3, "kiva18": 1}


def test_robots_behind_a_manual_one_are_an_alarm_of_that():
    waits = {n: (n - 1 or 9, 100.0, "behind kiva9, which is manual") for n in (1, 2)}
    _, (alarm,) = situation(fleet(9), coordinator(waits, manual_kiva=[9]))
    assert alarm.headline == "kiva9 is manual: 2 robots wait behind it"
    actions = [remedy.action for remedy in causes.remedies(alarm, {"kiva9": "MANUAL"})]
    assert actions == ["SHOW", "OUT_OF_SERVICE", "AUTOMATIC", "MOMENT"]


def test_what_has_waited_for_a_repaired_robot_is_given_time():
    waits = {n: (n - 1 or 9, 100.0, "until its route is free") for n in (1, 2)}
    state = coordinator(waits | {9: (0, 100.0, "until its route is free")})
    reasons = Reasons()
    for now, broken, expected in (
        (NOW, [9], ["ROBOT_BROKEN"]),
        (NOW + 1, [], []),
        (NOW + troubles.HELD_UP - 1, [], []),
        (NOW + troubles.HELD_UP + 1, [], ["ROBOT_WAITS"]),
    ):
        state.header.stamp = state.header.stamp.from_sec(now)
        message = fleet(9, broken)
        reasons.update(now, message, state, (), {}, {})
        pending = [*troubles.of_fleet(message), *troubles.of_coordinator(state)]
        alarms = causes.by_cause(pending, reasons, now)
        assert [alarm.kind for alarm in alarms] == expected, now
    assert alarms[0].since == NOW


def test_a_queue_that_moves_on_after_a_repair_is_no_alarm():
    first = queue(3)  # behind kiva16
    reasons, starved = Reasons(), {"pick4": 40.0}
    for now, broken, waits, expected in (
        (NOW, [16], first, ["ROBOT_BROKEN"]),
        # The first has gone; the others have stood for as long as before.
        (NOW + 5, [], {n: first[n] for n in (2, 3)}, []),
        (NOW + 10, [], {3: (0, 800.0, "until its route is free")}, []),
        (NOW + troubles.STARVED + 1, [], {}, ["STATION_STARVED"]),
    ):
        state, message = coordinator(waits), fleet(20, broken, {1: 23})
        reasons.update(now, message, state, [STATION], starved, {})
        pending = [
            *troubles.of_fleet(message),
            *troubles.of_coordinator(state),
            *troubles.of_stations([STATION], now, starved),
        ]
        alarms = causes.by_cause(pending, reasons, now)
        assert [alarm.kind for alarm in alarms] == expected, now


def test_a_queue_behind_a_robot_that_works_is_no_fault():
    waits = {n: (n - 1 or 9, 700.0, "until its route is free") for n in (1, 2)}
    _, alarms = situation(fleet(9), coordinator(waits))
    assert alarms == []
    _, (alarm,) = situation(fleet(9), coordinator(waits | {9: (0, 700.0, "for a free cell")}))
    assert alarm.headline == "kiva9 waits for a free cell: 2 robots wait behind it"


def test_a_ring_of_robots_is_one_alarm():
    waits = {n: (n % 3 + 1, 100.0, "behind another") for n in (1, 2, 3)}
    _, alarms = situation(fleet(4), coordinator(waits))
    assert [alarm.subject for alarm in alarms] == ["kiva1"]


def test_the_watchdog_belongs_to_the_longest_queue():
    cause = Trouble("ROBOT_BROKEN", "kiva16", "kiva16 is broken (drive)")
    watchdog = Trouble("WATCHDOG", "watchdog", "the watchdog has acted 2 times")
    reasons = Reasons()
    (alarm,) = causes.by_cause([cause, watchdog], reasons, NOW)
    assert alarm.consequences == (watchdog.text,)
    assert causes.by_cause([watchdog], reasons, NOW) == [watchdog]


def test_remedies_have_the_words_of_their_buttons():
    broken = Trouble("ROBOT_BROKEN", "kiva3", "kiva3 is broken (drive)")
    assert [remedy.label for remedy in causes.remedies(broken, {})] == [
        "Show on the floor",
        "Out of service",
        "Repair",
        "Tow",
        "Go to the moment",
    ]
    away = causes.remedies(broken, {"kiva3": "OUT_OF_SERVICE"})
    assert [remedy.label for remedy in away][-2:] == ["Automatic again", "Go to the moment"]
    touched = Trouble("COLLISION", "wall7", "…")
    assert [remedy.action for remedy in causes.remedies(touched, {})] == ["SHOW", "MOMENT"]


def test_an_alarm_that_ends_is_history_with_what_people_did():
    book = AlarmBook()
    book.update(10, [Trouble("ROBOT_STALLED", "kiva3", "kiva3 does not move")])
    number = book.as_json()[0]["id"]
    book.see(number, "Anna")
    book.update(20, [Trouble("ROBOT_BROKEN", "kiva3", "kiva3 is broken (drive)")])
    assert (book.as_json()[0]["id"], book.as_json()[0]["seen_by"]) == (number, "Anna")
    book.note("kiva3", "Anna", "Repair")
    # Its route is not free at once.
    book.update(70, [Trouble("ROBOT_WAITS", "kiva3", "kiva3 waits until its route is free")])
    (past,) = book.history()
    assert (past["cause"], past["duration"]) == ("kiva3 is broken (drive)", 60)
    assert past["actions"] == [{"time": 20, "by": "Anna", "what": "Repair"}]
    assert book.time_to_repair() == (1, 60)


def test_robot_and_station_say_the_same_cause():
    waits = {9: (16, 700.0, "in the queue of pick4 behind kiva16, which is broken")}
    message = fleet(20, [16], {9: 23, 16: 40})
    state = coordinator(waits, doing_kiva=[9], doing=["bringing"])
    reasons, _ = situation(message, state, [STATION], {"pick4": 40.0})
    why = reasons.find("kiva9")
    assert why.sentence == (
        "kiva9 waits in the queue of pick4 behind kiva16, which is broken; "
        "brings unit 23 to pick4 for order 17"
    )
    assert (why.cause, why.behind, why.order) == ("kiva16", "kiva16", 17)
    station = reasons.find("pick4")
    assert station.text == f"waits for unit 23 on kiva9, which {why.text}"
    assert (station.cause, station.since) == ("kiva16", 40.0)
    assert reasons.at("kiva9", NOW) == why.sentence and reasons.at("kiva9", 10.0) == ""
    assert reasons.find("kiva99") is None and reasons.find("pick9") is None


def test_a_robot_on_its_way_to_a_unit_says_for_which_station():
    state = coordinator({}, doing_kiva=[2, 3], doing=["fetching", "storing"])
    message = fleet(3, loads={3: 40})
    assigned = {2: (23, "pick4"), 3: (40, "pick4")}
    reasons, _ = situation(message, state, [STATION], assigned=assigned)
    assert reasons.robot(2).sentence == "kiva2 fetches unit 23 for pick4 for order 17"
    assert reasons.robot(3).errand == ""
    assert reasons.station("pick4").text == "waits for unit 23, which kiva2 fetches"


def test_a_reset_forgets_what_was():
    reasons = Reasons()
    station = SimpleNamespace(**{n: getattr(STATION, n) for n in STATION.__slots__})
    reasons.update(NOW, None, None, [station], {}, {})
    reasons.update(1.0, None, None, [station], {}, {})
    assert reasons.at("pick4", 1.0) and not reasons.at("pick4", 0.5)
