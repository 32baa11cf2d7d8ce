#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The world tells what a picture of it needs: looks, what stands there, and ways."""

import unittest

import rospy
import rostest
from rostest_support.warehouse_test import (
    BOX,
    Collector,
    Commander,
    Paused,
    control,
    delete,
    pose,
    spawn,
)

from warehouse_msgs.msg import FleetPaths, Look, Scenery


def shapes(look, link):
    """(kind, size) of each shape of a link."""
    index = look.links.index(link)
    sizes = [tuple(look.shape_size[3 * i : 3 * i + 3]) for i in range(len(look.shape_kind))]
    kinds = bytes(look.shape_kind)
    return [(kinds[i], sizes[i]) for i, at in enumerate(look.shape_link) if at == index]


class Showcase(unittest.TestCase):
    def setUp(self):
        control("reset_simulation")

    def test_the_scenery_is_what_else_stands_there(self):
        with Collector("/warehouse/scenery", Scenery) as topic:
            scenery = topic.first()
        self.assertEqual(sorted(scenery.models), ["conveyor_belt1", "conveyor_belt2"])
        self.assertEqual(scenery.model_look[0], scenery.model_look[1])
        self.assertEqual(len(scenery.pose), 14)
        self.assertEqual(scenery.floor, (-10.0, 10.0, -10.0, 10.0))
        self.assertEqual(scenery.grid_spacing, 1.0)

    def test_looks_are_those_of_the_models_files(self):
        with Collector("/warehouse/scenery", Scenery) as topic:
            scenery = topic.first()
        kiva = scenery.looks[scenery.kiva_look]
        self.assertEqual(kiva.links, ["chassis", "left_wheel", "right_wheel", "tower"])
        self.assertIn((Look.BOX, (0.72, 0.62, 0.14)), shapes(kiva, "chassis"))
        self.assertIn((Look.CYLINDER, (0.5, 0.5, 0.04)), shapes(kiva, "tower"))
        self.assertEqual(tuple(kiva.link_pose[21:24]), (0, 0, 0.38))
        item = scenery.looks[scenery.item_look]
        self.assertEqual(shapes(item, "body")[0], (Look.BOX, (0.20, 0.15, 0.12)))

    def test_a_model_without_visuals_shows_what_touches_while_time_stands_still(self):
        with Collector("/warehouse/scenery", Scenery) as topic, Paused():
            spawn("box", BOX, pose(3, 3))
            scenery = topic.first(lambda s: "box" in s.models)
            look = scenery.looks[scenery.model_look[scenery.models.index("box")]]
            self.assertEqual(shapes(look, "link"), [(Look.BOX, (0.2, 0.2, 0.2))])
            delete("box")
            topic.clear()
            topic.first(lambda s: "box" not in s.models)

    def test_paths_are_the_corners_still_to_come(self):
        commander = Commander()
        with Collector("/warehouse/paths", FleetPaths) as topic:
            commander.ask("/mov", kiva_id=1, x=-4.0, y=-3.0)
            paths = topic.first(lambda p: p.kiva_id)
            self.assertEqual((paths.kiva_id, paths.points), ((1,), (2,)))
            self.assertEqual((paths.x, paths.y), ((-4.0, -4.0), (-2.0, -3.0)))
            topic.first(lambda p: p.points == (1,))
            topic.clear()
            topic.first(lambda p: not p.kiva_id)
        commander.close()


if __name__ == "__main__":
    rospy.init_node("test_showcase")
    rostest.rosrun("warehouse_tests", "showcase", __name__)
