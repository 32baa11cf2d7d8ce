# SPDX-License-Identifier: Apache-2.0
"""Vehicles at a real broker: wills, reconnecting, leftovers, passwords and TLS."""

import json
import pathlib
import shutil
import subprocess
import time
from dataclasses import replace

import pytest
from grid_robot import GRID, GridRobot, is_over, order, row
from official_schemas import faults

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.master.commands import Follow, Lift
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.model import Action, BlockingType, ConnectionState, Header, InstantActions
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import Link, MqttLoop, Outgoing
from warehouse_vda5050.mqtt.master_link import MasterLink
from warehouse_vda5050.mqtt.settings import BrokerError, BrokerSettings, read_settings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.topics import FROM_VEHICLE, Identity, Kind, Topics
from warehouse_vda5050.vehicle import Vehicle

pytestmark = pytest.mark.skipif(
    not (shutil.which("mosquitto") or pathlib.Path("/usr/sbin/mosquitto").exists()),
    reason="mosquitto is not installed",
)
CODEC, TOPICS = codec_for(), Topics()


def free_port():
    """Lets several brokers run beside each other, and none take 1883 from a person's."""
    import socket

    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Site:
    """A broker, vehicles 1 …, and a master that writes down what they tell, and what of it does
    not fit the official schemas."""

    def __init__(self, count=1, lines="allow_anonymous true", **settings):
        self.broker = OwnBroker(free_port(), lines)
        self.settings = BrokerSettings("localhost", self.broker.port, **settings)
        self.loop = MqttLoop()
        self.robots, self.vehicles = [], []
        for k in range(count):
            self.add(k)
        self.received, self.faults = [], []
        self.listens, self.coordinate = True, lambda: None
        filters = [(TOPICS.everyone(kind), 1) for kind in (*FROM_VEHICLE, Kind.ORDER)]
        self.master = self.loop.add(Link("master", self.settings, filters, self._on_message))

    def add(self, k):
        robot = GridRobot((0, k))
        vehicle = Vehicle(robot, GRID)
        link = VehicleLink(vehicle, Identity("kiva", str(k + 1)), CODEC, TOPICS, self.settings)
        self.robots.append(robot)
        self.vehicles.append(link)
        self.loop.add(link.link)

    def _on_message(self, topic, payload, retained):
        if not self.listens:
            return
        who, kind = TOPICS.parse(topic)
        decoded = None if kind is Kind.ORDER else CODEC.decode(kind, payload).message
        self.received.append((who.serial, kind, decoded, retained))
        self.faults += faults(kind, payload) if decoded else []

    def until(self, condition, steps=True, seconds=10):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, (self.received[-3:], self.link_faults())
            self.loop.poll(0.01)
            self.coordinate()
            for robot, vehicle in zip(self.robots, self.vehicles):
                if steps:
                    robot.step()
                vehicle.tick(time.monotonic())

    def link_faults(self):
        return {link.name: link.fault for link in self.loop.links}

    def begin(self):
        """Waits until the master hears all vehicles."""
        self.until(self.connected)
        self.until(
            lambda: (
                len({s for s, k, *_ in self.received if k is Kind.FACTSHEET}) >= len(self.robots)
            )
        )
        for vehicle in self.vehicles:
            vehicle.vehicle.request_state()

    def connected(self):
        return self.master.connected and all(v.link.connected for v in self.vehicles)

    def last(self, kind, serial="1"):
        return next((m for s, k, m, _ in reversed(self.received) if (s, k) == (serial, kind)), None)

    def send(self, kind, message, serial="1", retain=False):
        payload = message if isinstance(message, bytes) else CODEC.encode(message)
        topic = TOPICS.of(Identity("kiva", serial), kind)
        self.master.publish(Outgoing(topic, payload, 0, retain))

    def close(self):
        for vehicle in self.vehicles:
            vehicle.close()
        for link in self.loop.links:
            link.close()
        self.loop.close()
        self.broker.close()


@pytest.fixture
def site():
    site = Site()
    site.begin()
    yield site
    site.close()
    assert site.faults == []


def connection_is(site, state):
    return lambda: (latest := site.last(Kind.CONNECTION)) and latest.state is state


def test_order_over_the_wire(site):
    site.until(lambda: site.last(Kind.STATE) and site.last(Kind.FACTSHEET))
    site.send(Kind.ORDER, order("o", row(0, 3)))
    site.until(lambda: site.last(Kind.STATE).last_node == "c3_0" and is_over(site.last(Kind.STATE)))
    ids = [m.header.header_id for _, kind, m, _ in site.received if kind is Kind.STATE]
    assert ids == list(range(ids[0], ids[0] + len(ids)))


def test_goodbye_is_offline(site):
    site.until(connection_is(site, ConnectionState.ONLINE))
    site.vehicles[0].close()
    site.until(connection_is(site, ConnectionState.OFFLINE))


def test_lost_radio_lets_the_will_fire_and_comes_back(site):
    site.until(connection_is(site, ConnectionState.ONLINE))
    online = site.last(Kind.CONNECTION).header
    site.robots[0].extra = {"heard": False}
    site.until(connection_is(site, ConnectionState.CONNECTIONBROKEN))
    will = site.last(Kind.CONNECTION).header
    assert will.timestamp >= online.timestamp and will.header_id > online.header_id
    site.robots[0].extra = {}
    site.until(connection_is(site, ConnectionState.ONLINE))


def test_the_connection_between_vehicle_and_broker_has_unexpectedly_ended(site):
    """6.14, CONNECTIONBROKEN: also of a robot that a dead or paused world tells nothing of."""
    site.until(connection_is(site, ConnectionState.ONLINE))
    site.send(Kind.ORDER, order("o", row(0, 9)))
    site.until(lambda: (s := site.last(Kind.STATE)) and s.order_id == "o")
    site.robots[0].extra = {"silent": "the world has reported nothing for 3 s"}
    site.until(connection_is(site, ConnectionState.CONNECTIONBROKEN), steps=False)
    (error,) = site.last(Kind.STATE).errors
    assert error.type == "robotSilent" and error.level.value == "FATAL"
    assert "the world has reported nothing" in error.description
    site.robots[0].extra = {}
    site.until(connection_is(site, ConnectionState.ONLINE))
    site.until(lambda: is_over(site.last(Kind.STATE)) and not site.last(Kind.STATE).errors)
    assert site.last(Kind.STATE).last_node == "c9_0"


def test_what_is_removed_from_the_broker_is_no_message(site):
    """MQTT 3.1.1, 3.3.1.3: a payload of no bytes removes what was retained."""
    site.until(connection_is(site, ConnectionState.ONLINE))
    for kind in (Kind.ORDER, Kind.INSTANT_ACTIONS):
        site.send(kind, b"", retain=True)
    site.send(Kind.ORDER, order("o", row(0, 1)), retain=False)
    site.until(lambda: (s := site.last(Kind.STATE)) and s.order_id == "o")
    assert not any(s.errors for _, kind, s, _ in site.received if kind is Kind.STATE)


def test_broker_killed_in_mid_order(site):
    site.send(Kind.ORDER, order("o", row(0, 9), released=6))
    site.until(lambda: site.robots[0].cell[0] >= 2)
    site.broker.stop(kill=True)
    site.until(lambda: site.robots[0].cell == (5, 0))  # to the end of its base
    site.broker.start()
    site.received.clear()
    site.begin()
    site.until(lambda: site.last(Kind.STATE))
    assert site.last(Kind.STATE).last_node == "c5_0"
    site.send(Kind.ORDER, order("o", row(0, 9), released=6))  # doubled
    site.send(Kind.ORDER, order("o", row(5, 9), update=1, first=5))
    site.until(lambda: is_over(site.last(Kind.STATE)))
    assert [e[2][0] for e in site.robots[0].events] == list(range(1, 10))


class Fleet:
    """Our master with a coordinator's commands for vehicle 1, at the site's broker."""

    def __init__(self, site):
        who = Identity("kiva", "1")
        self.fleet = RemoteFleet([RemoteRobot(1, who)], GRID, "run")
        (self.vehicle,) = self.fleet.vehicles
        self.ended, self.complaints = [], []
        take = lambda identity, message: self.fleet.take(identity, message, time.monotonic())  # noqa: E731
        self.link = MasterLink(
            "ours", [who], CODEC, TOPICS, site.settings, take, self.complaints.append
        )
        site.loop.add(self.link.link)
        site.coordinate = self.step
        site.until(lambda: self.vehicle.view.is_there)

    def step(self):
        for who, message in self.fleet.messages(time.monotonic()):
            self.link.send(who, message)
        self.ended += [e.kind.value for e in self.fleet.take_events() if e.kind.value != "ACCEPTED"]


def test_broker_killed_twice_under_our_master(site):
    """While a path is driven, and while a unit is lifted: nothing is lost, nothing done twice."""
    robot, fleet = site.robots[0], Fleet(site)
    robot.units = {"storage_unit7": (4, 0)}
    points = tuple((float(x), 0.0) for x in range(5))
    fleet.fleet.command(1, Follow(3, 0, points, 3))
    site.until(lambda: robot.cell == (1, 0))
    site.broker.stop(kill=True)
    fleet.fleet.command(1, Follow(3, 0, (), 5))  # not heard by anyone
    site.until(lambda: robot.cell == (2, 0) and not robot.busy)  # the end of its base
    site.broker.start()
    site.until(lambda: fleet.ended == ["DONE"], seconds=20)
    fleet.fleet.command(1, Lift(True, 7))
    site.until(lambda: robot.lifting)
    site.broker.stop(kill=True)
    site.until(lambda: robot.load and not robot.busy)
    site.broker.start()
    site.until(lambda: fleet.ended == ["DONE", "LIFTED", "DONE"], seconds=20)
    assert [cell for what, _, cell in robot.events if what == "at"] == [(x, 0) for x in range(1, 5)]
    assert [what for what, *_ in robot.events if what != "at"] == ["pick"]
    assert fleet.vehicle.load == 7 and not fleet.complaints


def test_hostile_vehicles_cost_our_master_a_line_each(site):
    fleet, site.listens = Fleet(site), False
    hostile = [b"{", b"[" * 50_000, b'{"orderId": NaN}', b'{"nodeStates": 5}', b""]
    for payload in hostile:
        site.master.publish(Outgoing(TOPICS.of(Identity("kiva", "1"), Kind.STATE), payload))
    site.until(lambda: len(fleet.complaints) == len(hostile))
    assert fleet.vehicle.view.is_there


def test_leftovers_are_not_acted_upon(site):
    site.vehicles[0].close()
    site.until(connection_is(site, ConnectionState.OFFLINE))
    site.send(Kind.ORDER, order("left", row(0, 3)), serial="2", retain=True)
    pause = InstantActions((Action("startPause", "left", BlockingType.NONE),))
    site.send(Kind.INSTANT_ACTIONS, pause, serial="2", retain=True)
    site.until(lambda: any(kind is Kind.ORDER for _, kind, *_ in site.received))
    site.add(1)
    site.until(lambda: (s := site.last(Kind.STATE, "2")) and len(s.errors) == 2)
    latest = site.last(Kind.STATE, "2")
    assert all("retained" in error.description for error in latest.errors)
    assert not latest.order_id and not latest.paused and not latest.actions


def test_a_state_of_an_earlier_run_does_not_tell_our_master_where_a_vehicle_is(site):
    site.until(lambda: site.last(Kind.STATE))
    state = site.last(Kind.STATE)
    site.vehicles[0].close()
    site.until(connection_is(site, ConnectionState.OFFLINE))
    site.received.clear()
    site.send(Kind.STATE, state, retain=True)
    site.until(lambda: site.received)  # the broker keeps it now
    fleet = RemoteFleet([RemoteRobot(1, Identity("kiva", "1"))], GRID, "run")
    view, heard = fleet.vehicles[0].view, []
    take = lambda who, message: fleet.take(who, message, 0.0) or heard.append(message)  # noqa: E731
    link = MasterLink("ours", [Identity("kiva", "1")], CODEC, TOPICS, site.settings, take)
    site.loop.add(link.link)
    site.until(lambda: heard)
    assert view.connection is ConnectionState.OFFLINE and not view.is_there


def test_a_master_that_begins_again_counts_from_0_with_its_clock_set_back(site):
    site.until(lambda: site.last(Kind.STATE))
    late = Header(5, "2031-01-01T00:00:00.000Z", "2.1.0", "kiva", "1")
    site.send(Kind.ORDER, replace(order("a", row(0, 2)), header=late))
    site.until(lambda: site.last(Kind.STATE).last_node == "c2_0" and is_over(site.last(Kind.STATE)))
    early = replace(late, header_id=0, timestamp="2001-01-01T00:00:00.000Z")
    site.send(Kind.ORDER, replace(order("b", row(2, 4)), header=early))
    site.until(lambda: site.last(Kind.STATE).last_node == "c4_0")


def test_hostile_messages_cost_a_warning_each(site):
    for payload in (b"{", b"[" * 50_000, b'{"orderId": NaN}', b"\x00" * 10, b""):
        site.send(Kind.ORDER, payload)
        site.send(Kind.INSTANT_ACTIONS, payload)
    site.send(Kind.ORDER, json.dumps({"version": "2.1.0", "serialNumber": "9"}).encode())
    site.until(lambda: (s := site.last(Kind.STATE)) and len(s.errors) >= 3)
    assert {error.type for error in site.last(Kind.STATE).errors} == {"validationError"}
    site.send(Kind.ORDER, order("o", row(0, 1)))
    site.until(lambda: site.last(Kind.STATE).last_node == "c1_0")


def test_two_masters_on_one_robot(site):
    other = site.loop.add(Link("other", site.settings, (), lambda *_: None))
    site.until(lambda: other.connected)
    site.send(Kind.ORDER, order("mine", row(0, 9), released=3))
    site.until(lambda: (s := site.last(Kind.STATE)) and s.order_id == "mine")
    topic = TOPICS.of(Identity("kiva", "1"), Kind.ORDER)
    other.publish(Outgoing(topic, CODEC.encode(order("theirs", [(2, 0), (2, 1)]))))
    site.until(lambda: site.last(Kind.STATE).errors)
    assert "order mine is under way" in site.last(Kind.STATE).errors[0].description
    other.close()


def test_password_and_tls(tmp_path):
    run = subprocess.run
    key, pem, users = tmp_path / "key", tmp_path / "pem", tmp_path / "users"
    subject = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"]
    make = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256"]
    out = ["-nodes", "-keyout", key, "-out", pem, *subject]
    run([*make, *out], check=True, capture_output=True)
    run(["mosquitto_passwd", "-b", "-c", users, "robot", "secret"], check=True, capture_output=True)
    lines = f"cafile {pem}\ncertfile {pem}\nkeyfile {key}\npassword_file {users}"
    secret = tmp_path / "secret"
    secret.write_text("secret\n")
    site = Site(0, f"{lines}\nallow_anonymous false", tls=True, authority=str(pem))
    try:
        site.until(lambda: site.master.fault not in ("", "not connected yet"))  # no password
        assert not site.master.connected
        site.settings = BrokerSettings("localhost", site.broker.port, tls=True, user="robot")
        stranger = site.loop.add(Link("stranger", site.settings, (), lambda *_: None))
        site.until(lambda: "CERTIFICATE" in stranger.fault)  # of an authority that is unknown here
        broker = f"localhost:{site.broker.port}"
        site.settings = read_settings(broker, str(pem), "robot", str(secret))
        site.add(0)
        site.until(lambda: site.vehicles[0].link.connected)
    finally:
        site.close()


@pytest.mark.parametrize(
    "args,text",
    [
        (("localhost:x",), "broker is 'localhost:x'"),
        ((":1883",), "HOST:PORT"),
        (("localhost:70000",), "HOST:PORT"),
        (("localhost", "/no/such/file"), "tls is '/no/such/file'"),
        (("localhost", "", "", "/secret"), "without user"),
        (("localhost", "", "me", "/no/such/file"), "password_file"),
    ],
)
def test_arguments_that_name_no_broker(args, text):
    with pytest.raises(BrokerError, match=text):
        read_settings(*args)
