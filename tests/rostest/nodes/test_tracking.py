#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Poses of storage units and items follow their robots."""

import math
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from rostest_support.node_test import Listener, Robot, call, create, latched, wait_until

from gazebo_msgs.srv import DeleteModel
from warehouse_layout.file.request import resolve
from warehouse_layout.floor import poses
from warehouse_layout.generate.generated import plan
from warehouse_msgs.msg import Lift, TrackedObjects


def named(message, name):
    return next((o for o in message.objects if o.name == name), None)


def topics(prefix):
    return {t for t, _ in rosgraph.Master("/test").getPublishedTopics("") if t.startswith(prefix)}


def place(pose):
    return pose.position.x, pose.position.y, pose.position.z


def flat(pose):
    turn = pose.orientation
    return [*place(pose), turn.x, turn.y, turn.z, turn.w]


class Tracking(unittest.TestCase):
    def setUp(self):
        self.assertTrue(create(robots=1, shelves=2, items=6).success)
        at = [tuple(p) for p in plan(resolve("", robots=1, shelves=2, items=6)).units]
        self.units = latched(
            "/storage_units", TrackedObjects, lambda m: [place(o.pose)[:2] for o in m.objects] == at
        )
        self.items = latched(
            "/items", TrackedObjects, lambda m: [o.carrier for o in m.objects] == [""] * 6
        )

    def carry(self, unit, x, y):
        """Takes a storage unit that far; returns where it stood."""
        at = place(named(self.units, f"storage_unit{unit}").pose)
        robot = Robot(1)
        robot.do("mov", x=at[0], y=at[1])
        robot.do("lift", status=Lift.CARRY, shelf_id=unit)
        robot.do("mov", x=at[0] + x, y=at[1] + y)
        return at

    def test_all_of_them_are_there(self):
        self.assertEqual([o.name for o in self.units.objects], ["storage_unit1", "storage_unit2"])
        self.assertEqual({o.storage_unit for o in self.items.objects[::2]}, {"storage_unit1"})
        self.assertEqual({o.carrier for o in self.items.objects}, {""})
        for item in self.items.objects:
            unit = named(self.units, item.storage_unit)
            self.assertLess(math.dist(place(item.pose)[:2], place(unit.pose)[:2]), 0.4)
        for prefix, message in (("/storage_units", self.units), ("/items", self.items)):
            self.assertEqual(message.header.frame_id, "world")
            for tracked in message.objects:
                alone = latched(f"{prefix}/{tracked.name}/pose", PoseStamped)
                self.assertEqual(alone.pose, tracked.pose)
                self.assertEqual(alone.header.frame_id, "world")

    def test_unit_and_items_go_where_the_robot_goes(self):
        resting = Listener("/storage_units/storage_unit2/pose", PoseStamped)
        resting.until()
        x, y, _ = self.carry(1, x=0, y=-1)
        moved = latched(
            "/storage_units/storage_unit1/pose",
            PoseStamped,
            lambda m: abs(m.pose.position.y - (y - 1)) < 0.01,
        )
        self.assertAlmostEqual(moved.pose.position.x, x, delta=0.01)
        self.assertGreater(moved.pose.position.z, 0.05)
        carried = latched(
            "/storage_units",
            TrackedObjects,
            lambda m: named(m, "storage_unit1").pose == moved.pose,
        )
        self.assertEqual([o.carrier for o in carried.objects], ["kiva1", ""])
        self.assertEqual(len(resting.messages), 1, "a unit that stands needs no news")

    def test_items_keep_their_place_in_the_unit(self):
        before = self.places_in_unit(self.units, self.items)
        units, items = (Listener(t, TrackedObjects) for t in ("/storage_units", "/items"))
        self.carry(1, x=0, y=-1)
        items.until(lambda m: m.objects[0].carrier == "kiva1")

        def same():
            now = self.places_in_unit(units.messages[-1], items.messages[-1])
            return abs(now - before).max() < 1e-6

        wait_until(same, "items lie in the unit as they did")

    def places_in_unit(self, units, items):
        """Poses of its items in the frame of storage_unit1."""
        on_it = [o for o in items.objects if o.storage_unit == "storage_unit1"]
        rows = poses.rows([flat(o.pose) for o in on_it])
        frame = poses.rows(flat(named(units, "storage_unit1").pose))
        return poses.compose(poses.inverse(frame).repeat(len(rows), 0), rows)

    def test_topics_go_with_their_objects(self):
        self.assertIn("/items/item1/pose", topics("/items"))
        call("/gazebo/delete_model", DeleteModel, "storage_unit1")
        latched("/items", TrackedObjects, lambda m: len(m.objects) == 3)
        latched("/storage_units", TrackedObjects, lambda m: len(m.objects) == 1)
        expected = {f"/items/item{i}/pose" for i in (2, 4, 6)} | {"/items"}
        wait_until(lambda: topics("/items") == expected, "topics of deleted items go")
        wait_until(
            lambda: "/storage_units/storage_unit1/pose" not in topics("/storage_units"),
            "topics of deleted units go",
        )
        self.assertIn("/storage_units/storage_unit2/pose", topics("/storage_units"))

    def test_an_empty_warehouse_has_empty_lists(self):
        create("empty")
        latched("/items", TrackedObjects, lambda m: not m.objects)
        latched("/storage_units", TrackedObjects, lambda m: not m.objects)


if __name__ == "__main__":
    rospy.init_node("test_tracking")
    rostest.rosrun("warehouse_tests", "tracking", Tracking)
