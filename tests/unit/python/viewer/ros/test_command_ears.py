# SPDX-License-Identifier: Apache-2.0
"""Commands over topics are noted with the node that sent them."""

import json

import pytest
from fake_ros import FakeRos

from warehouse_msgs.msg import MoveTo, Stop
from warehouse_viewer.api.command_log import CommandLog
from warehouse_viewer.ros.command_ears import CommandEars


def by(node, message):
    message._connection_header = {"callerid": node}
    return message


@pytest.fixture
def log():
    return CommandLog(lambda: 7.5)


@pytest.fixture
def ros(log):
    out = FakeRos()
    ears = CommandEars(out, log)
    assert out.callbacks == {}  # the world is not there yet
    ears.begin()
    ears.begin()
    return out


def test_a_command_has_the_name_of_the_node_that_sent_it(ros, log):
    ros.callbacks["mov"](by("/rostopic_4711", MoveTo(kiva_id=3, x=2.0, y=1.0)))
    ros.callbacks["stop"](by("/planner", Stop(kiva_id=1)))
    first, second = log.rows()
    assert (first["by"], first["method"], first["path"]) == ("/rostopic_4711", "TOPIC", "/mov")
    assert json.loads(first["body"]) == {"kiva_id": 3, "x": 2.0, "y": 1.0}
    assert (first["status"], first["time"], second["by"]) == (0, 7.5, "/planner")
    assert "/rostopic_4711,,TOPIC,/mov" in log.csv()


def test_the_viewers_own_and_the_coordinators_are_not_noted(ros, log):
    for node in ("/viewer", "/coordinator"):
        ros.callbacks["stop"](by(node, Stop(kiva_id=1)))
    assert log.rows() == []
    assert "warehouse/follow" not in ros.callbacks
