#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A newcomer's first minute: the page invites, and each invitation does what it says, at once."""

import math
import time

import rostest
from rostest_support import axe
from rostest_support.browser import browser
from rostest_support.node_test import PATIENCE, wait_until
from rostest_support.page_test import PageTest, address, ask, fetch

SHOWN = "document.getElementById('{}').checkVisibility()"
STEP = "document.querySelector('[data-step={}]').click()"
TOURED = "document.querySelector('#tour')?.checkVisibility()"


def units():
    rows = ask("/storage_units?limit=100")[1]["things"]
    return {row["name"]: (row["pose"]["x"], row["pose"]["y"]) for row in rows}


def kinds():
    return [alarm["kind"] for alarm in ask("/alarms")[1]["alarms"]]


class FirstMinute(PageTest):
    """Tests that run in this order: a shift that was started runs to the end."""

    @classmethod
    def setUpClass(cls):
        cls.page = cls.enterClassContext(browser(PATIENCE, is_newcomer=True))
        cls.page.open(address())
        cls.page.until("page.world.scene.robots.length === 4")

    def check_for_all(self):
        """What was done before counts where axe is not installed, too."""
        if axe.is_there():
            self.assertEqual(axe.findings(self.page), [])

    def test_1_the_page_invites(self):
        self.page.until(SHOWN.format("start-panel"))
        self.page.until("!document.getElementById('start-shift').disabled")
        self.check_for_all()

    def test_2_a_robot_drives(self):
        before = ask("/robots")[1]["robots"]
        self.page.read(STEP.format("drive"))
        self.page.until("/^kiva/.test(page.selected) && page.details.selectedRobot >= 0")
        wait_until(lambda: ask("/robots")[1]["robots"] != before, "a robot that drives")

    def test_3_a_tour_of_five_stops_comes_once(self):
        self.page.until(TOURED)
        self.check_for_all()
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
        stood, begin = units(), time.monotonic()
        self.page.read(STEP.format("shift"))

        def crosses():
            return any(math.dist(place, stood[name]) > 1 for name, place in units().items())

        wait_until(crosses, "a unit that crosses the floor", 60)
        print(f"a unit has moved by a cell {time.monotonic() - begin:.1f} s after the click")
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

    def test_7_all_robots_stop_and_go_on(self):
        self.page.read("document.getElementById('stop-all').click()")
        self.page.until("page.bar.stopped !== null")
        wait_until(lambda: kinds() == ["EMERGENCY_STOP"], "the alarm of the stop")
        self.check_for_all()
        self.page.read("document.getElementById('stop-all').click()")
        self.page.until("document.getElementById('question').open")
        self.page.read("document.getElementById('question-yes').click()")
        wait_until(lambda: not ask("/fleet/stop")[1]["stopped"], "the end of the stop")
        wait_until(lambda: "EMERGENCY_STOP" not in kinds(), "the end of its alarm")

    def test_8_who_did_it_is_known(self):
        paths = [row["path"] for row in ask("/commands")[1]["commands"]]
        self.assertIn("/fleet/stop", paths)
        status, note = fetch("api/v1/handover.md")
        self.assertEqual(status, 200)
        self.assertIn("has stopped all robots", note.decode())


if __name__ == "__main__":
    rostest.rosrun("warehouse_tests", "first_minute", FirstMinute)
