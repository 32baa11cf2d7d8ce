# SPDX-License-Identifier: Apache-2.0
"""A vehicle on paper behind a broker on paper: our vehicle's own code, a robot of a few lines, and
a clock that costs nothing to wait for."""

import math
import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from grid_robot import GRID, LimitedRobot

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.conform.ground import straight
from warehouse_vda5050.conform.probe import Probe
from warehouse_vda5050.conform.runner import Runner, begin
from warehouse_vda5050.conform.settings import Settings
from warehouse_vda5050.conform.wire import Arrived, Wire
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.topics import Identity, Topics, prefix_of
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings

WHO = Identity("paper", "1")
TICK = 0.05  # [s]
OFF = 0.003
TOP = 1.5  # [m/s]


class PaperRobot(LimitedRobot):
    """Drives a cell in 0.7 s, seen between cells too; turns at once, lifts in 2 s. In every other
    column it stands OFF [m] beside the middle of the cell."""

    def __init__(self, cell=(2, 2)):
        super().__init__(cell)
        self.part, self.yaw, self.ahead = 0.0, 0.0, (0, 0)
        self.lift_ticks = 0

    def step(self):
        if not self.busy or self.stopped:
            return
        if self.lifting:
            self.lift_ticks += 1
            if self.lift_ticks % 20 == 0:
                super().step()
        elif self.part == 0.0 and (self.cancelling or self.reached == len(self.path)):
            super().step()
        else:
            self._roll()

    def _roll(self):
        if self.part == 0.0:
            goal = self.path[self.reached]
            dx, dy = goal[0] - self.cell[0], goal[1] - self.cell[1]
            self.ahead = ((dx > 0) - (dx < 0), (dy > 0) - (dy < 0))
            self.yaw = math.atan2(self.ahead[1], self.ahead[0])
        self.part += self.speed * TICK
        if self.part >= 1.0:
            self.part = 0.0
            self._drive()

    def report(self):
        report = super().report()
        dx, dy = self.ahead
        speed = self.speed if report.moving else 0.0
        return replace(
            report,
            x=report.x + self.part * dx + OFF * (self.cell[0] % 2),
            y=report.y + self.part * dy,
            yaw=self.yaw,
            vx=speed * dx,
            vy=speed * dy,
        )

    @property
    def speed(self):
        """That of the present edge, of 1 m [m/s]."""
        return min(TOP, self.limits.get(min(self.reached, len(self.path) - 1), TOP))

    def init_position(self, x, y, yaw):
        return ""


class PaperLink:
    """Stands where VehicleLink has its connection."""

    def __init__(self, wire):
        self._wire = wire
        self.connected, self.is_wanted, self.closed = False, True, False

    def publish(self, message):
        if self.connected:
            self._wire.from_vehicle(message)
        return self.connected

    def cut(self):
        self.is_wanted = False
        self._wire.cut()

    def restore(self):
        self.is_wanted = True

    def close(self, farewell=None):
        self.publish(farewell)
        self.closed = True


class PaperWire(Wire):
    """The broker, the vehicle and the clock. `damage(message)` returns what becomes of a message of
    the vehicle: another, or None; `deafen(topic, payload)` of one to the vehicle."""

    cuts = True

    def __init__(self, version="2.1.0", damage=lambda message: message, deafen=lambda t, p: p):
        self.take = lambda _message: None
        self._now = 100.0
        self._kept, self._topics, self._queue = {}, set(), []
        self._damage, self._deafen = damage, deafen
        self.robot = PaperRobot()
        codec, topics = codec_for(version), Topics(prefix_of(version))
        is_new = version.startswith("3")
        logs = Path("/tmp/conform_logs")
        settings = VehicleSettings(begins_at_zero=is_new, zones=is_new, logs=logs)
        vehicle = Vehicle(self.robot, GRID, settings)
        self.link = VehicleLink(vehicle, WHO, codec, topics, BrokerSettings())
        self.link._headers = Headers(WHO, version, lambda: 1.7e9 + self._now)
        self.link.link = PaperLink(self)
        self._may_connect = True
        self._will = None
        self.poll(TICK)

    # --- the vehicle's side

    def from_vehicle(self, message):
        message = self._damage(message)
        if message is None:
            return
        if message.retain:
            self._kept[message.topic] = message
        if message.topic in self._topics:
            self._queue.append(Arrived(message.topic, message.payload, message.qos, False))

    def _connect(self):
        self._will = self.link._make_will()
        self.link.link.connected = True
        self.link._on_connect()

    # --- the master's side

    def now(self):
        return self._now

    def poll(self, seconds):
        self._now += TICK
        self.robot.step()
        if self._may_connect and self.link.link.is_wanted and not self.link.link.connected:
            self._connect()
        self.link.tick(self._now)
        queue, self._queue = self._queue, []
        for message in queue:
            self.take(message)

    def publish(self, topic, payload):
        payload = self._deafen(topic, payload)
        if payload is not None and self.link.link.connected:
            self.link._on_message(topic, payload, False)

    def subscribe(self, topic):
        self._topics.add(topic)
        kept = self._kept.get(topic)
        if kept:
            self._queue.append(Arrived(topic, kept.payload, kept.qos, True))

    def cut(self):
        self._may_connect = False
        if self.link.link.connected:
            self.link.link.connected = False
            self.from_vehicle(self._will)

    def restore(self):
        self._may_connect = True

    def close(self):
        self.link.close()


def runner_for(version="2.1.0", wire=None, **settings):
    """Returns a runner that has begun with a paper vehicle."""
    wire = wire or PaperWire(version)
    topics = Topics(prefix_of(version))
    probe = Probe(wire, WHO, codec_for(version), topics, Settings(**settings), "t")
    begin(probe, lambda s: ground_of(s, probe.settings))
    return Runner(probe)


def ground_of(state, settings):
    at = state["agvPosition"]
    return straight(
        at["x"], at["y"], at["mapId"], state.get("lastNodeId", "here"), 0.0, 1.0, settings.edges
    )
