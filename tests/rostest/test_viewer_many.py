#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A thousand robots keep the page answering. All but the drawing itself, in software here."""

import time
import unittest

import rospy
import rostest
from browser import browser
from node_test import PATIENCE, wait_until

from warehouse_sim import traffic

ROBOTS = 1000
BUDGET = 1e6  # [bytes/s]
STANDS_STILL = 500  # [ms] a frame: one says so; how fast it is depends on the machine
SECONDS = 3.0  # of the measurement [s, wall]

# Milliseconds a frame takes before it is drawn, when all robots move.
FRAME = """(() => {
  const began = performance.now();
  for (let frame = 0; frame < 10; ++frame) {
    for (let i = 0; i < page.world.status.length; ++i) page.world.moving.add(i);
    page.beforeDraw(performance.now());
  }
  return (performance.now() - began) / 10;
})()"""


class ViewerMany(unittest.TestCase):
    def test_a_thousand_robots(self):
        wait_until(lambda: rospy.has_param("/warehouse/floor"), "the floor")
        wait_until(lambda: rospy.has_param("/viewer/address"), "the viewer")
        traffic.build(rospy, ROBOTS)
        with browser(PATIENCE) as page:
            page.open(rospy.get_param("/viewer/address"))
            page.until(f"page.world.scene.robots.length === {ROBOTS}")
            page.until("page.stage.frames > 1")
            page.read("page.stage.renderer.render = () => {}")
            traffic.Traffic(rospy, ROBOTS).start()
            page.until("page.world.status.every(status => status === 1)")
            frame = page.read(FRAME)
            print(f"{frame:.1f} ms a frame before it is drawn")
            self.assertLess(frame, STANDS_STILL)
            self.assertLess(self.rate(page), BUDGET)
            page.read("page.select('kiva1000')")
            page.until("document.getElementById('name').textContent === 'kiva1000'")
            self.assertEqual(page.complaints(), [])

    def rate(self, page):
        """Bytes a second that reach the page."""
        before, began = page.read("page.connection.bytes"), time.monotonic()
        rospy.rostime.wallsleep(SECONDS)
        return (page.read("page.connection.bytes") - before) / (time.monotonic() - began)


if __name__ == "__main__":
    rospy.init_node("test_viewer_many")
    rostest.rosrun("warehouse_tests", "viewer_many", __name__)
