#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A signal ends a node wherever it is, and ROS knows it no longer."""

import signal
import subprocess
import sys
import unittest

import rosnode
import rospy
import rostest
from rostest_support.node_test import Listener
from std_msgs.msg import String

# It holds the lock of its connection for most of the time, as rospy's own handler would need it.
CHATTERBOX = """
import rospy
from std_msgs.msg import String
from warehouse_client.node import begin

begin("chatterbox")
topic = rospy.Publisher("/chatter", String, queue_size=10)
rospy.on_shutdown(lambda: print("ends", flush=True))
try:
    while not rospy.is_shutdown():
        topic.publish("x" * 100)
except rospy.ROSException:
    pass  # the topic was closed meanwhile
"""
TIMES = 5  # of each signal
PATIENCE = 30  # [s]


class Signals(unittest.TestCase):
    def test_a_node_that_publishes_all_the_time_ends(self):
        for number in (signal.SIGTERM, signal.SIGINT) * TIMES:
            heard = Listener("/chatter", String)
            with subprocess.Popen(
                [sys.executable, "-c", CHATTERBOX], stdout=subprocess.PIPE
            ) as node:
                try:
                    heard.until()
                    node.send_signal(number)
                    output, _ = node.communicate(timeout=PATIENCE)
                finally:
                    node.kill()
                    heard.close()
            self.assertEqual((node.returncode, output), (0, b"ends\n"))
            self.assertNotIn("/chatterbox", rosnode.get_node_names())


if __name__ == "__main__":
    rospy.init_node("signals")
    rostest.rosrun("warehouse_tests", "signals", Signals)
