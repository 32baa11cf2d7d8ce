#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle behind a broker as a robot of the fleet: the coordinator has it carry a storage unit,
among simulated robots; when it falls silent it is an obstacle, and it comes back."""

import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import rospy
import rostest
from rostest_support.node_test import call, latched, wait_until
from rostest_support.warehouse_test import Collector

from warehouse_client.warehouse import WarehouseClient
from warehouse_layout.message_enums import FailureKind
from warehouse_msgs.msg import CoordinatorState, Event, FleetState, TransportEvent, Vda5050
from warehouse_msgs.srv import SetRobotMode, Transport
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.topics import Identity, Topics, prefix_of
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "unit" / "python" / "vda5050"))

from grid_robot import GridRobot

NUMBER = 21
CELL_TIME = 0.3  # that the vehicle takes for a cell [s, wall]
PATIENCE = 60.0  # [s, wall] of a transport
RADIO = 1 << FailureKind.RADIO_LOST


class MetricRobot(GridRobot):
    """A GridRobot on the cells of a Grid: its points are in metres."""

    def __init__(self, grid, cell):
        super().__init__(cell)
        self.grid = grid

    def follow(self, path_id, first, points, released):
        cells = [self.grid.cell_at(*point) for point in points]
        super().follow(path_id, first, cells, released)

    def report(self):
        x, y = self.grid.position(self.cell)
        self.extra |= {"x": x, "y": y}
        return super().report()

    def lift(self, unit, up):
        self.units = {unit: self.cell} if up else {}
        super().lift(unit, up)


class Behind(threading.Thread):
    """The vehicle, with its connection, in a thread of its own."""

    def __init__(self, robot, port, version="2.1.0"):
        super().__init__(daemon=True)
        self.robot = robot
        self.vehicle = Vehicle(robot, robot.grid, VehicleSettings(zones=version == "3.0.0"))
        who, broker = Identity("acme", "7"), BrokerSettings("localhost", port)
        topics = Topics(prefix_of(version))
        self.link = VehicleLink(self.vehicle, who, codec_for(version), topics, broker)
        self.ended = threading.Event()
        self.silent = False

    def run(self):
        loop, due = MqttLoop(), 0.0
        loop.add(self.link.link)
        while not self.ended.is_set():
            loop.poll(0.02)
            if time.monotonic() >= due:
                due = time.monotonic() + CELL_TIME
                self.robot.step()
            self.robot.extra["heard"] = not self.silent
            self.link.tick(time.monotonic())


class VehicleCase(unittest.TestCase):
    """A warehouse, a broker with one vehicle, and the master between them."""

    VERSION = "2.1.0"
    ROBOT = MetricRobot

    @classmethod
    def setUpClass(cls):
        cls.fleet = Collector("/warehouse/fleet", FleetState)
        cls.state = Collector("/warehouse/coordinator", CoordinatorState)
        cls.events = Collector("/warehouse/events", Event)
        cls.transports = Collector("/warehouse/transports", TransportEvent)
        cls.state.first(lambda state: state.automatic == 4, PATIENCE)
        warehouse = WarehouseClient(rospy)
        wait_until(lambda: warehouse.is_known, "the warehouse")
        cls.plan = warehouse.plan()
        cls.broker = OwnBroker()
        robot = cls.ROBOT(grid_of(read_map()), cls.free_place())
        cls.behind = Behind(robot, cls.broker.port, cls.VERSION)
        cls.behind.start()
        cls.start_master()

    @classmethod
    def tearDownClass(cls):
        cls.node.send_signal(signal.SIGINT)
        cls.node.wait(20)
        cls.behind.ended.set()
        cls.broker.close()

    @classmethod
    def free_place(cls):
        """A parking cell without a robot, as (column, row)."""
        return cls.free_places()[0]

    @classmethod
    def free_places(cls):
        """The parking cells without a robot, as (column, row)."""
        fleet = cls.fleet.messages[-1]
        taken = {int(cell) for cell in cls.plan.cell_of(fleet.x, fleet.y)}
        rows, columns = cls.plan.shape
        free = cls.plan.parking.ravel().nonzero()[0]
        return [(int(c) % columns, int(c) // columns) for c in free if int(c) not in taken]

    @classmethod
    def start_master(cls):
        file = Path(tempfile.mkdtemp()) / "robots.yaml"
        file.write_text(f"{NUMBER}: {{manufacturer: acme, serial: '7'}}\n")
        rospy.set_param("/vda5050_master/robots", str(file))
        rospy.set_param("/vda5050_master/version", cls.VERSION)
        rospy.set_param("/vda5050_master/broker", f"localhost:{cls.broker.port}")
        command = ["setpriv", "--pdeathsig", "TERM", "rosrun", "warehouse_vda5050", "master"]
        cls.node = subprocess.Popen(command)

    def row(self):
        """What the fleet tells of the vehicle last, as {field: value}; {} if it is not there."""
        fleet = self.fleet.messages[-1]
        if NUMBER not in fleet.kiva_id:
            return {}
        i = list(fleet.kiva_id).index(NUMBER)
        names = ("x", "y", "status", "failures", "shelf_id", "path_id")
        return {name: getattr(fleet, name)[i] for name in names}

    def broken(self):
        return bool(bytes(self.fleet.messages[-1].failures)[self.index()] & RADIO)

    def index(self):
        return list(self.fleet.messages[-1].kiva_id).index(NUMBER)


class Master(VehicleCase):
    def test_1_it_stands_where_the_vehicle_is(self):
        wait_until(self.row, "the vehicle's shadow", PATIENCE)
        x, y = self.behind.robot.grid.position(self.behind.robot.cell)
        wait_until(lambda: (self.row()["x"], self.row()["y"]) == (x, y), "its place")
        driven_by = latched("/warehouse/vda5050", Vda5050, lambda m: bytes(m.connection) == b"\0")
        self.assertEqual((driven_by.direction, driven_by.kiva_id), (Vda5050.MASTER, (NUMBER,)))
        self.assertEqual((driven_by.manufacturer, driven_by.serial), (["acme"], ["7"]))

    def test_2_the_coordinator_has_it_carry_a_unit(self):
        self.state.first(lambda state: state.automatic == 5, PATIENCE)
        for number in (1, 2, 3, 4):
            call("/warehouse/set_robot_mode", SetRobotMode, kiva_id=number, mode=2)
        answer = call("/warehouse/transport", Transport, shelf_id=7, station="pick1", then=0)
        self.assertTrue(answer.accepted, answer.message)
        self.transports.first(lambda e: e.kind == TransportEvent.ARRIVED, PATIENCE)
        self.assertEqual(self.row()["shelf_id"], 7)
        self.assertEqual([kind for kind, *_ in self.behind.robot.events if kind != "at"], ["pick"])
        contacts = [e.text for e in self.events.messages if e.kind == Event.COLLISION]
        self.assertEqual(contacts, [])

    def test_3_a_silent_vehicle_is_an_obstacle_until_it_is_heard(self):
        self.behind.silent = True
        wait_until(self.broken, "it is not heard")
        self.state.first(lambda state: any("kiva21" in alarm for alarm in state.alarms), PATIENCE)
        self.behind.silent = False
        wait_until(lambda: not self.broken(), "it is heard again")


if __name__ == "__main__":
    rospy.init_node("behind_a_broker")
    latched("/warehouse/coordinator", CoordinatorState)
    rostest.rosrun("warehouse_tests", "behind_a_broker", Master)
