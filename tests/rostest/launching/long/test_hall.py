#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A shift works in a small room of another's world, and says what stands there."""

import unittest

import rospy
import rostest
from rostest_support.node_test import PATIENCE, Listener, create, latched
from rostest_support.warehouse_test import state, world

from warehouse_layout.models.models import KINDS, kind_and_number
from warehouse_msgs.msg import CoordinatorState, Event, Kpis


class Hall(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("/warehouse/create_warehouse_models", PATIENCE)

    def test_1_all_of_it_stands_in_the_room(self):
        names = [name for name in world().model_names if kind_and_number(name)[0] in KINDS]
        self.assertGreater(len(names), 10)
        for name in names:
            at = state(name).pose.position
            self.assertTrue(-40.7 < at.x < -35.3 and 20.3 < at.y < 27.7, f"{name}: {at}")

    def test_2_orders_are_picked_without_contact(self):
        events = Listener("/warehouse/events", Event)
        self.addCleanup(events.close)
        latched("/warehouse/coordinator", CoordinatorState, lambda state: state.automatic == 3)
        latched("/warehouse/kpis", Kpis, lambda kpis: kpis.simulated_s >= 180)
        figures = latched("/warehouse/kpis", Kpis)
        self.assertGreater(figures.items_picked, 10)
        self.assertEqual(latched("/warehouse/coordinator", CoordinatorState).alarms, [])
        self.assertNotIn(Event.COLLISION, [event.kind for event in events.messages])

    def test_3_what_does_not_fit_is_refused_with_what_does(self):
        answer = create("small")
        self.assertFalse(answer.success)
        self.assertIn("3 robots, 10 storage units fit: size:=fit takes that", answer.message)


if __name__ == "__main__":
    rospy.init_node("test_hall")
    rostest.rosrun("warehouse_tests", "hall", Hall)
