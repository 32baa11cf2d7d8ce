# SPDX-License-Identifier: Apache-2.0
"""When the coordinator begins to drive a warehouse: its messages come one after the other."""

import pytest
import rospy
from fake_ros import FakeRos, fleet_state

from warehouse_fleet.hosts.coordinator import CoordinatorNode
from warehouse_fleet.robots.robot_table import reports_of
from warehouse_msgs.msg import Scenery, UnitStates, WarehouseObjects


class Coordinator(CoordinatorNode):
    """Notes with which units it begins."""

    def _begin(self, reports, units, _time):
        self._ids, self._plan_of = reports["kiva_id"].copy(), self._watch.scenery
        self.begun_with = units.shelf_id.tolist()


class World:
    """Sends what a world sends."""

    def __init__(self, ros):
        self._hear = ros.callbacks
        self.coordinator = Coordinator()

    def send_objects(self, revision, *units):
        names = [f"storage_unit{unit}" for unit in units]
        objects = WarehouseObjects(revision=revision, storage_units=names)
        self._hear["warehouse/objects"](objects)

    def send_poses(self, revision, units):
        self._hear["warehouse/unit_states"](
            UnitStates(timeline=1, revision=revision, carrier=[0] * units, pose=[0.0] * 7 * units)
        )

    def report(self, *robots):
        """The robots report; returns the units with which the coordinator begins, or None."""
        self.coordinator.begun_with = None
        reports = reports_of(fleet_state(timeline=1, kiva_id=[*robots]))
        self.coordinator._ensure_controller(reports, time=0.0, timeline=1)
        return self.coordinator.begun_with


@pytest.fixture
def world(monkeypatch):
    ros = FakeRos()
    for name in ("Publisher", "Subscriber", "get_param"):
        monkeypatch.setattr(rospy, name, getattr(ros, name))
    for name in ("Service", "ServiceProxy"):
        monkeypatch.setattr(rospy, name, lambda *_, **__: None)
    world = World(ros)
    looks = dict.fromkeys(("kiva_look", "storage_unit_look", "item_look"), -1)
    ros.callbacks["warehouse/scenery"](Scenery(grid_spacing=1.0, **looks))
    return world


def test_it_begins_once_it_knows_the_units(world):
    world.send_objects(1, 7, 8)
    assert world.report(1) is None
    world.send_poses(1, 2)
    assert world.report(1) == [7, 8]


def test_it_begins_anew_with_another_robot_and_all_units(world):
    world.send_objects(1, 7)
    world.send_poses(1, 1)
    assert world.report(1) == [7]
    world.coordinator.controller = object()
    world.send_poses(2, 1)
    assert world.report(1, 2) is None, "the objects of that revision are on their way"
    world.send_objects(2, 7)
    assert world.report(1, 2) == [7]
