# SPDX-License-Identifier: Apache-2.0
"""Faults of vehicles on demand: what each does to the wire, and scripts of them."""

import json
from datetime import datetime

import pytest
from grid_robot import GRID, GridRobot, order, row

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.faults import script
from warehouse_vda5050.faults.active import ActiveFaults
from warehouse_vda5050.faults.faulty_driver import FaultyDriver
from warehouse_vda5050.faults.kinds import MEANINGS, Fault, FaultError, read_request
from warehouse_vda5050.faults.vehicle_faults import VehicleFaults
from warehouse_vda5050.formula_driver import FormulaRobot
from warehouse_vda5050.headers import Headers, shifted
from warehouse_vda5050.model import Action, BlockingType, InstantActions
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.topics import Identity, Kind, Topics
from warehouse_vda5050.vehicle import Vehicle

WHO = Identity("kiva", "1")
CODEC, TOPICS = codec_for(), Topics()


class PaperLink:
    """A connection that keeps what was published."""

    connected, is_wanted, closed = True, True, False

    def __init__(self):
        self.sent = []

    def publish(self, message):
        self.sent.append(message)
        return True

    def restore(self):
        self.is_wanted = True


class Site:
    """A vehicle with faults on demand; a tick is 1 s."""

    def __init__(self, cell=(2, 2)):
        self.robot, self.events, self.now = GridRobot(cell), [], 0.0
        self.faults = VehicleFaults(self.robot, self.happened)
        self.vehicle = Vehicle(self.faults.driver, GRID)
        self.link = VehicleLink(
            self.vehicle, WHO, CODEC, TOPICS, BrokerSettings(), faults=self.faults
        )
        self.link._headers = Headers(WHO, "2.1.0", lambda: 1.7e9 + self.now)
        self.link.link = PaperLink()
        self.tick()

    def happened(self, text, begins):
        self.events.append((text, begins))
        self.vehicle.note_event(text)

    def begin(self, fault, seconds=0.0):
        self.faults.active.begin(read_request(fault, seconds), self.now)

    def tick(self, count=1):
        for _ in range(count):
            self.robot.step()
            self.now += 1.0
            self.link.tick(self.now)

    def send(self, kind, message):
        self.link._on_message(TOPICS.of(WHO, kind), CODEC.encode(message), False)

    def request(self):
        """Asks for a state, and waits for it; returns what was published."""
        self.link.link.sent.clear()
        self.vehicle.request_state()
        self.tick()
        return self.states()

    def states(self):
        return [json.loads(m.payload) for m in self.sent(Kind.STATE)]

    def sent(self, kind):
        return [m for m in self.link.link.sent if m.topic == TOPICS.of(WHO, kind)]


def error_types(state):
    return [error["errorType"] for error in state["errors"]]


def test_without_a_fault_each_state_goes_out_once():
    site = Site()
    assert len(site.request()) == 1
    assert not site.faults.is_busy


def test_silent_sends_and_hears_nothing():
    site = Site()
    site.begin("silent", 5)
    assert site.request() == []
    site.send(Kind.ORDER, order("o", row(2, 4, 2)))
    site.tick()
    assert site.vehicle.order is None and site.link.link.sent == []
    site.tick(5)
    (state,) = site.states()  # at once, when it is over
    assert state["orderId"] == ""


def test_lost_states_never_come_and_their_numbers_are_missing():
    site = Site()
    site.begin("lost")
    ids = []
    for _ in range(40):
        ids += [state["headerId"] for state in site.request()]
    assert 8 < len(ids) < 32 and ids == sorted(set(ids))
    assert ids[-1] - ids[0] > len(ids)


def test_doubled_states_come_twice_as_they_are():
    site = Site()
    site.begin("doubled")
    first, second = site.request()
    assert first == second


def test_reordered_states_come_the_later_one_first():
    site = Site()
    site.begin("reordered")
    site.tick()  # the state at the beginning of the fault waits
    first, second = site.request()
    assert first["headerId"] == second["headerId"] + 1


def test_reordered_states_wait_no_longer_than_two_seconds():
    site = Site()
    site.tick(3)
    site.link.link.sent.clear()
    site.begin("reordered")
    site.tick()
    assert site.states() == [] and site.faults.is_busy
    site.tick(2)
    assert len(site.states()) == 1


def test_the_clock_is_an_hour_late_and_right_afterwards():
    site = Site()
    (before,) = site.request()
    site.begin("clock")
    (late,) = site.request()
    site.begin("")
    (after,) = site.request()
    seconds = [datetime.fromisoformat(s["timestamp"]).timestamp() for s in (before, late, after)]
    assert seconds[1] - seconds[0] == pytest.approx(-3599) and seconds[2] - seconds[0] < 5


def test_jump_puts_it_two_metres_aside_and_back():
    site = Site()
    site.begin("jump", 3)
    (state,) = site.request()
    assert (state["agvPosition"]["x"], state["lastNodeId"]) == (4.0, "c4_2")
    site.tick(3)
    (state,) = site.request()
    assert (state["agvPosition"]["x"], state["lastNodeId"]) == (2.0, "c2_2")


def test_a_robot_that_jumped_does_not_take_an_order_from_where_it_is():
    site = Site()
    site.begin("jump")
    site.tick()
    site.send(Kind.ORDER, order("o", row(2, 4, 2)))
    (state,) = site.request()
    assert error_types(state) == ["noRouteError"] and site.robot.path == []


def test_heading_is_a_quarter_turn_off():
    site = Site()
    site.begin("heading")
    (state,) = site.request()
    assert state["agvPosition"]["theta"] == pytest.approx(1.5708)


def test_battery_is_low():
    site = Site()
    site.begin("battery")
    (state,) = site.request()
    assert state["batteryState"] == {"batteryCharge": 4.0, "charging": False}


def test_refuse_refuses_orders_and_updates():
    site = Site()
    site.send(Kind.ORDER, order("o", row(2, 5, 2), released=2))
    site.tick()
    site.begin("refuse")
    site.tick()
    site.send(Kind.ORDER, order("o", row(3, 5, 2), update=1, first=1))
    (state,) = site.request()
    (error,) = state["errors"]
    assert (error["errorType"], state["orderUpdateId"]) == ("orderError", 0)
    assert "refuses all orders" in error["errorDescription"]
    site.begin("")
    site.tick()
    site.send(Kind.ORDER, order("o", row(3, 5, 2), update=1, first=1))
    (state,) = site.request()
    assert (state["orderUpdateId"], state["errors"]) == (1, [])


def test_a_fatal_error_lets_the_robot_stand_and_its_end_lets_it_drive_on():
    site = Site()
    site.send(Kind.ORDER, order("o", row(2, 8, 2)))
    site.tick(2)
    site.begin("error")
    site.tick()
    where = site.robot.cell
    (state,) = site.request()
    (error,) = state["errors"]
    assert (error["errorType"], error["errorLevel"]) == ("faultOnDemand", "FATAL")
    site.tick(5)
    assert site.robot.cell == where
    site.begin("")
    site.tick(10)
    assert site.robot.cell == (8, 2)
    assert site.request()[0]["errors"] == []


def test_a_warning_lets_it_drive():
    site = Site()
    site.send(Kind.ORDER, order("o", row(2, 8, 2)))
    site.begin("error:WARNING")
    site.tick(10)
    (state,) = site.request()
    assert site.robot.cell == (8, 2)
    assert [error["errorLevel"] for error in state["errors"]] == ["WARNING"]


def test_a_pause_outlasts_a_fault_that_ends_within_it():
    site = Site()
    site.send(Kind.ORDER, order("o", row(2, 8, 2)))
    site.tick(2)
    site.begin("error")
    site.tick()
    pause = InstantActions((Action("startPause", "p", BlockingType.NONE),))
    site.send(Kind.INSTANT_ACTIONS, pause)
    site.begin("")
    site.tick()
    assert site.robot.stopped
    site.send(Kind.INSTANT_ACTIONS, InstantActions((Action("stopPause", "g", BlockingType.NONE),)))
    site.tick()
    assert not site.robot.stopped


def test_stop_pause_moves_no_robot_that_a_fault_holds():
    site = Site()
    site.send(Kind.ORDER, order("o", row(2, 8, 2)))
    site.tick(2)
    site.begin("error")
    site.tick()
    site.send(Kind.INSTANT_ACTIONS, InstantActions((Action("stopPause", "g", BlockingType.NONE),)))
    site.tick()
    assert site.robot.stopped


class Rolling(GridRobot):
    """Speeds up by 0.1 m/s a step, and brakes by 0.2."""

    speed = 0.0

    def step(self):
        self.speed = max(0.0, self.speed - 0.2) if self.stopped else min(1.5, self.speed + 0.1)
        self.extra = {"vx": self.speed, "busy": True, "moving": self.speed > 0}


def test_a_slow_robot_stays_near_its_speed_and_says_that_it_drives():
    robot = Rolling()
    faults = ActiveFaults(lambda _text, _begins: None)
    driver = FaultyDriver(robot, faults)
    faults.begin(read_request("slow", 0.0), 0.0)
    speeds, moves = [], []
    for k in range(100):
        robot.step()
        driver.control(0.1 * k)
        speeds.append(robot.speed)
        moves.append(driver.report().moving)
    assert max(speeds) < 0.45 and 0.1 < sum(speeds) / len(speeds) < 0.35 and all(moves)
    faults.begin(read_request("", 0.0), 0.0)
    for k in range(30):
        robot.step()
        driver.control(10 + 0.1 * k)
    assert robot.speed == 1.5


def test_a_robot_that_stops_at_once_is_slow_on_the_average():
    robot = FormulaRobot(0.0, 0.0, 0.0, speed=1.5)
    faults = ActiveFaults(lambda _text, _begins: None)
    driver = FaultyDriver(robot, faults)
    faults.begin(read_request("slow", 0.0), 0.0)
    robot.follow(1, 0, [(0.0, 0.0), (100.0, 0.0)], 2)
    for k in range(400):
        robot.step(0.05)
        driver.control(0.05 * k)
    assert robot.x / 20 == pytest.approx(0.3, rel=0.2)


def test_what_befalls_the_vehicle_is_in_its_events_and_its_journal(tmp_path):
    site = Site()
    site.begin("lost", 2)
    site.tick(3)
    assert site.events == [
        ("fault on demand: half of its states are lost, for 2 s", True),
        ("fault on demand is over: lost", False),
    ]
    site.vehicle.journal._folder = tmp_path
    name = site.vehicle.journal.store("a test")
    text = (tmp_path / name).read_text()
    assert all(event in text for event, _ in site.events)


def test_several_at_a_time_and_all_end():
    site = Site()
    site.begin("error:WARNING")
    site.begin("battery")
    assert site.faults.active.names == "error:WARNING, battery"
    site.begin("")
    assert (site.faults.active.names, len(site.events)) == ("", 4)


def test_each_fault_has_a_meaning():
    assert set(MEANINGS) == set(Fault)


@pytest.mark.parametrize(
    ("fault", "seconds", "text"),
    [
        ("explode", 0.0, "fault is 'explode'; one of silent, lost"),
        ("lost:WARNING", 0.0, "fault is 'lost:WARNING'; error:WARNING or error:FATAL was expected"),
        ("error:LOUD", 0.0, "fault is 'error:LOUD'; error:WARNING or error:FATAL was expected"),
        ("lost", -1.0, "seconds is -1; 0 or more was expected"),
        ("lost", float("nan"), "seconds is nan; 0 or more was expected"),
        ("", float("inf"), "seconds is inf; 0 or more was expected"),
    ],
)
def test_bad_requests_are_refused_in_a_sentence(fault, seconds, text):
    with pytest.raises(FaultError) as refusal:
        read_request(fault, seconds)
    assert str(refusal.value).startswith(text) and "\n" not in str(refusal.value)


def test_a_shifted_time_is_written_as_before():
    assert shifted("2026-01-01T00:30:00.250Z", -3600) == "2025-12-31T23:30:00.250Z"


# --- scripts


def test_a_script_is_carried_out_in_the_order_of_its_times(tmp_path):
    file = tmp_path / "faults.yaml"
    file.write_text(
        "- {at: 20, vehicle: 2, fault: ''}\n"
        "- {at: 5, vehicle: 1, fault: lost, seconds: 2.5}\n"
        "- {at: 5.5, vehicle: 2, fault: error:WARNING}\n"
    )
    faults = script.read(file)
    assert [*faults.due(4.9)] == []
    first, second = faults.due(6)
    assert (first.vehicle, first.request.fault, first.request.seconds) == (1, Fault.LOST, 2.5)
    assert (second.vehicle, second.request.text) == (2, "error:WARNING")
    (last,) = faults.due(100)
    assert last.request.fault is None and last.where == f"{file}:1"
    assert [*faults.due(200)] == []


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("at: 5", 1, "a list of {at, vehicle, fault, seconds} was expected"),
        ("", 1, "a list of {at, vehicle, fault, seconds} was expected"),
        ("- {at: 1, vehicle: 1, fault: lost}\n- 7", 2, "was expected, not 7"),
        ("- {at: 1, fault: lost}", 1, "vehicle is missing"),
        ("- {at: 1, vehicle: 1, fault: lost, when: 2}", 1, "unknown field 'when'"),
        ("- {at: 1, vehicle: one, fault: lost}", 1, "vehicle is 'one'"),
        ("- {at: 1, vehicle: 0, fault: lost}", 1, "vehicle is 0; 1 to 1000000 was expected"),
        ("- {at: .nan, vehicle: 1, fault: lost}", 1, "at is nan; seconds, 0 or more"),
        ("- {at: -1, vehicle: 1, fault: lost}", 1, "at is -1; seconds, 0 or more"),
        ("\n\n- {at: 1, vehicle: 1, fault: lost, seconds: long}", 3, "seconds is 'long'"),
        ("- {at: 1, vehicle: 1, fault: 3}", 1, "fault is 3; the name of a fault"),
        ("- {at: 1, vehicle: 1, fault: burn}", 1, "fault is 'burn'; one of silent"),
        ("- {at: 1\n- x", 2, "expected"),
        ("- {at: 1, vehicle: 1, fault: !!python/name:os.system x}", 1, "could not determine"),
    ],
)
def test_a_bad_script_is_refused_with_file_and_line(tmp_path, text, line, reason):
    file = tmp_path / "faults.yaml"
    file.write_text(text)
    with pytest.raises(script.ScriptError) as refusal:
        script.read(file)
    assert f"{file}:{line}: " in str(refusal.value) and reason in str(refusal.value)


def test_a_script_that_is_not_there_is_named(tmp_path):
    with pytest.raises(script.ScriptError, match=r"none\.yaml"):
        script.read(tmp_path / "none.yaml")
