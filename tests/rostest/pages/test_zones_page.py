#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Zones are drawn on the floor's page by mouse, by a finger and by typed corners, seen there, over
HTTP and among the events, and opened."""

import json

import rospy
import rostest
from rostest_support import axe
from rostest_support.node_test import Listener, call, wait_until
from rostest_support.page_test import PageTest, ask

from warehouse_msgs.msg import CoordinatorState
from warehouse_msgs.srv import OpenZone

SHOWN = "document.querySelector('#labels .sign.waiting:not([hidden])')"
WAITS = "document.getElementById('zone-waits').textContent"
CORNERS = (
    "['x1', 'y1', 'x2', 'y2'].map((name) => document.getElementById(`zone-${name}`).valueAsNumber)"
)


def zones():
    return ask("/zones")[1]["zones"]


class ZonesPage(PageTest):
    ready = "page.world.scene.robots.length === 4 && page.fleet.runs"

    @classmethod
    def setUpClass(cls):
        Listener("/warehouse/coordinator", CoordinatorState).until(lambda s: s.automatic == 4)
        super().setUpClass()
        cls.page.read("localStorage.setItem('person', 'Ann') ?? true")
        cls.page.click_on("top")

    def setUp(self):
        if (
            self.page.read("document.getElementById('zone').getAttribute('aria-pressed')")
            == "false"
        ):
            self.page.read("document.getElementById('zone').click() ?? true")
        self.page.until("page.zoneTool?.isOn && Boolean(page.zones)")

    def tearDown(self):
        for zone in zones():
            ask(f"/zones/{zone['id']}", method="DELETE")
        super().tearDown()

    def drag(self, begin, end):
        """Draws with the mouse from one cell to another."""
        points = [self.page.pixel(*begin), self.page.pixel(*end)]
        for kind, (x, y) in (
            ("mousePressed", points[0]),
            ("mouseMoved", points[1]),
            ("mouseReleased", points[1]),
        ):
            event = {"type": kind, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1}
            self.page.driver.execute_cdp_cmd("Input.dispatchMouseEvent", event)

    def close(self, reason):
        self.page.type(reason, "zone-reason")
        self.page.click_on("zone-yes")
        wait_until(lambda: any(zone["reason"] == reason for zone in zones()), f"zone {reason}")

    def test_a_zone_is_drawn_by_mouse_seen_and_opened(self):
        unit = self.page.read("page.world.placeOf({kind: 'unit', index: 0}).slice(0, 2)")
        x, y = map(round, unit)
        before = self.page.read("page.stage.camera.position.toArray()")
        self.drag((x, y), (x + 2, y + 1))
        self.page.until(f"String({CORNERS}) === '{x},{y},{x + 2},{y + 1}'")
        self.assertEqual(self.page.read("page.stage.camera.position.toArray()"), before)
        self.page.until(f"/units .* can't be fetched/.test({WAITS})")
        self.assertEqual(zones(), [], "what is drawn is not closed yet")
        self.close("spill")
        [zone] = zones()
        self.assertEqual(zone["closed_by"], "Ann")
        self.assertEqual(
            [zone[name] for name in ("x_min", "y_min", "x_max", "y_max")],
            [x - 0.5, y - 0.5, x + 2.5, y + 1.5],
        )
        self.assertAlmostEqual(zone["until"] - zone["since"], 300, places=2)
        self.page.until(
            f"{SHOWN}?.textContent === 'spill' && /min left/.test({SHOWN}.dataset.note)"
        )
        self.page.until(
            "[...document.querySelectorAll('#events li')].some((line) =>"
            " line.textContent.includes(\"zone 'spill'\") && line.textContent.includes('Ann'))"
        )
        self.page.until("document.querySelectorAll('#zone-list li').length === 1")
        if axe.is_there():
            self.assertEqual(axe.findings(self.page), [])
        commands = [row for row in ask("/commands")[1]["commands"] if row["path"] == "/zones"]
        self.assertEqual((commands[-1]["by"], commands[-1]["method"]), ("Ann", "POST"))
        status, answer = ask("/transports", {"storage_unit": 1, "station": "pick1"})
        self.assertEqual(status, 201, answer)
        number = answer["transport_id"]
        why = "unit 1 stands in the closed zone 'spill'"
        wait_until(lambda: ask(f"/transports/{number}")[1].get("text") == why, why)
        self.page.driver.find_element("css selector", "#zone-list button").click()
        wait_until(lambda: not zones(), "the zone is open")
        self.page.until(f"!{SHOWN} && !document.querySelector('#zone-list li')")
        wait_until(lambda: ask(f"/transports/{number}")[1]["state"] == "ARRIVED", "unit 1 comes")
        ask(f"/transports/{number}/release", {})

    def test_a_finger_draws_and_the_camera_stays(self):
        points = [tuple(self.page.pixel(*cell)) for cell in ((-4, 4), (-3, 4), (-2, 3))]
        before = self.page.read("page.stage.camera.position.toArray()")
        self.page.swipe(points)
        self.page.until(f"String({CORNERS}) === '-4,4,-2,3'")
        self.assertEqual(self.page.read("page.stage.camera.position.toArray()"), before)

    def test_corners_are_typed_and_faults_are_told_beside_them(self):
        for name, keys in (("x1", "-3"), ("y1", "3"), ("x2", "-2"), ("y2", "400")):
            field = self.page.driver.find_element("id", f"zone-{name}")
            field.clear()
            field.send_keys(keys)
        answer = "document.getElementById('zone-answer').textContent"
        self.page.until(f"{answer}.includes('(x2, y2) is (-2, 400), which is off the floor')")
        field.clear()
        field.send_keys("3")
        self.page.until(f"!{answer}")
        self.page.click_on("zone-yes")
        self.page.until(f"{answer}.includes('why is it closed?')")
        self.close("paint")
        self.page.driver.find_element("id", "zone-reason").send_keys("\ue00c")  # Escape
        self.page.until("!page.zoneTool.isOn && !page.zones.draft.visible")

    def test_what_is_refused_says_why(self):
        good = {"x1": 0, "y1": 0, "x2": 1, "y2": 1, "reason": "spill"}
        for path, body, status, text in (
            ("/zones", good | {"x2": 1000}, 409, "(x2, y2) is (1000, 1), which is off the floor"),
            ("/zones", good | {"duration": -1}, 422, "duration"),
            ("/zones", good | {"reason": ""}, 422, "reason"),
            ("/zones", good | {"x1": "NaN"}, 422, "x1"),
        ):
            answer = ask(path, body)
            self.assertEqual(answer[0], status, answer)
            self.assertIn(text, json.dumps(answer[1]))
        status, answer = ask("/zones/77", method="DELETE")
        self.assertEqual((status, answer["detail"]), (409, "there is no closed zone 77"))
        self.assertEqual(ask("/zones/check?x1=nan&y1=0&x2=0&y2=0")[0], 422)

    def test_a_call_of_a_service_is_told_with_its_node(self):
        call("/warehouse/open_zone", OpenZone, zone_id=77, by="Ann")

        def mine():
            rows = ask("/commands")[1]["commands"]
            return [row for row in rows if row["by"] == rospy.get_name()]

        wait_until(mine, "the journal to have the call")
        row = mine()[-1]
        self.assertEqual((row["method"], row["path"]), ("SERVICE", "/warehouse/open_zone"))
        self.assertEqual(json.loads(row["body"])["zone_id"], 77)
        ask("/zones/77", method="DELETE")
        self.assertFalse([r for r in ask("/commands")[1]["commands"] if r["by"] == "/viewer"])


if __name__ == "__main__":
    rospy.init_node("test_zones_page")
    rostest.rosrun("warehouse_tests", "zones_page", ZonesPage)
