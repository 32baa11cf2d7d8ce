#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""One topic tells what stands in the warehouse and what it does."""

import unittest

import numpy as np
import rospy
import rostest
import yaml
from rosgraph_msgs.msg import Clock
from rostest_support.node_test import Listener, Robot, call, create, latched, wait_until
from std_srvs.srv import Empty

from warehouse_msgs.msg import Command, KivaStatus, Lift, Station, WarehouseState
from warehouse_sim.state import COMMANDS

TOPIC = "/warehouse/state"


class State(unittest.TestCase):
    def setUp(self):
        self.assertTrue(create("mine", warehouse_id=3, robots=2, shelves=4, items=9).success)
        self.state = latched(TOPIC, WarehouseState, self.is_mine)

    def is_mine(self, state):
        free = {unit.carrier for unit in state.storage_units} == {""}
        all_told = state.robots == len(state.kivas) == 2  # statuses may come before the counts
        return state.warehouse_name == "mine" and all_told and free

    def test_name_counts_and_units(self):
        state = self.state
        self.assertEqual((state.warehouse_id, state.robots, state.shelves), (3, 2, 4))
        self.assertEqual((state.items, state.belts), (9, 1))
        names = [unit.name for unit in state.storage_units]
        self.assertEqual(names, [f"storage_unit{i}" for i in range(1, 5)])
        self.assertEqual([k.kiva_id for k in state.kivas], [1, 2])
        self.assertEqual({k.status for k in state.kivas}, {KivaStatus.STATUS_IDLE})

    def test_stations_with_their_lanes_and_storage_places(self):
        state = latched(TOPIC, WarehouseState, lambda m: self.is_mine(m) and m.stations)
        pick, replenish = state.stations
        self.assertEqual((pick.name, pick.kind, pick.belt), ("pick1", "PICK", "conveyor_belt1"))
        self.assertEqual((replenish.name, replenish.kind), ("replenish1", Station.REPLENISH))
        for lane in (pick, replenish):
            steps = np.abs(np.diff([lane.x, lane.y])).sum(axis=0)
            self.assertTrue((steps == 1).all() and 5 <= lane.service < len(lane.x) - 1)
        places = set(zip(state.place_x, state.place_y))
        self.assertEqual(len(places), 5)  # of which 85 % are filled
        for unit in state.storage_units:
            self.assertIn((unit.pose.position.x, unit.pose.position.y), places)

    def test_a_call_that_builds_is_told_with_its_caller(self):
        calls = Listener("/warehouse/service_calls", Command)
        self.addCleanup(calls.close)
        wait_until(lambda: calls.connections() > 1, "the world and the node that builds")
        create("mine", warehouse_id=3, robots=2, shelves=4, items=9)
        builds = lambda: [c for c in calls.messages if c.topic.endswith("create_warehouse_models")]  # noqa: E731
        wait_until(builds, "the call that builds")
        (command,) = builds()
        self.assertEqual(command.sender, rospy.get_name())
        self.assertEqual(yaml.safe_load(command.fields)["warehouse_name"], "mine")

    def test_once_a_second_of_simulated_time(self):
        states = Listener(TOPIC, WarehouseState)
        states.until(lambda _: len(states.messages) >= 6)
        stamps = [m.header.stamp.to_sec() for m in states.messages]
        # The first may be the latched one; a glance is as old as the fleet's last report.
        for earlier, later in zip(stamps[1:], stamps[2:]):
            self.assertAlmostEqual(later - earlier, 1.0, delta=0.25)

    def test_it_follows_a_robot_with_its_load(self):
        at = self.state.storage_units[0].pose.position
        robot = Robot(1)
        robot.do("mov", x=at.x, y=at.y)
        robot.do("lift", status=Lift.CARRY, shelf_id=1)
        state = latched(TOPIC, WarehouseState, lambda m: m.storage_units[0].carrier)
        self.assertEqual(state.storage_units[0].carrier, "kiva1")
        self.assertEqual(state.kivas[0].shelf_id, 1)
        self.assertAlmostEqual(state.kivas[0].pose.x, at.x, delta=0.01)

    def test_news_come_while_physics_stands_still(self):
        call("/gazebo/pause_physics", Empty)
        self.addCleanup(call, "/gazebo/unpause_physics", Empty)
        states = Listener(TOPIC, WarehouseState)
        create("other", robots=1)
        # Robots and units are told on topics of their own, so one may be known before the other.
        new = ("other", 1, 0, 0)
        states.until(lambda m: (m.warehouse_name, m.robots, m.shelves, m.items) == new)

    def test_command_topics_are_known(self):
        latched("/clock", Clock)
        known = dict(rospy.get_published_topics())
        for topic, kind in COMMANDS.items():
            self.assertEqual(known.get(f"/{topic}"), kind._type)


if __name__ == "__main__":
    rospy.init_node("test_warehouse_state")
    rostest.rosrun("warehouse_tests", "warehouse_state", State)
