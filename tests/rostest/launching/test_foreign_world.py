#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A warehouse stands on the free cells of a foreign world, and its obstacles block robots."""

import unittest

import rospy
import rostest
from nav_msgs.srv import GetMap
from rostest_support.node_test import PATIENCE, call, create
from rostest_support.warehouse_test import Commander, pose, state, world

from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import SetModelState
from warehouse_layout.generate.cells import Cells
from warehouse_layout.models.models import KINDS, MARKINGS, kind_and_number
from warehouse_msgs.msg import Event


def standing(kind):
    return [name for name in world().model_names if kind_and_number(name)[0] == kind]


def points(kind):
    places = [state(name).pose.position for name in standing(kind)]
    return [(round(at.x), round(at.y)) for at in places]


def cells():
    return Cells.of_map(call("/warehouse/map", GetMap).map)


class ForeignWorld(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("/warehouse/create_warehouse_models", PATIENCE)

    def test_its_models_stand_and_its_actor_as_a_person(self):
        names = world().model_names
        expected = {"ground_plane", "walls", "walker", "shelf_1", "shelf_2", "pillar_1", "pillar_2"}
        self.assertEqual(expected, {n for n in names if kind_and_number(n)[0] is None})

    def test_its_map_shows_what_is_in_the_way(self):
        taken = cells().points()
        self.assertLessEqual(
            {(4, 0), (-4, 0), (-12, -8), (-8, 4), (-7, 4), (16, 8), (-17, 0)}, taken
        )
        door = (17, 0)
        self.assertTrue(taken.isdisjoint({(0, 0), (10, 10), door, (30, 30)}))

    def test_a_warehouse_stands_on_free_cells(self):
        self.assertEqual([len(standing(kind)) for kind in KINDS], [4, 24, 96, 2])
        places = points("kiva") + points("storage_unit")
        self.assertEqual(len(set(places)), 28)
        self.assertTrue(cells().points().isdisjoint(places))
        # With stations, whose lanes are painted on the floor.
        self.assertEqual(len(standing(MARKINGS)), 1)

    def test_its_walls_block_robots(self):
        outside = ModelState(model_name="kiva1", pose=pose(30, 30), reference_frame="world")
        self.assertTrue(call("/gazebo/set_model_state", SetModelState, outside).success)
        commander = Commander()
        self.addCleanup(commander.close)
        end = commander.do("/mov", x=10, y=10, kiva_id=1)[-1]
        self.assertEqual((end.kind, end.other), (Event.BLOCKED, "walls"), end.text)
        at = state("kiva1").pose.position
        self.assertEqual((round(at.x), round(at.y)), (10, 19))  # the wall reaches from 16 to 17.6

    def test_what_does_not_fit_is_refused(self):
        answer = create(robots=3000, shelves=9000)
        self.assertFalse(answer.success)
        self.assertIn("don't fit", answer.message)
        self.assertEqual(len(standing("kiva")), 4)


if __name__ == "__main__":
    rospy.init_node("test_foreign_world")
    rostest.rosrun("warehouse_tests", "foreign_world", ForeignWorld)
