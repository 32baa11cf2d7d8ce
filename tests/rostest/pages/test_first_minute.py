#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A newcomer's first minute: the page invites, and each invitation does what it says, at once."""

import time

import rostest
from rostest_support import axe
from rostest_support.browser import browser
from rostest_support.node_test import PATIENCE, wait_until
from rostest_support.page_test import PageTest, address, ask

SHOWN = "document.getElementById('{}').checkVisibility()"
STEP = "document.querySelector('[data-step={}]').click()"
CROSSES = "[...page.world.moving].some((i) => page.world.shelf[i])"
TOURED = "document.querySelector('#tour')?.checkVisibility()"


class FirstMinute(PageTest):
    """Tests that run in this order: a shift that was started runs to the end."""

    @classmethod
    def setUpClass(cls):
        cls.page = cls.enterClassContext(browser(PATIENCE, is_newcomer=True))
        cls.page.open(address())
        cls.page.until("page.world.scene.robots.length === 4")

    def test_1_the_page_invites(self):
        self.page.until(SHOWN.format("start-panel"))
        self.page.until("!document.getElementById('start-shift').disabled")
        self.assertEqual(axe.findings(self.page), [])

    def test_2_a_robot_drives(self):
        before = ask("/robots")[1]["robots"]
        self.page.read(STEP.format("drive"))
        self.page.until("/^kiva/.test(page.selected) && page.details.selectedRobot >= 0")
        wait_until(lambda: ask("/robots")[1]["robots"] != before, "a robot that drives")

    def test_3_a_tour_of_five_stops_comes_once(self):
        self.page.until(TOURED)
        self.assertEqual(axe.findings(self.page), [])
        for stop in range(1, 6):
            self.assertIn(f"{stop} of 5", self.page.text("tour"))
            self.page.read("document.querySelector('#tour footer .strong').click()")
        self.assertFalse(self.page.read(TOURED))
        self.page.open("about:blank")
        self.page.open(address())
        self.page.until("page.world.scene.robots.length === 4")

    def test_4_something_breaks_and_is_repaired(self):
        self.page.read(STEP.format("fail"))
        self.page.until(
            "page.details.selectedRobot >= 0 && page.world.failures[page.details.selectedRobot]"
        )
        self.assertFalse(self.page.read(TOURED))
        self.page.until("document.querySelector('#care .care-acts button')?.checkVisibility()")
        self.page.read("document.querySelector('#care .care-acts button').click()")
        self.page.until("page.world.failures.every((failure) => !failure)")

    def test_5_a_shift_starts_and_units_cross_the_floor(self):
        before = time.monotonic()
        self.page.read(STEP.format("shift"))
        wait_until(lambda: self.page.read(CROSSES), "a unit that crosses the floor", 60)
        print(f"a unit crosses the floor {time.monotonic() - before:.1f} s after the click")
        self.page.until(f"!{SHOWN.format('start-panel')}")
        self.assertAlmostEqual(ask("/warehouse")[1]["target_factor"], 10)
        self.page.until(
            "document.getElementById('start-shift').dataset.why === 'a shift runs already'"
        )

    def test_6_one_shift_is_enough(self):
        status, answer = ask("/shift", {"factor": 1})
        self.assertEqual((status, answer["detail"]), (409, "a shift runs already"))
        self.assertEqual(ask("/robots/99/failure", {"kind": "MOTOR"})[0], 404)
        self.assertEqual(ask("/robots/1/failure", {"kind": "NONE"})[0], 422)


if __name__ == "__main__":
    rostest.rosrun("warehouse_tests", "first_minute", FirstMinute)
