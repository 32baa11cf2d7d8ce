#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A warehouse is built, and its coordinator begins, before time passes where it is to pass fast."""

import subprocess
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from rostest_support.node_test import call, latched
from rostest_support.warehouse_test import Collector

from gazebo_msgs.srv import GetWorldProperties
from warehouse_client.pace import PaceKeeper
from warehouse_msgs.msg import CoordinatorState

START = 0.1  # where the world waits [s]
LOOKAHEAD = 0.2  # [s]
LAUNCH = ("roslaunch", "--dump-params", "warehouse_sim")


def now():
    return call("/gazebo/get_world_properties", GetWorldProperties).sim_time


class Awaited(unittest.TestCase):
    def test_time_stands_until_the_last_is_ready(self):
        keeper = PaceKeeper(START)
        keeper.acted_upon(rospy.Time())  # however long the others take to start
        state = latched("/warehouse/coordinator", CoordinatorState, lambda s: len(s.station) > 0)
        self.assertAlmostEqual(state.header.stamp.to_sec(), START, delta=1e-6)
        self.assertAlmostEqual(now(), START, delta=1e-6)
        with Collector("/clock", Clock) as clock:
            keeper.release()
            clock.first(lambda message: message.clock.to_sec() > START + LOOKAHEAD)

    def awaited_by(self, file, *arguments):
        done = subprocess.run(
            [*LAUNCH, file, *arguments], capture_output=True, text=True, timeout=60, check=False
        )
        lines = done.stdout.splitlines()
        return next((line.split(": ", 1)[1] for line in lines if "gazebo/awaits" in line), "")

    def test_launches_name_those_that_build_and_drive(self):
        builder = "create_warehouse_service_node"
        free = ("viewer:=false",)
        self.assertEqual(self.awaited_by("warehouse.launch", *free), builder)
        with_one = self.awaited_by("warehouse.launch", "coordinator:=true", *free)
        self.assertEqual(with_one, f"{builder} coordinator")
        self.assertEqual(self.awaited_by("warehouse.launch", "size:=none", *free), "")
        shift = self.awaited_by("operations.launch", *free)
        self.assertEqual(shift, f"{builder} coordinator operations")


if __name__ == "__main__":
    rospy.init_node("awaited")
    rostest.rosrun("warehouse_tests", "awaited", Awaited)
