#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The launch file refuses wrong arguments, and a second warehouse at the same master."""

import os
import socket
import subprocess
import unittest
from pathlib import Path

import rospy
import rostest
from node_test import PATIENCE, Robot
from warehouse_test import world

WORLDS = Path(__file__).resolve().parent.parent / "worlds"


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def launch(*args):
    """(exit code, what it prints) of a roslaunch of the warehouse, one that ends by itself."""
    done = subprocess.run(
        ["roslaunch", "warehouse_sim", "warehouse.launch", "viewer:=false", *args],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=3 * PATIENCE,
        check=False,
    )
    return done.returncode, done.stdout


class Launching(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/warehouse/create_warehouse_models", PATIENCE)

    def refused(self, *args):
        """What it says where nothing is started."""
        code, said = launch(*args)
        self.assertEqual(code, 1, said)
        self.assertNotIn("Traceback", said)
        self.assertNotIn("started with pid", said)
        return said

    def test_a_second_one_at_the_same_master_leaves_the_first_alone(self):
        said = self.refused("size:=medium", "rtf:=1")
        self.assertIn(f"a warehouse (small) runs at {os.environ['ROS_MASTER_URI']} already", said)
        self.assertIn("ROS_MASTER_URI=http://localhost:11312", said)
        self.assertEqual(rospy.get_param("/warehouse/name"), "small")
        self.assertEqual(rospy.get_param("/gazebo/rtf"), 5)
        self.assertIn("kiva4", world().model_names)
        Robot(1).do("/rot", direction=1)

    def test_wrong_arguments(self):
        for args, reason in (
            (("world:=bogus",), "there is no world 'bogus'; tried"),
            (("rtf:=-1",), "rtf:=-1: a factor above 0, or 0"),
            (("rtf:=nan",), "rtf:=nan: a factor above 0, or 0"),
            (("size:=smal",), "size:=smal: one of none, empty, small"),
        ):
            self.assertIn(f"warehouse.launch: {reason}", self.refused(*args))

    def test_a_broken_world_ends_without_a_traceback(self):
        broken = WORLDS / "invalid_box_size.sdf"
        _, said = launch("-p", str(free_port()), f"world:={broken}")
        self.assertNotIn("Traceback", said)
        self.assertIn(f"{broken}:", said)


if __name__ == "__main__":
    rospy.init_node("test_launching")
    rostest.rosrun("warehouse_tests", "launching", __name__)
