#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The tour and the handover note in a window of a phone: nothing is cut off or covered."""

import rostest
from rostest_support.page_test import PageTest, address

STEP = "document.querySelector('[data-step={}]').click()"
TOURED = "document.querySelector('#tour')?.checkVisibility()"
# What is visible of a thing's parts and reaches out of the window, and what lies on its buttons.
OUTSIDE = """[...document.querySelectorAll('{0}, {0} *')].filter((e) => {{
  if (!e.checkVisibility()) return false;
  const box = e.getBoundingClientRect();
  return box.left < 0 || box.top < 0 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1;
}}).map((e) => e.outerHTML.slice(0, 80))"""
COVERED = """[...document.querySelectorAll('{} button')].filter((e) => {{
  if (!e.checkVisibility()) return false;
  const box = e.getBoundingClientRect();
  return !e.contains(document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2));
}}).map((e) => e.textContent)"""


class PhonePage(PageTest):
    """What a newcomer, and who goes home, sees in a window of 390 by 844 pixels."""

    is_phone, ready = True, "page.world?.scene?.robots.length === 4"

    def whole(self, thing):
        self.assertEqual(self.page.read(OUTSIDE.format(thing)), [])
        self.assertEqual(self.page.read(COVERED.format(thing)), [])

    def test_1_each_stop_of_the_tour_is_whole_and_the_first_leaves_the_floor_free(self):
        self.page.read("page.drawers.open('start-panel') ?? true")
        self.page.until(
            f"{TOURED} || {STEP.format('tour')}"
        )  # while the page loads nothing takes it
        self.assertFalse(self.page.read("page.drawers.isOpen('start-panel')"))
        top = self.page.read("document.getElementById('tour').getBoundingClientRect().top")
        self.assertGreater(top, 844 / 2)
        for _ in range(5):
            self.whole("#tour")
            self.page.read("document.querySelector('#tour footer .strong').click()")
        self.assertFalse(self.page.read(TOURED))

    def test_2_the_handover_note_is_whole(self):
        self.page.open(address() + "operations")
        self.page.until("document.getElementById('open-handover').click() ?? true")
        self.page.until("document.getElementById('handover-text').value.startsWith('# Handover')")
        self.whole("#handover")
        self.assertLessEqual(self.page.read("document.documentElement.scrollWidth"), 390)


if __name__ == "__main__":
    rostest.rosrun("warehouse_tests", "phone_page", PhonePage)
