#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What people want of a running shift takes five steps with mouse and keys at most."""

import rospy
import rostest
from rostest_support.node_test import call, wait_until
from rostest_support.page_test import PageTest, address, ask, fetch
from rostest_support.task import Task

from warehouse_layout.message_enums import FailureKind
from warehouse_msgs.srv import Fail

ORDERS, NUMBER = 60, 17
PICKS = ("pick1", "pick2", "pick3", "pick4")
CARE = "(document.querySelector('#care .reason')?.textContent ?? '')"
FACTS = "document.getElementById('facts').textContent"
MODE = "document.querySelector('#modes [aria-pressed=\"true\"]')?.dataset.mode"
ACTION = ".alarm[data-alarm={}] .remedies > :{}"
# A lit cell [x, y] that nothing hides, in the middle part of the picture.
LIT = """(() => {
  const { lights } = page.cells ?? {}, m = new Float32Array(16);
  for (let i = 0; i < (lights?.count ?? 0); ++i) {
    const [x, y] = lights.instanceMatrix.array.subarray(16 * i + 12, 16 * i + 14);
    const at = page.stage.pixelOf(x, y, 0), [px, py] = at;
    const isSeen = px > 420 && px < innerWidth - 420 && py > 120 && py < innerHeight - 160
      && document.elementFromPoint(px, py) === page.stage.canvas;
    if (isSeen && !page.picker.pick(px, py)) return [x, y];
  }
  return null;
})()"""
# What no person sees: a cell that is not lit, since a unit stands there.
TAKEN = """(() => {
  for (let i = 0; i < page.world.scene.units.length; ++i) {
    if (page.world.carrier[i]) continue;
    const [x, y] = page.world.unitPose.subarray(7 * i, 7 * i + 2);
    const [px, py] = page.stage.pixelOf(x, y, 0);
    if (px > 420 && px < innerWidth - 420 && py > 120 && py < innerHeight - 160) return [x, y];
  }
  return null;
})()"""


class Tasks(PageTest):
    """Tests that run in this order: the stations stay closed until an order was made urgent."""

    ready = "page.world.scene.robots.length >= 20 && page.fleet.runs && page.stage.frames > 2"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        wait_until(lambda: ask("/stations")[0] == 200, "the shift")
        for name in PICKS:
            ask(f"/stations/{name}", {"open": False}, method="PUT")
        for number in range(ORDERS):
            lines = [{"sku": f"sku-{number + 1}", "quantity": 2}]
            assert ask("/orders", {"reference": f"task-{number + 1}", "lines": lines})[0] == 201

    def setUp(self):
        self.floor()

    def floor(self):
        self.page.open("about:blank")
        self.page.open(address())
        self.page.until(self.ready)

    def operations(self):
        self.page.open(f"{address()}operations")
        self.page.until("page.kpis && page.alarms && page.orders.total > 0")

    def test_1_robot_7_is_found_and_followed(self):
        with Task(self.page, "find and follow robot 7") as task:
            task.search("robot 7")
            task.click("#follow")
        self.page.until("page.selected === 'kiva7' && Boolean(page.navigator.followed)")

    def test_2_order_17_becomes_urgent(self):
        self.operations()
        with Task(self.page, "order 17 is urgent") as task:
            task.type("#search", f"task-{NUMBER}")
            self.page.until("page.orders.total === 1")
            task.click(".order-rows .order-name")
            task.click("#order-urgent")
        orders = ask(f"/orders?search=task-{NUMBER}")[1]["orders"]
        number = orders[0]["order_id"]
        wait_until(lambda: ask(f"/orders/{number}")[1]["priority"] == 255, "it is urgent")

    def test_3_robot_3_goes_out_of_service_and_back(self):
        with Task(self.page, "robot 3 out and back") as task:
            task.search("kiva3")
            task.click("[data-mode=OUT_OF_SERVICE]")
            self.page.until(f"{MODE} === 'OUT_OF_SERVICE'")
            self.page.until("document.getElementById('mode').textContent === 'out of service'")
            self.page.until(f"{CARE}.startsWith('is out of service')")
            task.click("[data-mode=AUTOMATIC]")
        self.page.until(f"{MODE} === 'AUTOMATIC'")

    def test_4_why_pick3_waits_is_said_and_is_what_the_api_says(self):
        for name in PICKS:
            ask(f"/stations/{name}", {"open": True}, method="PUT")
        said = lambda: ask("/why/pick3")[1]["text"]  # noqa: E731
        wait_until(lambda: said().startswith("waits for unit"), "a unit comes to pick3")
        with Task(self.page, "why does pick3 wait") as task:
            task.search("pick3")
        self.page.until(f"/why(waits for unit|unit)/.test({FACTS})")
        same = lambda: said().replace("storage_unit", "unit ") in self.page.read(FACTS)  # noqa: E731
        wait_until(lambda: same() or "is there" in self.page.read(FACTS), "the same sentence")

    def test_5_a_station_is_manned_and_closed_where_its_sign_leads(self):
        self.page.read("page.select('pick4')")
        with Task(self.page, "pick4 is manned and closed") as task:
            task.click("[data-station-mode=MANUAL]")
            task.click(".care-acts button:not([hidden])")
        row = lambda: next(  # noqa: E731
            s for s in ask("/stations")[1]["stations"] if s["name"] == "pick4"
        )
        wait_until(lambda: (row()["open"], row()["mode"]) == (False, "MANUAL"), "it is closed")
        self.page.until(
            "document.querySelector('[data-station-mode=MANUAL]').ariaPressed === 'true'"
        )
        ask("/stations/pick4", {"open": True, "mode": "AUTOMATIC"}, method="PUT")

    def test_6_a_robot_more(self):
        robots = ask("/robots")[1]["total"]
        with Task(self.page, "a robot more") as task:
            task.click("#add")
            cell = self.page.until(LIT)
            taken = self.page.read(TAKEN)
            self.page.click(*taken)  # a slip, which is no step of the task
            self.page.until("document.getElementById('tip').textContent.includes('stands there')")
            self.assertEqual(self.page.read("page.selected"), None)
            task.point(*cell)
        wait_until(lambda: ask("/robots")[1]["total"] == robots + 1, "a robot more")
        self.page.until("!page.cells.lights")

    def test_7_a_person(self):
        with Task(self.page, "a person") as task:
            task.click("#add-person")
            task.point(*self.page.until(LIT))
        self.page.until("page.world.scene.scenery.some((name) => name.startsWith('person'))")

    def test_8_a_link_leads_to_the_moment_of_the_last_alarm(self):
        call("/warehouse/fail", Fail, 5, int(FailureKind.MOTOR), 0.0)
        alarms = lambda: [a for a in ask("/alarms")[1]["alarms"] if a["subject"] == "kiva5"]  # noqa: E731
        wait_until(alarms, "an alarm of kiva5")
        since = alarms()[0]["since"]
        rospy.sleep(5.0)  # simulated: the time line has recorded that moment
        self.operations()
        with Task(self.page, "a link to the last alarm's moment") as task:
            task.click(ACTION.format("ROBOT_BROKEN", "last-child"))
            self.page.until("page.timeline && !page.timeline.isLive && page.selected === 'kiva5'")
            task.click("#replay-copy")
        self.page.until("document.getElementById('tip').textContent.includes('link')")
        self.assertAlmostEqual(self.page.read("page.timeline.player.time"), since, delta=1.0)

    def test_9_a_broken_robot_says_so_with_its_events_and_is_mended_on_the_floor(self):
        self.page.read("page.drawers.open('fleet-panel')")
        self.page.until("document.getElementById('alarm-number').textContent >= '1'")
        with Task(self.page, "repair the robot of an alarm") as task:
            task.click("#alarms .alarm .remedies a")
            self.page.until("page.selected === 'kiva5'")
            self.page.until(f"{CARE}.startsWith('is broken (drive)')")
            events = "document.getElementById('own-events').textContent"
            self.page.until(f"{events}.includes('broken') && {events}.includes('alarm')")
            task.click(".care-acts button:not([hidden])")
        gone = lambda: not any(a["subject"] == "kiva5" for a in ask("/alarms")[1]["alarms"])  # noqa: E731
        wait_until(gone, "the alarm goes with its cause")
        past = ask("/alarms/history")[1]
        mended = next(a for a in past["alarms"] if a["subject"] == "kiva5")
        self.assertEqual([action["what"] for action in mended["actions"]], ["Repair"])

    def test_a_todays_orders_come_as_a_sheet(self):
        with Task(self.page, "today's orders to Excel") as task:
            task.click(".site a[href$='/operations']")
            self.page.until("page?.orders?.total > 0")
            task.click("#out-xlsx")
        path = self.page.read("new URL(document.getElementById('out-xlsx').href).pathname")
        self.assertEqual(fetch(path.lstrip("/"))[1][:2], b"PK")


if __name__ == "__main__":
    rospy.init_node("test_tasks")
    rostest.rosrun("warehouse_tests", "tasks", Tasks)
