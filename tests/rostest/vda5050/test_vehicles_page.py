#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle that the warehouse does not know is added as a robot on the floor's page: it is seen at
a real broker, placed by a click, driven by the coordinator with its planned path drawn, known to a
master that is restarted, and removed."""

import signal
import subprocess
import tempfile
from pathlib import Path

import rospy
import rostest
from rostest_support import axe
from rostest_support.node_test import call, wait_until
from rostest_support.page_test import PageTest, ask
from rostest_support.warehouse_test import Collector

from warehouse_client.warehouse import WarehouseClient
from warehouse_msgs.msg import CoordinatorState, FleetState, TransportEvent
from warehouse_msgs.srv import ReleaseTransport, SetRobotMode, Transport
from warehouse_vda5050.mqtt.broker import OwnBroker

PATIENCE = 60.0  # [s, wall]
VERSION = "3.0.0"  # which has planned paths
NAME, SERIAL, NUMBER, UNIT = "kiva/2", "2", 5, 7
# Of two vehicles on a floor of 41 x 41 cells the second stands in the middle.
VIRTUAL = ("--vehicles", "2", "--floor", "41x41", "--version", VERSION, "--interval", "0.2")
ROWS = "[...document.querySelectorAll('#vehicle-list li')].map((row) => row.textContent)"
ANSWER = "document.getElementById('vehicle-answer').textContent"


def begin(program, *arguments):
    """Starts a program that ends with this test."""
    command = ["setpriv", "--pdeathsig", "TERM", "rosrun", "warehouse_vda5050", program]
    return subprocess.Popen([*command, *arguments])


class VehiclesPage(PageTest):
    ready = "page.world.scene.robots.length === 4 && page.fleet.runs"

    @classmethod
    def setUpClass(cls):
        cls.fleet = Collector("/warehouse/fleet", FleetState)
        cls.state = Collector("/warehouse/coordinator", CoordinatorState)
        cls.transports = Collector("/warehouse/transports", TransportEvent)
        cls.state.first(lambda state: state.automatic == 4, PATIENCE)
        warehouse = WarehouseClient(rospy)
        wait_until(lambda: warehouse.is_known, "the warehouse")
        cls.plan = warehouse.plan()
        cls.broker = OwnBroker()
        address = f"localhost:{cls.broker.port}"
        cls.virtual = begin("virtual", "--broker", address, *VIRTUAL)
        cls.file = Path(tempfile.mkdtemp()) / "robots.yaml"
        cls.file.write_text("99: {manufacturer: acme, serial: 'away'}\n")
        for name, value in (("robots", cls.file), ("version", VERSION), ("broker", address)):
            rospy.set_param(f"/vda5050_master/{name}", str(value))
        cls.master = begin("master")
        super().setUpClass()
        cls.page.read("localStorage.setItem('person', 'Ann') ?? true")
        cls.page.click_on("top")

    @classmethod
    def tearDownClass(cls):
        for program in (cls.master, cls.virtual):
            program.send_signal(signal.SIGINT)
            program.wait(20)
        cls.broker.close()
        super().tearDownClass()

    def numbers(self):
        return {*self.fleet.messages[-1].kiva_id}

    def cell(self):
        """The middle of a free parking cell [m]."""
        fleet = self.fleet.messages[-1]
        taken = {int(cell) for cell in self.plan.cell_of(fleet.x, fleet.y)}
        free = [c for c in self.plan.parking.ravel().nonzero()[0].tolist() if c not in taken]
        x, y = self.plan.point_of(free[0])
        return float(x), float(y)

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
        for number in (1, 2, 3, 4):
            call("/warehouse/set_robot_mode", SetRobotMode, kiva_id=number, mode=2)
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
        self.master.send_signal(signal.SIGINT)
        self.master.wait(20)
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
