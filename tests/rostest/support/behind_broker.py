# SPDX-License-Identifier: Apache-2.0
"""What tests of vehicles behind a broker share: a running warehouse with its coordinator, a broker,
vehicles there in a thread of their own, and our master between them."""

import signal
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path
from queue import SimpleQueue

import rospy
from rostest_support.node_test import call, wait_until
from rostest_support.warehouse_test import Collector

from warehouse_client.warehouse import WarehouseClient
from warehouse_msgs.msg import CoordinatorState, Event, FleetState, TransportEvent
from warehouse_msgs.srv import SetRobotMode
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.faults.kinds import read_request
from warehouse_vda5050.faults.vehicle_faults import VehicleFaults
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.topics import Identity, Topics, prefix_of
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings

NUMBER, SERIAL = 21, "7"  # of the vehicle, where there is one
SIMULATED = (1, 2, 3, 4)  # the robots of the size small
AUTOMATIC, MANUAL, OUT_OF_SERVICE = 0, 1, 2
PATIENCE = 60.0  # [s, wall]
STEP = 0.01  # at most between two steps of a robot [s, wall]


def begin(program, *arguments):
    """Starts a program of warehouse_vda5050 that ends with this test."""
    command = ["setpriv", "--pdeathsig", "TERM", "rosrun", "warehouse_vda5050", program]
    return subprocess.Popen([*command, *arguments])


def end(program):
    """Ends a program as Ctrl-C does."""
    program.send_signal(signal.SIGINT)
    program.wait(20)


def set_modes(mode, *numbers):
    for number in numbers or SIMULATED:
        call("/warehouse/set_robot_mode", SetRobotMode, kiva_id=number, mode=mode)


class Behind(threading.Thread):
    """A robot as a vehicle at a broker, in a thread of its own; faults on demand are its own, too.

    The robot is a Driver with step(seconds).
    """

    def __init__(self, robot, grid, port, version="2.1.0", serial=SERIAL):
        super().__init__(daemon=True)
        self.robot, self.ended = robot, threading.Event()
        self._posted = SimpleQueue()
        self._faults = VehicleFaults(robot, lambda _text, _begins: None)
        settings = VehicleSettings(zones=version == "3.0.0")
        self.vehicle = Vehicle(self._faults.driver, grid, settings)
        who, broker = Identity("acme", serial), BrokerSettings("localhost", port)
        topics = Topics(prefix_of(version))
        self.link = VehicleLink(self.vehicle, who, codec_for(version), topics, broker, self._faults)

    def run(self):
        loop, before = MqttLoop(), time.monotonic()
        loop.add(self.link.link)
        while not self.ended.is_set():
            loop.poll(STEP)
            while not self._posted.empty():
                self._posted.get()()
            before, now = time.monotonic(), before
            self.robot.step(before - now)
            self.link.tick(before)

    def do(self, call, *args):
        """Has the thread make a call between two steps."""
        self._posted.put(lambda: call(*args))

    def fault(self, name):
        """Begins a fault on demand; ends all of them with an empty name."""
        self.do(self._faults.active.begin, read_request(name, 0.0), time.monotonic())


class BrokerCase(unittest.TestCase):
    """A warehouse of the size small, and a broker. `fleet`, `state`, `events` and `transports`
    collect what the world and the coordinator publish."""

    VERSION = "2.1.0"

    @classmethod
    def setUpClass(cls):
        cls.fleet = Collector("/warehouse/fleet", FleetState)
        cls.state = Collector("/warehouse/coordinator", CoordinatorState)
        cls.events = Collector("/warehouse/events", Event)
        cls.transports = Collector("/warehouse/transports", TransportEvent)
        cls.state.first(lambda state: state.automatic == len(SIMULATED), PATIENCE)
        warehouse = WarehouseClient(rospy)
        wait_until(lambda: warehouse.is_known, "the warehouse")
        cls.plan, cls.grid = warehouse.plan(), grid_of(read_map())
        cls.broker, cls.vehicles = OwnBroker(), []
        super().setUpClass()

    @classmethod
    def tearDownClass(cls):
        super().tearDownClass()
        end(cls.master)
        for vehicle in cls.vehicles:
            vehicle.ended.set()
        cls.broker.close()

    @classmethod
    def add_vehicle(cls, robot, serial=SERIAL):
        """Puts a robot at the broker."""
        behind = Behind(robot, cls.grid, cls.broker.port, cls.VERSION, serial)
        cls.vehicles.append(behind)
        behind.start()
        return behind

    @classmethod
    def start_master(cls, robots=f"{NUMBER}: {{manufacturer: acme, serial: '{SERIAL}'}}\n"):
        """Starts our master with a file of robots."""
        file = Path(tempfile.mkdtemp()) / "robots.yaml"
        file.write_text(robots)
        broker = f"localhost:{cls.broker.port}"
        for name, value in (("robots", file), ("version", cls.VERSION), ("broker", broker)):
            rospy.set_param(f"/vda5050_master/{name}", str(value))
        cls.master = begin("master")

    @classmethod
    def free_places(cls):
        """The parking cells without a robot, as (column, row)."""
        fleet = cls.fleet.messages[-1]
        taken = {int(cell) for cell in cls.plan.cell_of(fleet.x, fleet.y)}
        columns = cls.plan.shape[1]
        free = cls.plan.parking.ravel().nonzero()[0]
        return [(int(c) % columns, int(c) // columns) for c in free if int(c) not in taken]

    @classmethod
    def free_points(cls):
        """The middles of the parking cells without a robot [m]."""
        return [cls.grid.position(cell) for cell in cls.free_places()]

    def row(self, number=NUMBER):
        """What the fleet tells of a robot last, as {field: value}; {} if it is not there."""
        fleet = self.fleet.messages[-1]
        if number not in fleet.kiva_id:
            return {}
        i = list(fleet.kiva_id).index(number)
        names = ("x", "y", "yaw", "vx", "vy", "status", "shelf_id", "path_id", "charge")
        failures = bytes(fleet.failures)[i]
        return {name: getattr(fleet, name)[i] for name in names} | {"failures": failures}

    def texts(self, kind, number=NUMBER):
        """The texts of a robot's events of a kind."""
        model = f"kiva{number}"
        return [e.text for e in self.events.messages if (e.kind, e.model) == (kind, model)]

    def contacts(self):
        return [e.text for e in self.events.messages if e.kind == Event.COLLISION]
