# SPDX-License-Identifier: Apache-2.0
"""Our master on paper, with a coordinator that always has something to carry, behind a broker on
paper: its own code, and a clock that costs nothing to wait for."""

import math
import random
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from grid_robot import GRID
from two_sides import way

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.conform.master.actor import Role
from warehouse_vda5050.conform.master.runner import Runner
from warehouse_vda5050.conform.master.settings import Settings
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.master.wire import StageWire
from warehouse_vda5050.conform.wire import Arrived
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.master.commands import Cancel, Follow, Lift, Stop
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.frame import Frame
from warehouse_vda5050.master.remote_vehicle import EventKind
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.master.shadow import shadow_of
from warehouse_vda5050.master.zone_desk import ClosedArea
from warehouse_vda5050.mqtt.master_link import MasterLink
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import Identity, Topics, heard_by_vehicle, prefix_of

TICK = 0.1  # [s]
OF_MASTER = tuple(f"/{kind.value}" for kind in heard_by_vehicle("3.0.0"))
AHEAD = 3  # points that are released ahead of a vehicle
ENOUGH = 0.1  # charge with which a unit is lifted
FRAMES = (Frame(), Frame(2.0, 9.0, -math.pi / 2))  # where each vehicle's own map lies
START = (2, 2), (7, 6)  # cells
# Where zones are closed in 3.0.0, by turns: a corner that no way comes to, and, for a while, rows
# that both vehicles count as in, so that they need a release there.
SPILL = ClosedArea(1, -0.5, -0.5, 0.5, 0.5)
CROWD = ClosedArea(2, -0.5, 2.5, 9.5, 4.5, frozenset({1, 2}))
CLOSED_FOR = 50.0  # [s]


class VehicleEnd:
    """Stands where a VehicleLink has its connection."""

    def __init__(self, broker, link):
        self._broker, self.link = broker, link
        self.connected, self.is_wanted, self.closed = False, True, False
        self.will = None

    def connect(self):
        self.will = self.link._make_will()
        self.connected = True
        self.link._on_connect()

    def publish(self, message):
        if self.connected:
            self._broker.spread(message)
        return self.connected

    def cut(self):
        self.is_wanted = False
        if self.connected:
            self.connected = False
            self._broker.spread(self.will)

    def restore(self):
        self.is_wanted = True

    def close(self, farewell=None):
        if farewell:
            self.publish(farewell)
        self.connected, self.closed = False, True


class MasterEnd:
    """Stands where a MasterLink has its connection."""

    def __init__(self, broker):
        self._broker = broker

    def publish(self, message):
        self._broker.spread(message)
        return True


class PaperBroker(StageWire):
    """The broker, its clock, and our master at it. `damage(message)` returns what becomes of a
    message of the master: another, or None for one that is lost."""

    def __init__(self, version, roles, damage=lambda message: message):
        self.take = lambda _message: None
        self._now = 100.0
        self._kept, self._heard, self._queue, self._ends = {}, [], [], []
        self._damage = damage
        codec, topics = codec_for(version), Topics(prefix_of(version))
        robots = [
            RemoteRobot(k, role.identity, frame)
            for k, (role, frame) in enumerate(zip(roles, FRAMES), 1)
        ]
        self.fleet = RemoteFleet(robots, GRID, "paper", zones=version.startswith("3"))
        who = [role.identity for role in roles]
        take = lambda identity, message: self.fleet.take(identity, message, self._now)  # noqa: E731
        self.master = MasterLink("master", who, codec, topics, BrokerSettings(), take)
        clock = lambda: 1.7e9 + self._now  # noqa: E731
        self.master._headers = {whose: Headers(whose, version, clock) for whose in who}
        self._subscribed = [topic for topic, _ in self.master.link._subscriptions]
        self.master.link = MasterEnd(self)
        self.clock = clock
        self.coordinator = Coordinator(self.fleet)

    def spread(self, message):
        """Delivers a message, at the next poll."""
        message = self._damage(message) if message.topic.endswith(OF_MASTER) else message
        if message is None:
            return
        if message.retain:
            self._kept[message.topic] = message
        self._queue.append(message)

    def now(self):
        return self._now

    def poll(self, seconds):
        self._now += TICK
        for end in self._ends:
            if end.is_wanted and not (end.connected or end.closed):
                end.connect()
        queue, self._queue = self._queue, []
        for message in queue:
            self._deliver(message)
        self.coordinator.step(self._now)
        for identity, message in self.fleet.messages(self._now):
            self.master.send(identity, message)
        for event in self.fleet.take_events():
            self.coordinator.take(event)

    def _deliver(self, message):
        for end in self._ends:
            if end.connected and message.topic.endswith(OF_MASTER):
                identity = end.link.identity
                if f"/{identity.manufacturer}/{identity.serial}/" in message.topic:
                    end.link._on_message(message.topic, message.payload, False)
        if message.topic in self._subscribed:
            self.master._on_message(message.topic, message.payload, False)
        if message.topic in self._heard:
            self.take(Arrived(message.topic, message.payload, message.qos, False))

    def join(self, link):
        link._headers._clock = self.clock
        link.link = VehicleEnd(self, link)
        self._ends = [end for end in self._ends if not end.closed]
        self._ends.append(link.link)

    def hear(self, topic):
        self._heard.append(topic)
        kept = self._kept.get(topic)
        if kept:
            self.take(Arrived(topic, kept.payload, kept.qos, True))

    def close(self):
        pass


class Trip:
    """What one vehicle is to do next: paths, and lifts between them."""

    def __init__(self, number):
        self.number, self.count, self.path_id = number, 0, 0
        self.random = random.Random(number)
        self.points, self.released, self.not_before = (), 0, 0.0
        self.cancel_at = self.resume_at = None


class Coordinator:
    """Has units carried to and fro, as far as each vehicle's shadow lets it. Every sixth path is
    cancelled, and every fifth paused."""

    def __init__(self, fleet):
        self._fleet = fleet
        self._trips = {v.robot.number: Trip(v.robot.number) for v in fleet.vehicles}

    def take(self, event):
        """Asks again for what was refused."""
        if event.kind is EventKind.REFUSED:
            self._trips[event.kiva_id].released = 0

    def step(self, now):
        is_crowded = now // CLOSED_FOR % 2
        self._fleet.close_zones([SPILL, CROWD] if is_crowded else [SPILL])
        for vehicle in self._fleet.vehicles:
            shadow = shadow_of(vehicle, now)
            if shadow is not None:
                self._step(vehicle, self._trips[vehicle.robot.number], shadow, now)

    def _step(self, vehicle, trip, shadow, now):
        if trip.resume_at is not None and now >= trip.resume_at:
            trip.resume_at = None
            vehicle.command(Stop(False))
        if not vehicle.is_idle:
            self._go_on(vehicle, trip, now)
        elif now >= trip.not_before and not shadow.failures and vehicle.view.takes_orders:
            trip.not_before = now + 0.5
            self._begin(vehicle, trip, shadow, now)

    def _begin(self, vehicle, trip, shadow, now):
        trip.count += 1
        trip.cancel_at = None
        if trip.count % 2 == 0 and (vehicle.load or shadow.charge > ENOUGH):
            vehicle.command(Lift(not vehicle.load, 7))
            return
        here = GRID.cell_at(*vehicle.view.pose[:2])
        goal = trip.random.choice([(1, 1), (8, 2), (2, 8), (7, 7), (4, 3), (6, 4)])
        if here == goal:
            goal = (3, 6)
        trip.points = way(here, goal)
        trip.path_id, trip.released = trip.path_id + 1, min(len(trip.points), AHEAD)
        vehicle.command(Follow(trip.path_id, 0, trip.points, trip.released))
        if trip.count % 12 == 5:
            trip.cancel_at = now + 2.5
        if trip.count % 10 == 3:
            vehicle.command(Stop(True))
            trip.resume_at = now + 3.0

    def _go_on(self, vehicle, trip, now):
        if trip.cancel_at is not None and now >= trip.cancel_at:
            trip.cancel_at = None
            vehicle.command(Cancel())
        if vehicle.lifts or vehicle.path_id != trip.path_id:
            return
        released = min(len(trip.points), vehicle.reached + AHEAD - 1)
        if released > trip.released:
            trip.released = released
            vehicle.command(Follow(trip.path_id, 0, (), released))


def roles():
    """The vehicles, each where it stands on its own map."""
    made = []
    for k, (frame, cell) in enumerate(zip(FRAMES, START), 1):
        x, y = frame.to_vehicle(*GRID.position(cell))
        made.append(Role(Identity("conform", str(k)), x, y, -frame.theta, GRID.node_id(cell)))
    return made


def runner_for(version="2.1.0", damage=lambda message: message, **settings):
    """Returns a runner on a stage with our master."""
    vehicles = roles()
    broker = PaperBroker(version, vehicles, damage)
    topics = Topics(prefix_of(version))
    codec = codec_for(version)
    return Runner(Stage(broker, vehicles, codec, topics, Settings(**settings)))
