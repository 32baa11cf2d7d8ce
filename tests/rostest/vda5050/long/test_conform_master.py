#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Our master conforms, with the coordinator of a running warehouse behind it."""

import subprocess
import tempfile
import threading
import unittest
from pathlib import Path
from xml.etree import ElementTree

import rospy
import rostest
from rostest_support.node_test import call, wait_until
from rostest_support.warehouse_test import Collector

from warehouse_client.warehouse import WarehouseClient
from warehouse_layout.message_enums import RobotMode
from warehouse_msgs.msg import CoordinatorState, FleetState
from warehouse_msgs.srv import SetRobotMode
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.ros.floor import grid_of, read_map

NUMBERS = (21, 22)
LONGEST, PATIENCE = 1400.0, 60.0  # of all cases, and of the warehouse's beginning [s]
ATTENTION = 15.0  # time that an operator leaves a robot MANUAL [s]
# Some of each kind of accident, and whatever judges the messages of the run.
TRIED = (
    *("modes.manual", "modes.fatal", "modes.pushed", "errors.order", "errors.goes_on"),
    *("states.stale", "horizon"),
    *("connection", "limits", "actions", "instant", "order", "update", "messages"),
)
# What a warehouse at work does not come to by itself: no person cancels and pauses; and for a while
# no pick, once the vehicles have said that they can't lift.
NOT_SEEN = {
    "actions.failed_pick",
    "instant.cancel_then_new",
    "instant.cancel_with_order",
    "instant.pause_ends",
}


def started(*command):
    return subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *map(str, command)])


class Operator(threading.Thread):
    """Makes robots AUTOMATIC again that the coordinator has put aside, as its alarms ask."""

    def __init__(self):
        super().__init__(daemon=True)
        self.ended = threading.Event()

    def run(self):
        while not self.ended.wait(ATTENTION):
            for number in NUMBERS:
                call(
                    "/warehouse/set_robot_mode",
                    SetRobotMode,
                    kiva_id=number,
                    mode=RobotMode.AUTOMATIC,
                )


class ConformMaster(unittest.TestCase):
    VERSION, TRIED, NOT_SEEN = "2.1.0", TRIED, NOT_SEEN

    def operators(self):
        """Who is at work in the warehouse meanwhile."""
        return [Operator()]

    def free_cells(self):
        """Parking cells that no robot is near, as (column, row), once all stand still."""
        fleet, state = Collector("/warehouse/fleet", FleetState), CoordinatorState
        Collector("/warehouse/coordinator", state).first(lambda s: s.automatic == 4, PATIENCE)
        for number in (1, 2, 3, 4):  # before any has lifted something
            out = RobotMode.OUT_OF_SERVICE
            call("/warehouse/set_robot_mode", SetRobotMode, kiva_id=number, mode=out)
        warehouse = WarehouseClient(rospy)
        wait_until(lambda: warehouse.is_known, "the warehouse")
        plan, robots = warehouse.plan(), fleet.first(lambda m: not any(m.status), PATIENCE)
        taken = {int(cell) for cell in plan.cell_of(robots.x, robots.y)}
        columns = plan.shape[1]
        free = [int(c) for c in plan.parking.ravel().nonzero()[0] if int(c) not in taken]
        return [(cell % columns, cell // columns) for cell in free[: len(NUMBERS)]]

    def test_all_cases(self):
        folder = Path(tempfile.mkdtemp(prefix="conform_master"))
        cells = self.free_cells()
        grid, played, lines = grid_of(read_map()), [], []
        for number, cell in zip(NUMBERS, cells):
            x, y = grid.position(cell)
            played.append(f"acme/{number}@{x},{y},0,{grid.node_id(cell)}")
            lines.append(f"{number}: {{manufacturer: acme, serial: '{number}'}}\n")
        (folder / "robots.yaml").write_text("".join(lines))
        operators = self.operators()
        with OwnBroker() as broker:
            address = f"localhost:{broker.port}"
            conform = started(
                *("rosrun", "warehouse_vda5050", "conform", "--broker", address, "--master"),
                *("--play", *played, "--out", folder, "--strict", "--patience", "120"),
                *("--version", self.VERSION, "--only", *self.TRIED),
            )
            master = started(
                *("roslaunch", "warehouse_vda5050", "master.launch", f"broker:={address}"),
                *(f"robots:={folder / 'robots.yaml'}", f"version:={self.VERSION}"),
            )
            try:
                for operator in operators:
                    operator.start()
                code = conform.wait(LONGEST)
            finally:
                for operator in operators:
                    operator.ended.set()
                conform.kill()
                master.terminate()
                master.wait(30)
        self.judge(folder, code)

    def judge(self, folder, code):
        cases = [*ElementTree.parse(folder / "junit.xml").getroot().iter("testcase")]
        differs = [
            (case.get("name"), case.find("failure").get("message"))
            for case in cases
            if case.find("failure") is not None
        ]
        skipped = {
            case.get("name").partition(" ")[0]: case.find("skipped").get("message")
            for case in cases
            if case.find("skipped") is not None
        }
        self.assertEqual((code, differs), (0, []))
        self.assertLessEqual(skipped.keys(), self.NOT_SEEN, skipped)


if __name__ == "__main__":
    rospy.init_node("test_conform_master")
    rostest.rosrun("warehouse_tests", "conform_master", ConformMaster)
