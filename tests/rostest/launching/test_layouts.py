#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A warehouse of a layout file works as any other; what is wrong with a layout is told."""

import unittest
from pathlib import Path

import rospy
import rostest
from nav_msgs.srv import GetMap
from rostest_support.node_test import PATIENCE, Listener, create, latched, wait_until
from rostest_support.page_test import ask
from rostest_support.warehouse_test import world
from test_launching import free_port, launch

from warehouse_msgs.msg import CoordinatorState, Event, Kpis, StationStates

LAYOUTS = Path(__file__).resolve().parents[2] / "layouts"
NORTH = LAYOUTS / "north.layout.yaml"


class Layouts(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("/warehouse/create_warehouse_models", PATIENCE)

    def test_1_what_was_drawn_stands_there(self):
        names = world().model_names
        self.assertIn("layout_walls1", names)
        self.assertEqual([f"kiva{n}" in names for n in (4, 5)], [True, False])
        grid = rospy.ServiceProxy("/warehouse/map", GetMap)().map
        self.assertAlmostEqual(grid.info.resolution, 1.2, 6)
        self.assertEqual((grid.info.width, grid.info.height), (20, 9))
        self.assertEqual(rospy.get_param("/warehouse/name"), "north hall")

    def test_2_robots_work_on_it_with_its_stations_and_stock(self):
        events = Listener("/warehouse/events", Event)
        self.addCleanup(events.close)
        latched("/warehouse/coordinator", CoordinatorState, lambda state: state.automatic == 4)
        latched("/warehouse/kpis", Kpis, lambda kpis: kpis.items_picked >= 10)
        self.assertNotIn(Event.COLLISION, [event.kind for event in events.messages])
        stations = {s.name: s for s in latched("/warehouse/stations", StationStates).stations}
        self.assertEqual(set(stations), {"pick1", "refill"})
        self.assertEqual(stations["pick1"].slots, 5)
        skus = {place["sku"] for place in ask("/stock")[1]["places"]}
        self.assertEqual(skus, {"bolt", "nut", "washer", "screw"})

    def test_3_another_one_is_refused_with_its_reasons(self):
        for name, reason in (
            (LAYOUTS / "blocked.layout.yaml", "can't pass each other"),
            (LAYOUTS / "nix.layout.yaml", "No such file or directory"),
            (LAYOUTS / "in_hall.layout.yaml", "which is not this world: launch it by layout:="),
            ("small", "but the grid of the world is 1.2 m"),
        ):
            answer = create(str(name))
            self.assertFalse(answer.success)
            self.assertIn(reason, answer.message)
        self.assertEqual(rospy.get_param("/warehouse/layout"), str(NORTH))

    def test_4_one_comes_over_http(self):
        text = NORTH.read_text().replace("{stock: north.csv}", "12")
        wait_until(lambda: "create" not in ask("/warehouse")[1]["lacks"], "who builds others")
        for wrong, reason in (
            (text.replace("A=", "A"), "layout:11:22: this line of the drawing has 19 cells"),
            (text.replace("spacing: 1.2", "spacing: 0.5"), "layout: spacing is 0.5 m; 0.97 m or"),
        ):
            status, answer = ask("/warehouse", {"layout": wrong})
            self.assertEqual(status, 422, answer)
            self.assertIn(reason, answer["detail"])
        status, answer = ask("/warehouse", {"layout": text, "id": 7})
        self.assertEqual(status, 200, answer)
        self.assertIn("3 robots, 20 storage units, 12 items, 1 conveyor belt", answer["message"])
        warehouse = ask("/warehouse")[1]
        self.assertEqual(
            (warehouse["name"], warehouse["id"], warehouse["items"]), ("north hall", 7, 12)
        )

    def test_5_a_wrong_one_ends_roslaunch(self):
        for args, reason in (
            ([f"layout:={LAYOUTS}/blocked.layout.yaml"], "loaded robots that meet at"),
            (["layout:=nix"], "no such layout file, and 'nix' is not a preset"),
            ([f"layout:={NORTH}", "size:=small"], "size:=small: with layout:="),
            ([f"layout:={NORTH}", "robots:=99"], "99 robots, but there is room for 23"),
        ):
            code, said = launch("-p", str(free_port()), *args)
            self.assertNotEqual(code, 0, said)
            self.assertIn(reason, said)
            self.assertNotIn("Traceback", said)
            self.assertNotIn("started with pid", said)


if __name__ == "__main__":
    rospy.init_node("test_layouts")
    rostest.rosrun("warehouse_tests", "layouts", Layouts)
