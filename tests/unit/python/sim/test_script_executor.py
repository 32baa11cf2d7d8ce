# SPDX-License-Identifier: Apache-2.0
"""Scripts go on when their robot's command has ended and it may take the next."""

import pytest
import rospy
from fake_ros import FakeRos

from warehouse_msgs.msg import Event, KivaStatus, Lift
from warehouse_sim.script_executor import DeadlineError, Interrupted, ScriptExecutor, command


class Stage(FakeRos):
    """Robots that answer every command with the events in `answers`, then are idle."""

    def __init__(self, *answers):
        super().__init__()
        self.answers, self.said, self.stopped, self.seconds = list(answers), [], False, 0
        self.executor = ScriptExecutor(self, lambda *line: self.said.append(line), deadline=0.2)
        for publisher in self.publishers.values():
            publisher.listeners = 1
            publisher.publish = self.act

    def is_shutdown(self):
        return self.stopped

    def act(self, message):
        self.seconds += 1
        for kind in self.answers.pop(0) if self.answers else ():
            self.event(kind, message.kiva_id)
        self.status(message.kiva_id)

    def event(self, kind, kiva, **fields):
        event = Event(kind=kind, model=f"kiva{kiva}", **fields)
        event.header.stamp = rospy.Time(self.seconds)
        self.callbacks["warehouse/events"](event)

    def status(self, kiva, status=KivaStatus.STATUS_IDLE, seconds=None):
        message = KivaStatus(kiva_id=kiva, status=status)
        message.header.stamp = rospy.Time(self.seconds if seconds is None else seconds)
        self.callbacks[f"kiva{kiva}/status"](message)

    def watch(self, kiva):
        self.executor.watch(kiva)
        self.status(kiva)


def script(kiva, events, steps=2):
    for step in range(steps):
        event = yield command("movx", kiva, distance=step)
        events.append((kiva, event.kind))


def test_nothing_is_commanded_before_the_answers_can_be_heard():
    stage, events = Stage((Event.ACCEPTED, Event.DONE)), []
    stage.connections = 0
    stage.watch(3)
    with pytest.raises(DeadlineError):
        stage.executor.play({3: script(3, events)})
    assert (stage.seconds, events) == (0, [])


def test_commands_follow_each_other():
    stage, events = Stage((Event.ACCEPTED, Event.DONE), (Event.ACCEPTED, Event.BLOCKED)), []
    stage.watch(3)
    stage.executor.play({3: script(3, events)})
    assert events == [(3, Event.DONE), (3, Event.BLOCKED)]
    assert [text for _, _, text in stage.said] == [
        "movx distance 0",
        "DONE",
        "movx distance 1",
        "BLOCKED",
    ]


def test_robots_act_at_once():
    stage, events = Stage(*[(Event.DONE,)] * 4), []
    for kiva in (1, 2):
        stage.watch(kiva)
    stage.executor.play({kiva: script(kiva, events) for kiva in (1, 2)})
    assert [kiva for kiva, _ in events] == [1, 2, 1, 2]


def test_a_refusal_needs_no_new_status():
    stage, events = Stage((Event.REFUSED,)), []
    stage.status = lambda *_: None
    stage.executor.watch(1)
    Stage.status(stage, 1, seconds=0)
    stage.executor.play({1: script(1, events, steps=1)})
    assert events == [(1, Event.REFUSED)]


def test_the_next_command_waits_until_the_robot_may_take_it():
    stage, events = Stage((Event.BLOCKED,)), []
    stage.watch(1)
    stage.status = lambda kiva: Stage.status(stage, kiva, KivaStatus.STATUS_BLOCKED)
    with pytest.raises(DeadlineError, match="waiting: kiva1 for movx distance 0"):
        stage.executor.play({1: script(1, events)})
    assert events == []


def test_an_old_status_does_not_count():
    stage, events = Stage((Event.DONE,)), []
    stage.watch(1)
    stage.status = lambda kiva: Stage.status(stage, kiva, seconds=0)
    with pytest.raises(DeadlineError):
        stage.executor.play({1: script(1, events)})
    assert events == []


def test_nothing_starts_before_the_commands_are_heard():
    stage = Stage()
    stage.watch(1)
    stage.publishers["lift"].listeners = 0
    with pytest.raises(DeadlineError, match="waiting: no robot"):
        stage.executor.play({1: script(1, [])})
    assert stage.said == []


def test_ctrl_c_ends_it():
    stage = Stage()
    stage.stopped = True
    with pytest.raises(Interrupted):
        stage.executor.play({1: script(1, [])})


def test_other_robots_events_are_kept_but_change_nothing():
    stage, events = Stage((Event.DONE,)), []
    stage.watch(1)
    stage.event(Event.DONE, 7)
    stage.executor.play({1: script(1, events, steps=1)})
    assert [event.model for event in stage.executor.events] == ["kiva7", "kiva1"]
    assert events == [(1, Event.DONE)]


def test_what_happens_is_told_with_its_reason():
    stage = Stage()
    stage.seconds = 5
    stage.event(Event.COLLISION, 1, other="person1", text="at 0.2 m/s")
    stage.event(Event.ACCEPTED, 1)
    stage.executor.until(lambda: len(stage.executor.events) == 2)
    assert stage.said == [(5.0, "kiva1", "COLLISION person1 at 0.2 m/s")]


def test_waiting_for_a_condition_has_an_end():
    assert not Stage().executor.until(lambda: False, patience=0)
    assert Stage().executor.until(lambda: True, patience=0)


def test_a_command_reads_well():
    lift = command("lift", 2, status=Lift.CARRY, shelf_id=7)
    assert str(lift) == "lift status 1, shelf_id 7"
    assert lift.message.kiva_id == 2
