#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The page in the browser shows the warehouse and commands it."""

import io
import unittest

import rospy
import rostest
from browser import browser
from node_test import PATIENCE, Robot, wait_until
from PIL import Image
from warehouse_test import delete, model_file, place, pose, spawn

ROBOTS, UNITS, ITEMS = 4, 24, 96


def address():
    wait_until(lambda: rospy.has_param("/viewer/address"), "the viewer")
    return rospy.get_param("/viewer/address")


class ViewerPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._browser = browser(PATIENCE)
        cls.page = cls._browser.__enter__()
        cls.page.open(address())
        cls.page.until(f"page.world.scene.robots.length === {ROBOTS} && page.stage.frames > 2")

    @classmethod
    def tearDownClass(cls):
        cls._browser.__exit__(None, None, None)

    def tearDown(self):
        self.page.read("page.select(null)")
        self.assertEqual(self.page.complaints(), [])

    def drawn(self, robot):
        """[x, y] of a robot in the picture."""
        return self.page.read(f"[...page.world.shown.slice({3 * (robot - 1)}, {3 * robot - 1})]")

    def test_shows_what_stands_there(self):
        scene = self.page.read("page.world.scene")
        self.assertEqual((len(scene["units"]), len(scene["items"])), (UNITS, ITEMS))
        for robot in range(1, ROBOTS + 1):
            for seen, real in zip(self.drawn(robot), place(f"kiva{robot}")):
                self.assertAlmostEqual(seen, real, places=3)
        self.assertEqual(self.page.read("page.list.rows.length"), ROBOTS)

    def test_is_not_blank(self):
        picture = Image.open(io.BytesIO(self.page.driver.get_screenshot_as_png()))
        middle = picture.convert("RGB").crop((290, 70, 990, 540))
        self.assertGreater(len(middle.getcolors(maxcolors=middle.width * middle.height)), 100)

    def test_a_click_selects_and_another_sends(self):
        x, y, _ = place("kiva1")
        self.page.click(x, y, 0.4)
        self.page.until("page.selected === 'kiva1'")
        # Off its street's end, where nothing stands between the camera and the floor.
        self.page.click(x, -4, 0.0)
        wait_until(lambda: abs(place("kiva1")[1] + 4) < 1e-3, "kiva1 at y = -4")
        self.page.until("document.getElementById('answer').dataset.kind === 'done'")
        self.page.until("Math.abs(page.world.shown[1] + 4) < 0.001")

    def test_says_why_a_command_is_refused(self):
        self.page.read("page.select('kiva2')")
        self.page.read("page.details.go(1000, 0, [640, 300]) && true")
        self.page.until("document.getElementById('answer').dataset.kind === 'refused'")
        self.assertIn("outside the floor", self.page.text("answer"))
        self.assertIn("outside the floor", self.page.text("tip"))

    def test_a_key_turns_the_selected_robot(self):
        self.page.read("page.select('kiva3')")
        before = self.page.read("page.world.pose[8]")
        self.page.press("q")
        self.page.until(f"Math.abs(Math.sin(page.world.pose[8] - {before}) - 1) < 0.001")

    def test_a_blocked_robot_shows_as_blocked(self):
        x, y, _ = place("kiva4")
        Robot(4).do("/mov", x=x, y=4.0)
        spawn("person1", model_file("person"), pose(x + 2, 4.0))
        self.page.until("page.world.scene.scenery.includes('person1')")
        self.page.read("page.details.order('kiva4', 'movx', {distance: 4}) && true")
        self.page.until("page.world.status[3] === 2")
        first = "document.querySelector('#robots .row')"
        self.page.until(f"{first}.textContent.startsWith('blockedkiva4')")
        delete("person1")
        self.page.until("!page.world.scene.scenery.includes('person1')")
        Robot(4).do("/movx", distance=1.0)
        self.page.until("page.world.status[3] !== 2")

    def test_pauses(self):
        self.page.read("document.getElementById('pause').click()")
        self.page.until("document.getElementById('link').dataset.state === 'paused'")
        self.page.read("document.getElementById('pause').click()")
        self.page.until("document.getElementById('link').dataset.state === 'live'")

    def test_steps(self):
        self.page.read("document.getElementById('pause').click()")
        self.page.until("document.getElementById('link').dataset.state === 'paused'")
        before = self.page.read("page.world.stamp")
        self.page.read("document.getElementById('step').click()")
        self.page.until(f"page.world.stamp > {before} + 0.05")
        self.page.read("document.getElementById('pause').click()")
        self.page.until("document.getElementById('link').dataset.state === 'live'")

    def test_goes_back_to_a_checkpoint(self):
        robot, status = Robot(3), "document.getElementById('tip').dataset.kind"
        self.page.read("document.getElementById('checkpoint').click()")
        self.page.until(f"{status} === 'done'")
        x, y, _ = place("kiva3")
        robot.do("/movx", distance=1.0)
        self.page.until(f"Math.abs(page.world.shown[6] - {x + 1}) < 0.01")
        self.page.read("document.getElementById('restore').click()")
        self.page.until(f"Math.abs(page.world.shown[6] - {x}) < 0.01")

    def test_shows_scan_and_path_of_the_selected(self):
        self.page.read("page.select('kiva2')")
        self.page.read("document.getElementById('scan').click()")
        self.page.until("page.overlays.fan.visible")
        self.page.read("document.getElementById('scan').click()")
        self.assertFalse(self.page.read("page.overlays.fan.visible"))


if __name__ == "__main__":
    rospy.init_node("test_viewer_page")
    rostest.rosrun("warehouse_tests", "viewer_page", __name__)
