#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Robots move and carry as actions: with results, feedback, cancelling and refusals."""

import unittest

import actionlib
import rospy
import rostest
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from rostest_support.node_test import PATIENCE, Listener, create, wait_until
from rostest_support.warehouse_test import place
from std_srvs.srv import Empty

from warehouse_msgs.msg import CarryAction, CarryFeedback, CarryGoal, Event, MoveAction, MoveGoal

NEAR = 0.05  # [m]


class Client:
    """Sends a goal and keeps its handle.

    actionlib's SimpleActionClient knows a goal only once it was sent, and drops an answer that is
    quicker; then it waits for ever. The handle of its ActionClient misses none.
    """

    def __init__(self, name, kind):
        self._client, self._goal = actionlib.ActionClient(name, kind), None
        soon = rospy.Duration(nsecs=1)  # zero would be for ever
        wait_until(lambda: self._client.wait_for_server(soon), "the action server")

    def send(self, goal, heard):
        self._goal = self._client.send_goal(goal, feedback_cb=lambda _, feedback: heard(feedback))

    def cancel(self):
        self._goal.cancel()

    def ended(self):
        """(its status, its result), once the goal has ended."""
        wait_until(lambda: self._goal.get_comm_state() == CommState.DONE, "the end of a goal")
        return self._goal.get_goal_status(), self._goal.get_result()


class Actions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/warehouse/create_warehouse_models", PATIENCE)
        cls.move = Client("/warehouse/move", MoveAction)
        cls.carry = Client("/warehouse/carry", CarryAction)

    def setUp(self):
        self.assertTrue(create("small").success)
        self.feedback = []
        # Beneath the first row of units there is room for a robot; beside it runs a street.
        self.unit = tuple(map(round, place("storage_unit1")[:2]))
        self.street = (self.unit[0], self.unit[1] - 1)

    def send(self, client, goal):
        client.send(goal, self.feedback.append)

    def ended(self, client, state):
        status, result = client.ended()
        self.assertEqual(status, state, result)
        return result

    def at(self, name):
        return place(name)[:2]

    def assert_near(self, name, point):
        for is_at, expected in zip(self.at(name), point):
            self.assertAlmostEqual(is_at, expected, delta=NEAR)

    def test_move(self):
        self.send(self.move, MoveGoal(1, *self.street))
        result = self.ended(self.move, GoalStatus.SUCCEEDED)
        self.assertEqual(result.kind, Event.DONE)
        self.assert_near("kiva1", self.street)
        self.assertAlmostEqual(result.pose.x, self.street[0], delta=0.3)
        distances = [f.distance for f in self.feedback]
        self.assertGreater(distances[0], distances[-1])

    def test_carry(self):
        self.send(self.carry, CarryGoal(1, 1, *self.street))
        result = self.ended(self.carry, GoalStatus.SUCCEEDED)
        self.assertEqual(result.kind, Event.DONE)
        self.assert_near("storage_unit1", self.street)
        phases = [f.phase for f in self.feedback]
        self.assertEqual(phases, sorted(phases))
        self.assertIn(CarryFeedback.FETCHING, phases)
        self.assertIn(CarryFeedback.CARRYING, phases)

    def test_what_the_world_refuses_is_aborted_with_the_reason(self):
        self.send(self.move, MoveGoal(1, 0.5, 0))
        result = self.ended(self.move, GoalStatus.ABORTED)
        self.assertEqual(result.kind, Event.REFUSED)
        self.assertIn("off the grid", result.text)
        self.send(self.move, MoveGoal(99, 0, 0))
        self.ended(self.move, GoalStatus.ABORTED)

    def test_what_can_not_be_begun_is_rejected(self):
        self.send(self.carry, CarryGoal(1, 99, *self.street))
        result = self.ended(self.carry, GoalStatus.REJECTED)
        self.assertIn("no storage_unit99", result.text)
        self.send(self.carry, CarryGoal(1, 1, *self.street))
        wait_until(lambda: self.feedback, "the robot at work")
        self.send(self.move, MoveGoal(1, 0, 0))
        self.assertIn("another goal", self.ended(self.move, GoalStatus.REJECTED).text)
        self.ended(self.carry, GoalStatus.SUCCEEDED)

    def test_cancelled_it_sends_no_further_command(self):
        self.send(self.carry, CarryGoal(1, 1, *self.street))
        wait_until(lambda: self.feedback, "the robot at work")
        self.carry.cancel()
        self.ended(self.carry, GoalStatus.PREEMPTED)
        self.assert_near("kiva1", self.unit)
        self.assert_near("storage_unit1", self.unit)
        self.send(self.move, MoveGoal(1, *self.street))
        self.ended(self.move, GoalStatus.SUCCEEDED)

    def test_the_servers_live_on_when_time_goes_back(self):
        wait_until(lambda: rospy.get_time() > 1, "time that can go back")
        rospy.ServiceProxy("/gazebo/reset_simulation", Empty)()
        status = Listener("/warehouse/move/status", GoalStatusArray)
        status.until(lambda _: len(status.messages) > 2)  # the first of them is the latched one
        status.close()
        self.send(self.move, MoveGoal(1, *self.street))
        self.ended(self.move, GoalStatus.SUCCEEDED)

    def test_robots_work_side_by_side(self):
        other = Client("/warehouse/move", MoveAction)
        home = self.at("kiva2")
        self.send(self.move, MoveGoal(1, *self.street))
        self.send(other, MoveGoal(2, home[0], home[1]))
        self.ended(other, GoalStatus.SUCCEEDED)
        self.ended(self.move, GoalStatus.SUCCEEDED)


if __name__ == "__main__":
    rospy.init_node("test_actions")
    rostest.rosrun("warehouse_tests", "actions", __name__)
