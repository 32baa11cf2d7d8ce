#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The service builds warehouses, and refuses what it can not build."""

import unittest

import rospy
import rostest
from rostest_support.node_test import call, create, latched
from std_srvs.srv import Empty

from gazebo_msgs.srv import GetModelState, GetPhysicsProperties, GetWorldProperties
from warehouse_client.routes import point
from warehouse_layout.models.models import KINDS, kind_and_number
from warehouse_msgs.msg import WarehouseObjects


def standing():
    return call("/gazebo/get_world_properties", GetWorldProperties).model_names


def counts():
    kinds = [kind_and_number(name)[0] for name in standing()]
    return [kinds.count(kind) for kind in KINDS]


def paused():
    return call("/gazebo/get_physics_properties", GetPhysicsProperties).pause


class CreateWarehouse(unittest.TestCase):
    def test_preset(self):
        answer = create("small", warehouse_id=5)
        self.assertTrue(answer.success, answer.message)
        self.assertIn("4 robots, 24 storage units, 96 items, 2 conveyor belts", answer.message)
        self.assertEqual(counts(), [4, 24, 96, 2])
        self.assertEqual(rospy.get_param("/warehouse/name"), "small")
        self.assertEqual(rospy.get_param("/warehouse/id"), 5)

    def test_items_lie_on_their_units(self):
        create(shelves=3, items=20)
        built = latched("/warehouse/objects", WarehouseObjects, lambda m: len(m.items) == 20)
        self.assertEqual(sorted(built.item_unit), sorted(i % 3 for i in range(20)))

    def test_robots_stand_on_the_grid(self):
        create("small")
        for number in range(1, 5):
            at = call("/gazebo/get_model_state", GetModelState, f"kiva{number}", "").pose.position
            self.assertEqual((at.x, at.y), point((at.x, at.y)))

    def test_replaces_what_stands(self):
        create("medium")
        answer = create("mine", robots=2, items=7, shelves=3)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(counts(), [2, 3, 7, 1])
        self.assertEqual(standing().count("ground_plane"), 1)

    def test_refused_requests_change_nothing(self):
        create("small")
        before = sorted(standing())
        for request in (
            {"name": "no preset"},
            {"robots": -1},
            {"robots": 1, "items": 3},
            {"robots": 1_000_000},
        ):
            answer = create(**request)
            self.assertFalse(answer.success, request)
            self.assertTrue(answer.message)
        self.assertEqual(sorted(standing()), before)
        self.assertEqual(rospy.get_param("/warehouse/name"), "small")

    def test_physics_goes_on_or_stays_paused_as_before(self):
        create("small")
        self.assertFalse(paused())
        call("/gazebo/pause_physics", Empty)
        self.addCleanup(call, "/gazebo/unpause_physics", Empty)
        create("small")
        self.assertTrue(paused())

    def test_answer_is_stamped(self):
        self.assertGreater(create("empty").header.stamp, rospy.Time(0))


if __name__ == "__main__":
    rospy.init_node("test_create_warehouse")
    rostest.rosrun("warehouse_tests", "create_warehouse", CreateWarehouse)
