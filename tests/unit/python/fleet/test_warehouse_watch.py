# SPDX-License-Identifier: Apache-2.0
"""What the coordinator keeps of the messages of a warehouse."""

from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from fake_ros import FakeRos

from warehouse_fleet.hosts import warehouse_watch
from warehouse_fleet.hosts.coordinator_messages import _alarms
from warehouse_fleet.hosts.warehouse_watch import REPEATED, WarehouseWatch
from warehouse_fleet.robots.robot_table import RobotTable
from warehouse_msgs.msg import Event, Look, Scenery

NO = "orderError: 'the brake is on'"


@pytest.fixture
def ros(monkeypatch):
    ros = FakeRos()
    monkeypatch.setattr(warehouse_watch, "rospy", ros)
    return ros


@pytest.fixture
def watch(ros):
    watch = WarehouseWatch()
    refusal = Event(kind=Event.REFUSED, model="kiva3", text=NO)
    refusal.header.stamp = rospy.Time(100)
    ros.callbacks["warehouse/events"](refusal)
    return watch


def test_what_a_robot_refused_is_known_while_it_is_asked_again(watch):
    assert watch.refusals(100.0 + REPEATED - 1) == {"kiva3": NO}
    assert watch.refusals(100.0 + REPEATED) == {}
    assert watch.refusals(99.0) == {}  # the world was restored
    assert watch.take_refused() == ["kiva3"] and watch.take_refused() == []


def test_the_alarm_of_a_robot_that_refuses_has_its_words(watch):
    robots = RobotTable(np.array([3, 4]))
    robots.stalled[:] = True
    assert [*_alarms(SimpleNamespace(robots=robots), {}, watch.refusals(110.0))] == [
        f"kiva3 does not move: it refuses what it is sent ({NO})",
        "kiva4 does not move",
    ]


def test_a_floor_that_changes_while_time_stands_still_is_news_and_a_box_is_not(ros, watch):
    def came(*models):
        looks = dict.fromkeys(("kiva_look", "storage_unit_look", "item_look"), -1)
        poses = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0] * len(models)
        fields = {"looks": [Look()], "model_look": [0] * len(models), "pose": poses}
        scenery = Scenery(models=models, grid_spacing=1.0, **fields, **looks)
        ros.callbacks["warehouse/scenery"](scenery)
        return watch.news.wait(0)

    assert not came(), "it begins without: there is no other floor before the first"
    assert came("conveyor_belt1")
    assert not came("conveyor_belt1", "box")
    assert came("conveyor_belt1", "box", "conveyor_belt2")
