# SPDX-License-Identifier: Apache-2.0
"""Commands over topics and services are noted with the node that sent them."""

import json

import pytest
from fake_ros import FakeRos

from warehouse_client.heard_commands import hear, hear_calls
from warehouse_msgs.msg import Command
from warehouse_viewer.api.command_log import CommandLog
from warehouse_viewer.ros.heard_commands import CommandNotes

STOP = "kiva_id: 1\nstop: 1\n"


@pytest.fixture
def log():
    return CommandLog(lambda: 7.5)


@pytest.fixture
def hears(log):
    ros = FakeRos()
    hear(ros, CommandNotes(ros, log).note)
    assert list(ros.callbacks) == ["warehouse/commands"]  # the world alone hears commands
    return ros.callbacks["warehouse/commands"]


def test_a_command_has_the_name_of_the_node_that_sent_it(hears, log):
    hears(Command("/mov", "/rostopic_4711", "kiva_id: 3\nx: 2.0\ny: 1.0\n"))
    hears(Command("/stop", "/planner", STOP))
    first, second = log.rows()
    assert (first["by"], first["method"], first["path"]) == ("/rostopic_4711", "TOPIC", "/mov")
    assert json.loads(first["body"]) == {"kiva_id": 3, "x": 2.0, "y": 1.0}
    assert (first["status"], first["time"], second["by"]) == (0, 7.5, "/planner")
    assert "/rostopic_4711,,TOPIC,/mov" in log.csv()


def test_the_viewers_own_and_the_coordinators_are_not_noted(hears, log):
    for node in ("/viewer", "/coordinator"):
        hears(Command("/stop", node, STOP))
    assert log.rows() == []


@pytest.mark.parametrize("fields", ["[", "a word", "- 1", "kiva_id: {"])
def test_what_has_no_fields_is_no_command(hears, log, fields):
    hears(Command("/stop", "/someone", fields))
    assert log.rows() == []


def test_any_value_of_a_field_is_noted(hears, log):
    hears(Command("/stop", "/someone", "kiva_id: 2026-11-27"))
    assert json.loads(log.rows()[0]["body"]) == {"kiva_id": "2026-11-27"}


@pytest.fixture
def hears_calls(log):
    ros = FakeRos()
    hear_calls(ros, CommandNotes(ros, log).note_call)
    assert list(ros.callbacks) == ["warehouse/service_calls"]
    return ros.callbacks["warehouse/service_calls"]


def test_a_call_of_a_service_has_the_name_of_the_node_that_called(hears_calls, log):
    hears_calls(Command("/warehouse/tow", "/desk", "kiva_id: 3\n"))
    (row,) = log.rows()
    assert (row["by"], row["method"], row["path"]) == ("/desk", "SERVICE", "/warehouse/tow")
    assert json.loads(row["body"]) == {"kiva_id": 3}


def test_a_caller_that_does_not_say_its_name_is_a_ros_service(hears_calls, log):
    hears_calls(Command("/warehouse/tow", "", "{}\n"))
    assert log.rows()[0]["by"] == "a ROS service"


def test_calls_by_the_viewer_the_shift_and_the_coordinator_are_not_noted(hears_calls, log):
    for node in ("/viewer", "/operations", "/coordinator", "/create_warehouse_service_node"):
        hears_calls(Command("/warehouse/transport", node, "kiva_id: 1\n"))
    assert log.rows() == []


def test_of_what_a_program_calls_in_a_loop_one_call_a_second_is_noted(log):
    now, ros = [100.0], FakeRos()
    hear_calls(ros, CommandNotes(ros, log, lambda: now[0]).note_call)
    hears = ros.callbacks["warehouse/service_calls"]
    for _ in range(25):
        hears(Command("/gazebo/step", "/learner", "steps: 1\n"))
        now[0] += 0.1
    hears(Command("/gazebo/step", "/other", "steps: 1\n"))
    assert [row["by"] for row in log.rows()].count("/learner") == 3
    assert [row["by"] for row in log.rows()].count("/other") == 1


def test_each_call_of_another_service_is_noted(hears_calls, log):
    for robot in (1, 2, 3):
        hears_calls(Command("/warehouse/fail", "/desk", f"kiva_id: {robot}\n"))
    assert len(log.rows()) == 3
