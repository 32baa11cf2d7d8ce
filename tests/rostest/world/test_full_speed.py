#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A world as fast as it goes still serves services and commands."""

import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from rostest_support.warehouse_test import (
    Collector,
    Commander,
    Paused,
    delete,
    place,
    pose,
    sim_time,
    spawn,
)

from warehouse_msgs.msg import Event


class FullSpeed(unittest.TestCase):
    def test_time_flies(self):
        begin, wall = sim_time(), time.monotonic()
        with Collector("/clock", Clock) as clocks:
            clocks.first(lambda m: m.clock.to_sec() > begin + 20)
        self.assertLess(time.monotonic() - wall, 10)

    def test_services_are_answered(self):
        self.assertTrue(spawn("box", where=pose(3.0, 8.0)).success)
        self.assertEqual(place("box"), (3.0, 8.0, 0.0))
        self.assertTrue(delete("box").success)

    def test_commands_are_executed(self):
        commander = Commander()
        for distance in (2.0, -2.0):
            events = commander.do("/movx", kiva_id=1, distance=distance)
            self.assertEqual(events[-1].kind, Event.DONE)
        took = events[-1].header.stamp - events[0].header.stamp
        self.assertGreater(took.to_sec(), 2.0)  # of simulated time: a robot drives no faster
        commander.close()

    def test_pauses(self):
        with Paused():
            self.assertEqual(sim_time(), sim_time())


if __name__ == "__main__":
    rospy.init_node("test_full_speed")
    rostest.rosrun("warehouse_tests", "full_speed", __name__)
