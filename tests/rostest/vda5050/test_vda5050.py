#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A master at a broker drives a robot of the running warehouse, and hears what befalls it."""

import unittest

import rospy
import rostest
from rostest_support.node_test import call, latched, wait_until
from std_srvs.srv import Empty

from warehouse_msgs.msg import CoordinatorState, Vda5050
from warehouse_msgs.srv import Fail
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.demo_master import DemoMaster
from warehouse_vda5050.fetch_trip import FetchTrip
from warehouse_vda5050.mqtt.settings import read_settings
from warehouse_vda5050.topics import Identity, Topics

ROBOT = Identity("kiva", "1")


class Vehicles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        driven_by = latched("/warehouse/vda5050", Vda5050, lambda message: 1 in message.kiva_id)
        cls.lines = []
        broker = read_settings(driven_by.broker)
        cls.master = DemoMaster(broker, codec_for(), Topics(), cls.lines.append)

    @classmethod
    def tearDownClass(cls):
        cls.master.close()

    def test_1_fetches_a_unit_and_is_the_coordinators_again(self):
        modes = []
        rospy.Subscriber(
            "/warehouse/coordinator", CoordinatorState, lambda s: modes.append(s.manual)
        )
        FetchTrip(self.master).run()
        self.assertIn("1: pick is FINISHED", self.lines)
        self.assertIn("1: drop is FINISHED", self.lines)
        wait_until(lambda: 1 in modes and modes[-1] == 0, "the robot to be given back")
        driven_by = latched("/warehouse/vda5050", Vda5050, lambda message: not message.driven[0])
        self.assertEqual((driven_by.order[0], driven_by.errors[0]), ("", ""))

    def test_2_lost_radio_is_a_broken_connection(self):
        call("/warehouse/fail", Fail, 1, 4, 0.0)
        self.master.until(lambda: self.master.online.get(ROBOT) is False, 30, "the will")
        call("/warehouse/fail", Fail, 1, 0, 0.0)
        self.master.until(lambda: self.master.online.get(ROBOT), 30, "the robot")

    def test_3_broken_drive_is_told(self):
        call("/warehouse/fail", Fail, 1, 1, 0.0)

        def types():
            return {error.type for error in self.master.states[ROBOT].errors}

        self.master.until(lambda: "motorError" in types(), 30, "the error")

    def test_4_the_connection_has_unexpectedly_ended_where_the_world_tells_nothing(self):
        """Also of a world that has ended, which tells as little as one that is paused."""
        rospy.ServiceProxy("/gazebo/pause_physics", Empty)()
        self.master.until(lambda: not any(self.master.online.values()), 10, "all the wills")
        self.assertIn("robotSilent", {error.type for error in self.master.states[ROBOT].errors})
        rospy.ServiceProxy("/gazebo/unpause_physics", Empty)()
        self.master.until(lambda: all(self.master.online.values()), 30, "the robots")


if __name__ == "__main__":
    rospy.init_node("test_vda5050")
    rostest.rosrun("warehouse_tests", "vda5050", Vehicles)
