#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Our vehicle conforms: all cases, in a running warehouse, with its connection cut."""

import socket
import subprocess
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import rospy
import rostest
from rostest_support.node_test import latched

from warehouse_msgs.msg import WarehouseState
from warehouse_vda5050.mqtt.broker import OwnBroker

LONGEST = 800.0  # [s]


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def started(*command):
    return subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *map(str, command)])


class Conform(unittest.TestCase):
    def test_all_cases(self):
        latched("/warehouse/state", WarehouseState, lambda state: state.kivas)
        proxy, folder = free_port(), Path(tempfile.mkdtemp(prefix="conform"))
        with OwnBroker(free_port()) as broker:
            address = f"127.0.0.1:{broker.port}"
            conform = started(
                *("rosrun", "warehouse_vda5050", "conform", "--broker", address, "--strict"),
                *("--vehicle", "kiva/1", "--heading", "0", "--proxy", proxy, "--out", folder),
            )
            vehicles = started(
                *("roslaunch", "warehouse_vda5050", "vehicles.launch"), f"broker:=127.0.0.1:{proxy}"
            )
            try:
                code = conform.wait(LONGEST)
            finally:
                conform.kill()
                vehicles.terminate()
                vehicles.wait(30)
        root = ElementTree.parse(folder / "junit.xml").getroot()
        differs = [
            (case.get("name"), case.find("failure").get("message"))
            for case in root.iter("testcase")
            if case.find("failure") is not None
        ]
        skipped = [
            case.get("name") for case in root.iter("testcase") if case.find("skipped") is not None
        ]
        self.assertEqual((code, differs), (0, []))
        self.assertEqual(len(skipped), 1, skipped)  # connection.offline


if __name__ == "__main__":
    rospy.init_node("test_conform")
    rostest.rosrun("warehouse_tests", "conform", Conform)
