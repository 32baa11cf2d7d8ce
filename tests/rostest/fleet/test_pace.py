#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A world as fast as it goes waits for its coordinator and for other nodes that ask it to, but not
for one that has died."""

import os
import signal
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from rostest_support.node_test import call, pid, sends, wait_until
from rostest_support.warehouse_test import Collector

from gazebo_msgs.srv import GetWorldProperties
from warehouse_client.pace import PaceKeeper
from warehouse_msgs.msg import CoordinatorState, Pace

LOOKAHEAD = 0.5  # [s]
AHEAD = 0.3  # how far the world may be ahead of its coordinator [s]
REPORT = 0.1  # between two reports of the robots [s]
PATIENCE = 60.0  # [s, wall]
COORDINATOR = "/coordinator"


def decided(paces):
    """Returns the times of decisions [s]. The node that built the warehouse has released time: its
    last message, without a look-ahead, is latched and comes at any moment."""
    return [pace.stamp.to_sec() for pace in paces if pace.lookahead]


class Waiting(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.clock = Collector("/clock", Clock)
        cls.state = Collector("/warehouse/coordinator", CoordinatorState)
        cls.state.first(lambda state: state.delivered >= 1, PATIENCE)
        cls.paces = Collector("/warehouse/pace", Pace, connected=False)
        cls.paces.first(lambda pace: True, PATIENCE)

    def now(self):
        return call("/gazebo/get_world_properties", GetWorldProperties).sim_time

    def wait_for_world(self):
        """Until the world hears what this node says of its pace."""
        me = rospy.get_name()
        wait_until(lambda: sends(me, "/gazebo", "/warehouse/pace"), "the world")

    def passes(self, time):
        """Until the clock has passed that time."""
        self.clock.clear()
        self.clock.first(lambda message: message.clock.to_sec() > time, PATIENCE)

    def test_a_no_decision_of_the_coordinator_is_late(self):
        self.paces.clear()
        record = self.paces.wait_for(
            lambda paces: (times := decided(paces)) and times[-1] > times[0] + 60, PATIENCE
        )
        times = decided(record)
        apart = [after - before for before, after in zip(times, times[1:])]
        self.assertLessEqual(max(apart), AHEAD + REPORT + 1e-6)

    def test_b_time_stands_where_a_node_has_let_it_go(self):
        keeper = PaceKeeper(LOOKAHEAD)
        self.wait_for_world()
        for _ in range(5):
            begin = self.now() + 1.0
            keeper.acted_upon(rospy.Time.from_sec(begin))
            self.clock.first(lambda m, end=begin + LOOKAHEAD: m.clock.to_sec() >= end - 1e-6)
            standing = [self.now() for _ in range(20)]
            self.assertAlmostEqual(min(standing), begin + LOOKAHEAD, delta=1e-6)
            self.assertAlmostEqual(max(standing), begin + LOOKAHEAD, delta=1e-6)
        keeper.release()
        self.passes(begin + LOOKAHEAD + 10)

    def test_c_one_that_asks_for_nonsense_is_not_waited_for(self):
        publisher = rospy.Publisher("/warehouse/pace", Pace, queue_size=1)
        self.wait_for_world()
        publisher.publish(Pace(rospy.Time(), rospy.Duration(-3)))
        self.passes(self.now() + 10)

    def test_d_the_next_coordinator_takes_over_from_one_that_was_killed(self):
        before = pid(COORDINATOR)
        os.kill(before, signal.SIGKILL)
        wait_until(lambda: pid(COORDINATOR) not in (None, before), "the next coordinator")
        self.state.clear()
        self.state.first(lambda state: state.delivered >= 1, PATIENCE)

    def test_e_one_that_never_comes_back_is_waited_for_ten_seconds(self):
        keeper = PaceKeeper(LOOKAHEAD)
        self.wait_for_world()
        keeper.acted_upon(rospy.Time.from_sec(self.now()))
        self.passes(self.now() + 10)


if __name__ == "__main__":
    rospy.init_node("pace")
    rostest.rosrun("warehouse_tests", "pace", Waiting)
