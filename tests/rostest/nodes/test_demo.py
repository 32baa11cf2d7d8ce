#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The demonstration comes true, and says so if it does not."""

import unittest

import rospy
import rostest
from rostest_support.node_test import create, run


class Demonstration(unittest.TestCase):
    def setUp(self):
        self.assertTrue(create("small").success)

    def test_it_comes_true(self):
        code, text = run("demo", "_delivery:=40")
        self.assertEqual(code, 0, text)
        self.assertEqual(text.count("  ok  "), 17, text)
        for word in ("LIFTED", "DROPPED", "BLOCKED", "collisions", "20 robots were coordinated"):
            self.assertIn(word, text)

    def test_too_late_is_a_failure(self):
        code, text = run("demo", "_deadline:=1")
        self.assertEqual(code, 1, text)
        # Some robot, or none: it may be too late before the first command is sent.
        self.assertRegex(text, "demo: FAILED: out of time; waiting: (kiva|no robot)")

    def test_without_two_robots_there_is_nothing_to_play(self):
        create(robots=1, shelves=4)
        code, text = run("demo")
        self.assertEqual(code, 1, text)
        self.assertIn("no two robots can fetch", text)


if __name__ == "__main__":
    rospy.init_node("test_demo")
    rostest.rosrun("warehouse_tests", "demonstration", Demonstration)
