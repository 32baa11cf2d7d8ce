#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A node that dies comes back and finds the warehouse as it stands."""

import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from rostest_support.node_test import Robot, call, create, kill, latched, wait_until

from gazebo_msgs.srv import GetModelState, GetPhysicsProperties, GetWorldProperties
from warehouse_msgs.msg import TrackedObjects, WarehouseState

SERVICE = "/warehouse/create_warehouse_models"


def models():
    return call("/gazebo/get_world_properties", GetWorldProperties).model_names


def place(name):
    at = call("/gazebo/get_model_state", GetModelState, name, "").pose.position
    return at.x, at.y, at.z


class BuilderKilledWhileBuilding(unittest.TestCase):
    def test_its_half_warehouse_is_taken_away_and_time_goes_on(self):
        rospy.wait_for_service(SERVICE, 30)
        building = threading.Thread(target=self.build_in_vain)
        building.start()
        wait_until(lambda: rospy.has_param("/warehouse/building"), "the builder at work")
        wait_until(lambda: "storage_unit100" in models(), "half a warehouse")
        kill("/create_warehouse_service_node")
        building.join()
        wait_until(lambda: not rospy.has_param("/warehouse/building"), "who undoes it")
        wait_until(lambda: create("no preset").message, "the service")
        self.assertEqual(sum(name.startswith("storage_unit") for name in models()), 24)
        self.assertFalse(call("/gazebo/get_physics_properties", GetPhysicsProperties).pause)

    def build_in_vain(self):
        with self.assertRaises(rospy.ServiceException):
            # So large that no client is too late.
            create("", robots=100, shelves=20_000, items=80_000)


class Respawn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service(SERVICE, 30)
        Robot(1).do("movy", distance=-1)
        cls.robot = place("kiva1")

    def tearDown(self):
        self.assertEqual(place("kiva1"), self.robot, "the warehouse was built again")

    def test_create_warehouse_service_node(self):
        kill("/create_warehouse_service_node")
        wait_until(self.service_is_that_of_the_new_node, "the service comes back")
        self.assertEqual(place("kiva1"), self.robot)
        answer = create("no preset")
        self.assertFalse(answer.success)
        self.assertIn("no preset", answer.message)

    def service_is_that_of_the_new_node(self):
        try:
            return create("no preset").message
        except (rospy.ServiceException, rospy.ROSException, OSError):
            return False

    def test_create_warehouse_topics(self):
        kill("/create_warehouse_topics")
        state = latched("/warehouse/state", WarehouseState, lambda m: len(m.kivas) == 4)
        self.assertEqual(state.warehouse_name, "small")
        self.assertEqual((state.shelves, state.items, state.belts), (24, 96, 2))

    def test_track_items_node(self):
        kill("/track_items_node")
        listed = latched("/items", TrackedObjects, lambda m: len(m.objects) == 96)
        for tracked in (listed.objects[0], listed.objects[-1]):
            alone = latched(f"/items/{tracked.name}/pose", PoseStamped)
            self.assertEqual(alone.pose, tracked.pose)

    def test_track_storage_units_node(self):
        kill("/track_storage_units_node")
        listed = latched("/storage_units", TrackedObjects, lambda m: len(m.objects) == 24)
        at = listed.objects[5].pose.position
        self.assertEqual((at.x, at.y, at.z), place("storage_unit6"))
        latched("/storage_units/storage_unit6/pose", PoseStamped)


if __name__ == "__main__":
    rospy.init_node("test_respawn")
    rostest.rosrun("warehouse_tests", "respawn", __name__)
