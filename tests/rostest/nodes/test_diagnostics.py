#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What /diagnostics says of a warehouse that is well, paused, and has a broken robot."""

import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rostest_support.node_test import call
from rostest_support.warehouse_test import Collector
from std_srvs.srv import Empty

from warehouse_msgs.srv import Fail, FailRequest


class Diagnostics(unittest.TestCase):
    def comes(self, name, level, message):
        """Waits for a status of that level whose sentence holds `message`."""

        def fits(status):
            is_it = (status.name, status.level) == (f"warehouse: {name}", level)
            return is_it and message in status.message

        with Collector("/diagnostics", DiagnosticArray) as messages:
            messages.first(lambda m: any(map(fits, m.status)))

    def setUp(self):
        self.comes("robots", DiagnosticStatus.OK, "4 robots, none failed or blocked")

    def test_a_viewer_that_answers(self):
        self.comes("viewer", DiagnosticStatus.OK, "answers")

    def test_a_paused_world_is_no_slow_one(self):
        call("/gazebo/pause_physics", Empty)
        self.addCleanup(call, "/gazebo/unpause_physics", Empty)
        self.comes("world", DiagnosticStatus.OK, "paused")

    def test_a_broken_robot_is_an_error_until_it_is_repaired(self):
        self.assertTrue(call("/warehouse/fail", Fail, 2, FailRequest.MOTOR, 0).success)
        self.comes("robots", DiagnosticStatus.ERROR, "failed: kiva2 (drive)")
        self.assertTrue(call("/warehouse/fail", Fail, 2, FailRequest.REPAIRED, 0).success)
        self.comes("robots", DiagnosticStatus.OK, "none failed")


if __name__ == "__main__":
    rospy.init_node("diagnostics_test", disable_rostime=True)
    rostest.rosrun("warehouse_tests", "diagnostics", Diagnostics)
