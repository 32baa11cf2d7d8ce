# SPDX-License-Identifier: Apache-2.0
"""Page, API and events have one word for one thing."""

import inspect
import json
import subprocess
from typing import get_args

import pytest
from paths import ROOT

from warehouse_client import message_names
from warehouse_fleet.transports.waiting import Waiting
from warehouse_layout.message_enums import EventKind, State, Status
from warehouse_msgs.msg import CoordinatorState, FleetState, KivaStatus
from warehouse_viewer.api.schemas.fleet import RobotsByWork
from warehouse_viewer.api.schemas.models import Robot
from warehouse_viewer.api.schemas.operations import STATES
from warehouse_viewer.api.schemas.pydantic_versions import names_of
from warehouse_viewer.page.activities import (
    IN_QUEUE,
    Activity,
    activity,
    shown_status,
    wait_too_long,
)

WEB = ROOT / "src/warehouse_viewer/web/js/base/words.js"
IDLE, BUSY = KivaStatus.STATUS_IDLE, KivaStatus.STATUS_BUSY


def page():
    """What words.js has."""
    script = (
        f"import * as words from {json.dumps(WEB.as_uri())}; console.log(JSON.stringify(words))"
    )
    command = ["node", "--input-type=module", "--eval", script]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def named(text):
    """The name of a constant that the page shows as that text."""
    return text.replace(" ", "_").upper()


def test_the_page_has_the_words_of_the_api():
    words = page()
    assert [named(does) for does in words["ACTIVITY"]] == [does.name for does in Activity]
    assert words["NEEDS_HELP"] == Activity.NEEDS_HELP
    assert len(words["STATE"]) == len(message_names.STATE)
    assert words["FAILURE"] == list(message_names.FAILURES.values())
    assert words["WORK"] == list(message_names.WORK)
    assert set(words["TROUBLE"]) < set(message_names.EVENT.values())
    assert tuple(words["ORDER_STATES"]) == STATES


def test_the_api_has_the_words_of_the_messages():
    assert set(names_of(RobotsByWork)) == set(message_names.WORK)
    assert set(message_names.WORK) <= set(CoordinatorState.__slots__)
    allowed = get_args(Robot.__annotations__["activity"])
    assert allowed == tuple(does.name for does in Activity)


def fleet(status=IDLE, state=State.IDLE, load=0, ended=0, failures=0):
    """A FleetState of one robot."""
    fields = {"status": [status], "state": [state], "last_end": [ended], "failures": [failures]}
    return FleetState(kiva_id=[1], shelf_id=[load], **fields)


@pytest.mark.parametrize(
    ("robot", "does"),
    [
        ({}, Activity.RESTING),
        ({"load": 6}, Activity.WORKING),
        ({"status": BUSY, "state": State.LIFTING}, Activity.WORKING),
        ({"status": BUSY, "state": State.MOVING_X}, Activity.MOVING),
        ({"status": BUSY, "state": State.WAITING, "load": 6}, Activity.MOVING),
        ({"status": BUSY, "state": State.BLOCKED}, Activity.WAITING),
        ({"ended": EventKind.BLOCKED, "load": 6}, Activity.NEEDS_HELP),
        ({"status": BUSY, "state": State.MOVING_X, "failures": 4}, Activity.NEEDS_HELP),
    ],
)
def test_a_robot_does_one_of_five_things(robot, does):
    assert activity(fleet(**robot)).tolist() == [does]


def test_robots_that_wait_for_long_are_told_apart():
    turns = fleet(BUSY, State.WAITING)
    assert activity(turns, [2]).tolist() == [Activity.MOVING]
    assert activity(turns, [1, 2]).tolist() == [Activity.WAITING]


def test_only_those_that_wait_for_half_a_minute_wait_too_long():
    state = CoordinatorState(waiting_kiva=[1, 2], waiting_since=[100.0, 69.0])
    state.header.stamp.secs = 100
    assert wait_too_long(state) == [2]
    assert wait_too_long(None) == []


def test_robots_in_a_queue_that_moves_do_not_wait_too_long():
    texts = [
        "in the queue of pick1 behind kiva4",
        "behind kiva5",
        "in the queue of pick2 behind kiva6",
    ]
    state = CoordinatorState(
        waiting_kiva=[1, 2, 3], waiting_since=[920.0, 920.0, 880.0], waiting_text=texts
    )
    state.header.stamp.secs = 1000
    assert wait_too_long(state) == [2, 3]
    assert f'f"{IN_QUEUE}{{station}}' in inspect.getsource(Waiting)  # the coordinator's words


def test_a_command_that_ended_blocked_shows_in_the_status():
    assert shown_status(fleet(ended=EventKind.BLOCKED)).tolist() == [Status.BLOCKED]
    assert shown_status(fleet(ended=EventKind.DONE)).tolist() == [IDLE]
