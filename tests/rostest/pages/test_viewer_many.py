#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A thousand robots keep the page answering: little comes, and little is drawn of what is far."""

import unittest

import rospy
import rostest
from rostest_support.browser import browser
from rostest_support.node_test import PATIENCE, wait_until
from selenium.webdriver.common.keys import Keys

from warehouse_sim import traffic

ROBOTS = 1000
UPDATES = 10  # that are measured
MOST_BYTES = 32 * ROBOTS  # of an update
MOST_TRIANGLES, MOST_CALLS = 100 * ROBOTS, 30  # of a picture


class ViewerMany(unittest.TestCase):
    def test_a_thousand_robots(self):
        wait_until(lambda: rospy.has_param("/warehouse/floor"), "the floor")
        wait_until(lambda: rospy.has_param("/viewer/address"), "the viewer")
        traffic.build(rospy, ROBOTS)
        with browser(PATIENCE) as page:
            page.open(rospy.get_param("/viewer/address"))
            page.until(f"page.world.scene.robots.length === {ROBOTS}")
            page.until("page.stage.frames > 1")
            drawn = page.read("page.stage.renderer.info.render")
            self.assertLess(drawn["triangles"], MOST_TRIANGLES)
            self.assertLess(drawn["calls"], MOST_CALLS)
            page.read("page.stage.renderer.render = () => {}")  # in software it takes all there is
            traffic.Traffic(rospy, ROBOTS).start()
            page.until("page.world.activity.every(activity => activity === 1)")
            self.assertLess(self.bytes_each(page), MOST_BYTES)
            page.type("kiva1000" + Keys.ENTER, "search")
            page.until("document.getElementById('name').textContent === 'kiva1000'")
            self.assertEqual(page.complaints(), [])

    def bytes_each(self, page):
        """Returns figures of the updates that come to the page."""
        bytes_before, before = page.read("[page.connection.bytes, page.connection.updates]")
        page.until(f"page.connection.updates >= {before + UPDATES}")
        bytes_after, after = page.read("[page.connection.bytes, page.connection.updates]")
        return (bytes_after - bytes_before) / (after - before)


if __name__ == "__main__":
    rospy.init_node("test_viewer_many")
    rostest.rosrun("warehouse_tests", "viewer_many", __name__)
