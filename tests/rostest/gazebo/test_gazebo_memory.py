#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A thousand models come and go, and leave the memory where it was."""

import os
import pathlib
import unittest

import rosgraph
import rospy
import rostest
from rostest_support.warehouse_test import BOX, pose, world

from gazebo_msgs.srv import DeleteModel, SpawnModel

ROUNDS = 1000
TOLERANCE = 4000  # [kB]: what an allocator may keep
ROVER = (pathlib.Path(__file__).parents[2] / "worlds" / "rover.urdf").read_text()


def memory_of_the_world():
    """Resident memory of the node [kB]."""
    uri = rosgraph.Master("/test").lookupNode("/gazebo")
    _, _, pid = rospy.core.xmlrpcapi(uri).getPid("/test")
    with open(f"/proc/{pid}/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


class Memory(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("/gazebo/spawn_sdf_model", 30)
        self.spawn = rospy.ServiceProxy("/gazebo/spawn_sdf_model", SpawnModel, persistent=True)
        self.delete = rospy.ServiceProxy("/gazebo/delete_model", DeleteModel, persistent=True)

    def come_and_go(self, xml, rounds):
        for i in range(rounds):
            answer = self.spawn(f"m{i}", xml, "/", pose(i % 20, 3.0), "")
            self.assertTrue(answer.success, answer.status_message)
            self.assertTrue(self.delete(f"m{i}").success)

    def memory_grows_by(self, xml, rounds):
        self.come_and_go(xml, rounds // 4)
        before = memory_of_the_world()
        self.come_and_go(xml, rounds)
        self.assertNotIn("m0", world().model_names)
        return memory_of_the_world() - before

    def test_of_bodies(self):
        moving = BOX.replace("<static>true</static>", "")
        self.assertLess(self.memory_grows_by(moving, ROUNDS), TOLERANCE)

    def test_of_texts_that_all_differ(self):
        def texts(first, number):
            for i in range(first, first + number):
                self.come_and_go(BOX.replace("0.2 0.2 0.2", f"0.2 0.2 {0.1 + i * 1e-4:.5f}"), 1)

        texts(0, 400)  # more than are kept for the next time
        before = memory_of_the_world()
        texts(400, ROUNDS)
        self.assertLess(memory_of_the_world() - before, 2 * TOLERANCE)

    def test_of_robots_with_plugins(self):
        self.assertLess(self.memory_grows_by(ROVER, 100), 2 * TOLERANCE)


if __name__ == "__main__":
    rospy.init_node("test_gazebo_memory")
    rostest.rosrun("warehouse_tests", "gazebo_memory", __name__)
