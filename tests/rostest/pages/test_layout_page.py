#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The layout editor of a running warehouse builds what is drawn in it.

What else the editor does is tested without ROS, in unit/python/viewer/editor/test_editor_page.py.
"""

import rospy
import rostest
from rostest_support.node_test import wait_until
from rostest_support.page_test import PageTest, ask
from selenium.webdriver.support.ui import Select


class LayoutPage(PageTest):
    """A generated drawing becomes the warehouse that stands."""

    path, ready = "layout", "Boolean(page.store)"

    def test_a_drawing_takes_the_place_of_the_warehouse(self):
        self.page.click_on("new")
        Select(self.page.driver.find_element("id", "new-size")).select_by_value("medium")
        self.page.driver.find_element("css selector", "#creator [value=yes]").click()
        self.page.until("page.editor.drawing.robotCount === 20")
        self.page.type("drawn\n", "own-name")
        self.page.click_on("build")
        self.page.click_on("question-yes")
        stands = lambda: ask("/warehouse")[1].get("robots") == 20  # noqa: E731
        wait_until(stands, "the drawn warehouse stands")
        self.page.until("document.getElementById('said').dataset.kind === 'done'")
        self.assertEqual(ask("/warehouse")[1]["storage_units"], 160)


if __name__ == "__main__":
    rospy.init_node("test_layout_page")
    rostest.rosrun("warehouse_tests", "layout_page", LayoutPage)
