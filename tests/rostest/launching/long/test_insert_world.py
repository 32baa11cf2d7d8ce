#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A world file is added to the world that runs: all of it, or nothing."""

import tempfile
import unittest

import rospkg
import rospy
import rostest
from rostest_support.node_test import call, create, run
from rostest_support.warehouse_test import delete

from gazebo_msgs.srv import GetWorldProperties


def standing():
    return sorted(call("/gazebo/get_world_properties", GetWorldProperties).model_names)


class InsertWorld(unittest.TestCase):
    def setUp(self):
        for name in set(standing()) - {"ground_plane"}:
            delete(name)
        self.assertTrue(create("empty").success)

    def test_all_of_it(self):
        code, text = run("insert_world", "paper")
        self.assertEqual(code, 0, text)
        self.assertIn("added 12 models", text)
        for name in ("kiva2", "storage_unit3", "item5", "conveyor_belt2"):
            self.assertIn(name, standing())
        self.assertEqual(standing().count("ground_plane"), 1)

    def test_or_nothing(self):
        self.assertEqual(run("insert_world", "obstacles")[0], 0)
        before = standing()
        code, text = run("insert_world", "obstacles")
        self.assertNotEqual(code, 0)
        self.assertIn("already: person1, wall1, wall2", text)
        self.assertEqual(standing(), before)

    def test_nothing_where_something_stands(self):
        self.assertEqual(run("insert_world", "paper")[0], 0)
        before = standing()
        code, text = run("insert_world", "paper")
        self.assertEqual(code, 3)
        self.assertRegex(text, r"nothing was added: \w+ would stand in \w+; .* at:=X,Y")
        self.assertEqual(standing(), before)
        code, text = run("insert_world", "paper", "at:=40,0", "yaw:=1.5")
        self.assertEqual(code, 0, text)
        self.assertIn("kiva3", standing())

    def test_what_was_saved_is_inserted_again(self):
        self.assertEqual(run("insert_world", "paper")[0], 0)
        folder = tempfile.mkdtemp()
        file = f"{folder}/mine.sdf"
        code, text = run("save_world", file)
        self.assertEqual(code, 0, text)
        self.assertIn("saved 13 models", text)
        code, text = run("save_world", file)
        self.assertEqual(code, 3, text)
        self.assertIn("--replace", text)
        before = standing()
        code, text = run("insert_world", file, "at:=40,0")
        self.assertEqual(code, 0, text)
        self.assertEqual(len(standing()), 2 * len(before) - 1)  # the floor is the same
        code, text = run("save_world", f"{folder}/mine.txt")
        self.assertEqual(code, 2, text)
        self.assertIn("NAME.sdf was expected", text)

    def test_wrong_places_are_refused(self):
        for place in ("at:=1", "at:=nan,0", "yaw:=north"):
            code, text = run("insert_world", "paper", place)
            self.assertEqual(code, 1, text)
            self.assertIn(place, text)

    def test_beside_a_warehouse_it_takes_free_numbers(self):
        create("small")
        code, text = run("insert_world", "obstacles")
        self.assertEqual(code, 0, text)
        self.assertIn("kiva1 as kiva7", text)
        self.assertIn("storage_unit1 as storage_unit25", text)
        for name in ("kiva1", "kiva5", "kiva10", "storage_unit25", "person1"):
            self.assertIn(name, standing())

    def test_with_a_box_in_place_of_what_is_missing(self):
        folder = rospkg.RosPack().get_path("warehouse_tests")
        code, text = run("insert_world", folder + "/worlds/invalid_include_missing.sdf")
        self.assertEqual(code, 0, text)
        self.assertIn("added 2 models ", text)
        self.assertLessEqual({"nowhere", "other"}, set(standing()))

    def test_no_such_world(self):
        code, text = run("insert_world", "mars")
        self.assertNotEqual(code, 0)
        self.assertIn("there is no world 'mars'", text)


if __name__ == "__main__":
    rospy.init_node("test_insert_world")
    rostest.rosrun("warehouse_tests", "insert_world", InsertWorld)
