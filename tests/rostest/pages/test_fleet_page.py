#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Page and HTTP API show a coordinated fleet, and give its robots to a person and back."""

import json

import numpy as np
import rospy
import rostest
from nav_msgs.srv import GetMap
from rostest_support.node_test import Listener, call, latched, wait_until
from rostest_support.page_test import PageTest, ask

from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import GetModelState, SetModelState
from warehouse_msgs.msg import CoordinatorState, Scenery, WarehouseObjects
from warehouse_msgs.srv import PickUp

MODE = "document.querySelector('#modes [aria-pressed=\"true\"]')?.dataset.mode"


def open_place():
    """The middle of five by five free cells without a robot [m]."""
    grid = call("/warehouse/map", GetMap).map
    info = grid.info
    free = np.reshape(grid.data, (info.height, info.width)) == 0
    for row in range(2, info.height - 2):
        for column in range(2, info.width - 2):
            if free[row - 2 : row + 3, column - 2 : column + 3].all():
                origin = info.origin.position
                return (
                    origin.x + (column + 0.5) * info.resolution,
                    origin.y + (row + 0.5) * info.resolution,
                )
    raise AssertionError("there is no open place")


def put(unit, x, y, tilt=0.0):
    """Puts a storage unit there, or throws it over."""
    state = ModelState(model_name=unit, reference_frame="world")
    state.pose.position.x, state.pose.position.y, state.pose.position.z = x, y, 0.5 * tilt
    state.pose.orientation.y, state.pose.orientation.w = np.sin(tilt / 2), np.cos(tilt / 2)
    answer = call("/gazebo/set_model_state", SetModelState, state)
    assert answer.success, answer.status_message


def name_of(index):
    """JavaScript for an item's name."""
    return f"page.world.scene.items[{index}]"


class FleetPage(PageTest):
    ready = "page.world.scene.robots.length === 4 && page.fleet.runs"

    @classmethod
    def setUpClass(cls):
        cls.state = Listener("/warehouse/coordinator", CoordinatorState)
        cls.state.until(lambda state: state.automatic == 4)
        super().setUpClass()

    def tearDown(self):
        self.page.read("page.select(null)")
        super().tearDown()

    def submit(self, unit, **where):
        status, answer = ask("/transports", {"storage_unit": unit, **where})
        self.assertEqual(status, 201, answer)
        return answer["transport_id"]

    def wait_for(self, transport, state):
        """The transport, once it is so far."""
        asked = lambda: ask(f"/transports/{transport}")[1]  # noqa: E731
        wait_until(lambda: asked()["state"] == state, f"transport {transport} {state}")
        return asked()

    def test_a_transport_is_seen_on_its_way_and_is_let_go(self):
        self.page.click_on("ways")
        transport = self.submit(5, station="pick1")
        # Released ways are drawn, and planned ones as well.
        self.page.until("page.routes?.released.visible")
        self.page.until("page.routes?.planned.visible")
        robot = self.wait_for(transport, "LIFTED")["robot"]
        # Another page comes, and gets the scenery again: the coordinator goes on.
        Listener("/warehouse/scenery", Scenery).until()
        self.page.read(f"page.select('{robot}')")
        self.page.until("document.getElementById('facts').textContent.includes('pick1')")
        self.page.until("page.overlays.goal.visible")
        limit = "/[0-9.]+ m.s² at most/.test(document.getElementById('facts').textContent)"
        self.page.until(limit)  # that it keeps for its load
        self.wait_for(transport, "ARRIVED")
        self.page.until(
            "document.getElementById('fleet-facts').textContent.includes('1 delivered')"
        )
        self.assertEqual(ask(f"/transports/{transport}/release", {})[0], 200)
        self.wait_for(transport, "STORED")
        status, state = ask("/coordinator")
        self.assertEqual((status, state["robots"]["automatic"]), (200, 4))
        self.page.click_on("ways")
        self.page.until("!page.routes?.released.visible")

    def test_a_robot_is_given_to_a_person_and_back(self):
        self.page.read("page.select('kiva3')")
        self.page.until(f"{MODE} === 'AUTOMATIC'")
        self.page.until("document.getElementById('mode').textContent === 'automatic'")
        row = "document.querySelector('#robots [data-name=kiva3]')"
        for mode, ids in (("MANUAL", "manual"), ("OUT_OF_SERVICE", "out_of_service")):
            self.page.driver.find_element("css selector", f"[data-mode={mode}]").click()
            self.page.until(f"{MODE} === '{mode}'")
            word = mode.lower().replace("_", " ")
            self.page.until(f"document.getElementById('mode').textContent === '{word}'")
            self.page.until(f"{row}.textContent.includes('kiva3{word}')")
            self.assertEqual(list(getattr(self.state.until(), f"{ids}_kiva")), [3])
            self.assertEqual(ask("/coordinator")[1][ids], [3])
        self.assertEqual(ask("/robots/3/mode", {"mode": "AUTOMATIC"})[0], 200)
        self.page.until(f"{MODE} === 'AUTOMATIC'")

    def test_who_is_commanded_from_the_page_becomes_manual(self):
        self.page.read("page.select('kiva2')")
        self.page.until(f"{MODE} === 'AUTOMATIC'")
        x, y = self.page.read("[...page.world.pose.slice(3, 5)].map(Math.round)")
        self.page.read(f"page.details.go({x}, {y + (3 if y < 0 else -3)}) && true")
        self.page.until(f"{MODE} === 'MANUAL'")
        self.page.until(
            "['done', 'blocked'].includes(document.getElementById('answer').dataset.kind)"
        )
        self.page.driver.find_element("css selector", "[data-mode=AUTOMATIC]").click()
        self.page.until(f"{MODE} === 'AUTOMATIC'")

    def test_items_that_fell_are_seen_and_picked_up(self):
        """Off a unit that is thrown over where nothing else stands."""
        unit = "storage_unit7"
        home = call("/gazebo/get_model_state", GetModelState, unit, "world").pose.position
        put(unit, *open_place(), tilt=0.7)
        fell = latched("/warehouse/objects", WarehouseObjects, lambda objects: objects.fallen_item)
        item = fell.items[fell.fallen_item[0]]
        shown = item.replace("item", "item ")
        self.assertEqual(fell.storage_units[fell.fallen_from[0]], unit)
        self.state.until(lambda s: f"{item} lies on the floor, off {unit}" in s.alarms)
        self.page.until(f"document.getElementById('alarms').textContent.includes('{shown}')")
        self.page.until(f"document.getElementById('labels').textContent.includes('{shown}')")
        self.page.until(
            f"[...document.querySelectorAll('#events [data-trouble]')]"
            f".some((line) => line.textContent.includes('{shown}'))"
        )
        self.page.read(f"page.select('{item}')")
        self.page.until("document.getElementById('facts').textContent.includes('fell off')")
        self.page.click_on("pick-up")
        self.page.until("document.getElementById('tip').textContent.includes('upright')")
        self.assertIn("does not stand upright", call("/warehouse/pick_up", PickUp, item).message)
        put(unit, home.x, home.y)
        self.page.click_on("pick-up")
        self.page.until(f"!page.world.scene.fallen_item.some((i) => {name_of('i')} === '{item}')")
        self.page.until("document.getElementById('facts').textContent.includes('lies on')")
        self.assertEqual(call("/warehouse/pick_up", PickUp, "").message, "")
        latched("/warehouse/objects", WarehouseObjects, lambda objects: not objects.fallen_item)
        self.state.until(lambda s: not s.alarms)
        refused = ask("/items/1/pick_up", {})
        self.assertEqual((refused[0], "no 'item1' has fallen" in refused[1]["detail"]), (409, True))

    def test_what_is_refused_says_why(self):
        for path, body, status, text in (
            ("/transports", {"storage_unit": 999, "station": "pick1"}, 409, "no storage unit 999"),
            ("/transports", {"storage_unit": 1, "station": "moon"}, 409, "no station 'moon'"),
            ("/transports", {"storage_unit": 1}, 422, "either a station or both x and y"),
            ("/transports", {"storage_unit": 1, "x": 1000, "y": 0}, 409, "no robot can stand"),
            ("/transports/77/release", {}, 409, "no transport 77"),
            ("/transports/77", None, 404, "no transport 77"),
            ("/robots/77/mode", {"mode": "MANUAL"}, 404, "no robot kiva77"),
            ("/robots/1/mode", {"mode": "LAZY"}, 422, "mode"),
        ):
            answer = ask(path, body)
            self.assertEqual(answer[0], status, answer)
            self.assertIn(text, json.dumps(answer[1]))


if __name__ == "__main__":
    rospy.init_node("test_fleet_page")
    rostest.rosrun("warehouse_tests", "fleet_page", FleetPage)
