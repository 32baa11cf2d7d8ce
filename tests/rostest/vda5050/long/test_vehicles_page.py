#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle that the warehouse does not know is added as a robot on the floor's page: it is seen at
a real broker, placed by a click, driven by the coordinator with its planned path drawn, known to a
master that is restarted, and removed."""

import rospy
import rostest
from rostest_support import axe
from rostest_support.behind_broker import (
    OUT_OF_SERVICE,
    PATIENCE,
    BrokerCase,
    begin,
    end,
    set_modes,
)
from rostest_support.node_test import call, wait_until
from rostest_support.page_test import PageTest, ask

from warehouse_msgs.msg import TransportEvent
from warehouse_msgs.srv import ReleaseTransport, Transport

VERSION = "3.0.0"  # which has planned paths
NAME, SERIAL, NUMBER, UNIT = "kiva/2", "2", 5, 7
# Of two vehicles on a floor of 41 x 41 cells the second stands in the middle.
VIRTUAL = ("--vehicles", "2", "--floor", "41x41", "--version", VERSION, "--interval", "0.2")
ROWS = "[...document.querySelectorAll('#vehicle-list li')].map((row) => row.textContent)"
ANSWER = "document.getElementById('vehicle-answer').textContent"


class VehiclesPage(BrokerCase, PageTest):
    VERSION = VERSION
    ready = "page.world.scene.robots.length === 4 && page.fleet.runs"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.start_master("99: {manufacturer: acme, serial: 'away'}\n")
        # A vehicle reports its place as it comes, and then, standing, every half a minute: a master
        # that is there before hears the first report.
        wait_until(lambda: ask("/vda5050")[1], "the master", PATIENCE)
        cls.virtual = begin("virtual", "--broker", f"localhost:{cls.broker.port}", *VIRTUAL)
        cls.addClassCleanup(end, cls.virtual)
        cls.page.read("localStorage.setItem('person', 'Ann') ?? true")
        cls.page.click_on("top")

    def numbers(self):
        return {*self.fleet.messages[-1].kiva_id}

    def cell(self):
        """The middle of a free parking cell [m]."""
        return self.free_points()[0]

    def press(self, text):
        """Presses the button with that text in the row of the vehicle."""
        self.page.until(
            f"[...document.querySelectorAll('#vehicle-list li')].some((row) =>"
            f" row.textContent.startsWith('{NAME}') && row.textContent.includes('{text}')"
            " && (row.querySelector('button').click() ?? true))"
        )

    def test_1_vehicles_at_the_broker_are_listed_with_what_they_can(self):
        self.page.until("(page.vehicles.look(), !document.getElementById('add-vehicle').hidden)")
        self.page.read("document.getElementById('add-vehicle').click() ?? true")
        self.page.until(f"{ROWS}.length === 2")
        self.page.until(f"{ROWS}[1].startsWith('{NAME}online, AUTOMATIC, at 20')")
        self.press("Add…")
        abilities = "document.getElementById('vehicle-abilities').textContent"
        self.page.until(f"{abilities}.includes('it drives at up to 1.5 m/s')")
        self.page.until(f"{abilities}.includes('pick, drop')")
        if axe.is_there():
            self.assertEqual(axe.findings(self.page), [])

    def test_2_what_can_not_be_is_refused_in_a_sentence(self):
        x, y = self.cell()
        for fields, why in (
            ({"id": 1, "x": x, "y": y}, "number 1 is taken: kiva1 is there already"),
            ({"id": 99, "x": x, "y": y}, "number 99 is taken: kiva99 is there already"),
            ({"x": 400.0, "y": y}, "that is off the floor"),
            ({"x": self.fleet.messages[-1].x[0], "y": self.fleet.messages[-1].y[0]}, "kiva1 stand"),
            ({"x": x, "y": y, "heading": 0.7}, "it has to be along an axis"),
            ({"x": x, "y": y, "serial": "17"}, "kiva/17 was never seen at"),
        ):
            status, answer = ask(
                "/vda5050/vehicles", {"manufacturer": "kiva", "serial": SERIAL} | fields
            )
            self.assertEqual(status, 409, answer)
            self.assertIn(why, answer["detail"])
        self.page.click_on("vehicle-yes")
        self.page.until(f"{ANSWER}.includes('click the cell where it stands')")

    def test_3_it_is_placed_by_a_click_and_becomes_a_robot(self):
        x, y = self.cell()
        self.page.click(x, y)
        values = (
            "['x', 'y'].map((name) => document.getElementById(`vehicle-${name}`).valueAsNumber)"
        )
        self.page.until(f"String({values}) === '{x:g},{y:g}'")
        # Cells are counted otherwise on its own map: ids in its own form are no cells of ours.
        self.page.read("(document.getElementById('vehicle-nodes').value = 'n{column}x{row}') || 1")
        self.page.click_on("vehicle-yes")
        self.page.until(f"{ANSWER}.startsWith('{NAME} is kiva{NUMBER}; its map begins at')")
        wait_until(lambda: NUMBER in self.numbers(), "the robot", PATIENCE)
        self.state.first(lambda state: state.automatic == 5, PATIENCE)
        fleet = self.fleet.messages[-1]
        row = list(fleet.kiva_id).index(NUMBER)
        self.assertAlmostEqual(fleet.x[row], x, 3)
        self.assertAlmostEqual(fleet.y[row], y, 3)
        status, answer = ask(
            "/vda5050/vehicles", {"manufacturer": "kiva", "serial": SERIAL, "x": x, "y": y}
        )
        self.assertEqual((status, answer["detail"]), (409, f"{NAME} is kiva{NUMBER} already"))
        commands = [row for row in ask("/commands")[1]["commands"] if row["status"] == 201]
        self.assertEqual((commands[-1]["by"], commands[-1]["path"]), ("Ann", "/vda5050/vehicles"))

    def test_4_the_coordinator_drives_it_and_its_planned_path_is_drawn(self):
        set_modes(OUT_OF_SERVICE)
        self.page.read(f"page.select('kiva{NUMBER}') ?? true")
        answer = call("/warehouse/transport", Transport, shelf_id=UNIT, station="pick1", then=0)
        self.assertTrue(answer.accepted, answer.message)
        self.page.until("page.planned?.line.count > 0")
        (robot,) = [row for row in ask("/vda5050")[1] if row["id"] == NUMBER]
        self.assertEqual(robot["driven_by"], "COORDINATOR")
        arrived = self.transports.first(lambda e: e.kind == TransportEvent.ARRIVED, PATIENCE)
        self.assertEqual((arrived.kiva_id, arrived.shelf_id), (NUMBER, UNIT))
        call("/warehouse/release_transport", ReleaseTransport, transport_id=answer.transport_id)
        self.transports.first(lambda e: e.kind == TransportEvent.STORED, PATIENCE)
        self.page.until("!page.planned.line.count")

    def test_5_a_master_that_is_restarted_knows_it(self):
        end(self.master)
        wait_until(lambda: not ask("/vda5050")[1], "no master", PATIENCE)
        type(self).master = begin("master")
        wait_until(
            lambda: (
                [r["id"] for r in ask("/vda5050")[1] if r["connection"] == "ONLINE"] == [NUMBER]
            ),
            "the vehicle after a restart",
            PATIENCE,
        )

    def test_6_it_is_removed(self):
        status, answer = ask(f"/robots/{NUMBER}", method="DELETE")
        why = f"kiva{NUMBER} is a vehicle at a broker: remove it among vehicles"
        self.assertEqual((status, answer["detail"]), (409, why))
        self.press("Remove")
        self.page.click_on("question-yes")
        self.page.until(f"{ANSWER} === 'kiva{NUMBER} is no robot here any more'")
        wait_until(lambda: NUMBER not in self.numbers(), "no robot", PATIENCE)
        self.page.until(f"{ROWS}[1].startsWith('{NAME}online') && {ROWS}[1].endsWith('Add…')")
        status, answer = ask(f"/vda5050/vehicles/{NUMBER}", method="DELETE")
        self.assertEqual(status, 409)
        self.assertEqual(answer["detail"], f"kiva{NUMBER} is no vehicle of this master")


if __name__ == "__main__":
    rospy.init_node("vehicles_page")
    rostest.rosrun("warehouse_tests", "vehicles_page", VehiclesPage)
