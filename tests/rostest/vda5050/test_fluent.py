#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle behind a broker drives straight stretches without a stop: what is ahead is released in
time, although its states come once a cell."""

import math
import signal
import subprocess
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
from warehouse_msgs.msg import CoordinatorState, FleetState, TransportEvent
from warehouse_msgs.srv import SetRobotMode, Transport
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.formula_driver import FormulaRobot
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.topics import Identity, Topics
from warehouse_vda5050.vehicle import Vehicle

NUMBER, OUT_OF_SERVICE = 21, 2
TOP, ACCELERATION = 1.5, 1.0  # of the vehicle [m/s, m/s2]
RAMP = TOP**2 / (2 * ACCELERATION)  # in which it reaches that, and brakes from it [m]
SLOWEST = 0.6 * TOP  # of a drive without a stop; messages of a busy machine are late [m/s]
LONG = 6.0  # least length of a stretch that is judged [m]
STEP, PATIENCE = 0.01, 120.0  # [s, wall]


class Cart(FormulaRobot):
    """Accelerates and brakes: it stops at the end of what is released to it, and at corners.
    `drive`: its place, heading and speed after each step."""

    def __init__(self, x, y):
        super().__init__(x, y, 0.0, TOP)
        self._speed, self.drive = 0.0, []

    def step(self, seconds):
        if self.is_moving:
            faster = self._speed + ACCELERATION * seconds
            least = ACCELERATION * seconds  # else it would never be there
            brakes = math.sqrt(2 * ACCELERATION * self.way_ahead())
            self._speed = max(least, min(TOP, faster, brakes))
        super().step(seconds)
        if not self.is_moving:
            self._speed = 0.0
        self.drive.append((self.x, self.y, self._speed))

    def way_ahead(self):
        """The distance to its next stop [m]."""
        at, way, heading = (self.x, self.y), 0.0, None
        for point in self._path[self._reached :]:
            length = math.dist(at, point)
            if length > 1e-9:
                turned = math.atan2(point[1] - at[1], point[0] - at[0])
                if heading is not None and abs(math.remainder(turned - heading, math.tau)) > 0.01:
                    break
                heading, way = turned, way + length
            at = point
        return way


class Behind(threading.Thread):
    """The vehicle, with its connection, in a thread of its own."""

    def __init__(self, robot, grid, port):
        super().__init__(daemon=True)
        self.robot, self.ended = robot, threading.Event()
        who, broker = Identity("acme", "7"), BrokerSettings("localhost", port)
        self.link = VehicleLink(Vehicle(robot, grid), who, codec_for(), Topics(), broker)

    def run(self):
        loop, before = MqttLoop(), time.monotonic()
        loop.add(self.link.link)
        while not self.ended.is_set():
            loop.poll(STEP)
            before, now = time.monotonic(), before
            self.robot.step(before - now)
            self.link.tick(before)


def stretches(drive):
    """Straight stretches of a drive, as [(way from the begin [m], speed [m/s])]."""
    runs, run, axis = [], [], None
    for (x0, y0, _), (x1, y1, speed) in zip(drive, drive[1:]):
        way = math.dist((x0, y0), (x1, y1))
        if way > 1e-6:
            along = (abs(x1 - x0) > abs(y1 - y0), x1 - x0 + y1 - y0 > 0)
            if along != axis:
                runs, run, axis = [*runs, run], [(0.0, 0.0)], along
            run.append((run[-1][0] + way, speed))
        elif run:
            run.append((run[-1][0], speed))
    return [*runs, run]


class Fluent(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.fleet = Collector("/warehouse/fleet", FleetState)
        cls.state = Collector("/warehouse/coordinator", CoordinatorState)
        cls.transports = Collector("/warehouse/transports", TransportEvent)
        cls.state.first(lambda state: state.automatic == 4, PATIENCE)
        for number in (1, 2, 3, 4):  # the way is free
            call("/warehouse/set_robot_mode", SetRobotMode, kiva_id=number, mode=OUT_OF_SERVICE)
        warehouse = WarehouseClient(rospy)
        wait_until(lambda: warehouse.is_known, "the warehouse")
        cls.broker, grid = OwnBroker(), grid_of(read_map())
        cls.behind = Behind(Cart(*cls.free_place(warehouse.plan(), grid)), grid, cls.broker.port)
        cls.behind.start()
        cls.start_master()

    @classmethod
    def tearDownClass(cls):
        cls.node.send_signal(signal.SIGINT)
        cls.node.wait(20)
        cls.behind.ended.set()
        cls.broker.close()

    @classmethod
    def free_place(cls, plan, grid):
        """The middle of a parking cell that no robot is near [m]."""
        fleet = cls.fleet.messages[-1]
        taken = {int(cell) for cell in plan.cell_of(fleet.x, fleet.y)}
        columns = plan.shape[1]
        cell = next(int(c) for c in plan.parking.ravel().nonzero()[0] if int(c) not in taken)
        return grid.position((cell % columns, cell // columns))

    @classmethod
    def start_master(cls):
        file = Path(tempfile.mkdtemp()) / "robots.yaml"
        file.write_text(f"{NUMBER}: {{manufacturer: acme, serial: '7'}}\n")
        rospy.set_param("/vda5050_master/robots", str(file))
        rospy.set_param("/vda5050_master/broker", f"localhost:{cls.broker.port}")
        command = ["setpriv", "--pdeathsig", "TERM", "rosrun", "warehouse_vda5050", "master"]
        cls.node = subprocess.Popen(command)

    def speeds(self):
        """The speeds that the fleet has told of the vehicle [m/s]."""
        rows = [
            (m, list(m.kiva_id).index(NUMBER)) for m in self.fleet.messages if NUMBER in m.kiva_id
        ]
        return [math.hypot(m.vx[i], m.vy[i]) for m, i in rows]

    def test_it_never_stops_on_a_straight_way(self):
        self.state.first(lambda s: (s.automatic, s.out_of_service) == (1, 4), PATIENCE)
        answer = call("/warehouse/transport", Transport, shelf_id=7, station="pick1", then=0)
        self.assertTrue(answer.accepted, answer.message)
        self.transports.first(lambda e: e.kind == TransportEvent.ARRIVED, PATIENCE)
        runs = [run for run in stretches(self.behind.robot.drive) if run and run[-1][0] > LONG]
        self.assertTrue(runs, "no stretch was long")
        for run in runs:
            inner = [(w, v) for w, v in run if RAMP + 0.2 < w < run[-1][0] - RAMP - 0.2]
            slowest = min(inner, key=lambda place: place[1])
            print(f"{run[-1][0]:.1f} m, {slowest[1]:.3f} m/s or more", flush=True)
            self.assertGreater(slowest[1], SLOWEST, f"at {slowest[0]:.2f} of {run[-1][0]:.1f} m")
        self.assertGreater(max(self.speeds()), SLOWEST)


if __name__ == "__main__":
    rospy.init_node("fluent")
    latched("/warehouse/coordinator", CoordinatorState)
    rostest.rosrun("warehouse_tests", "fluent", Fluent)
