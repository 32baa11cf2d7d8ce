# SPDX-License-Identifier: Apache-2.0
"""Vehicles at a real broker: wills, reconnecting, leftovers, passwords and TLS."""

import json
import pathlib
import shutil
import subprocess
import time

import pytest
from grid_robot import GRID, GridRobot, is_over, order, row

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.model import ConnectionState
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import Link, MqttLoop, Outgoing
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
    """A broker, vehicles 1 …, and a master that writes down what they tell."""

    def __init__(self, count=1, lines="allow_anonymous true", **settings):
        self.broker = OwnBroker(free_port(), lines)
        self.settings = BrokerSettings("localhost", self.broker.port, **settings)
        self.loop = MqttLoop()
        self.robots, self.vehicles = [], []
        for k in range(count):
            self.add(k)
        self.told = []
        filters = [(TOPICS.everyone(kind), 1) for kind in (*FROM_VEHICLE, Kind.ORDER)]
        self.master = self.loop.add(Link("master", self.settings, filters, self._on_message))

    def add(self, k):
        robot = GridRobot((0, k))
        vehicle = Vehicle(robot, GRID)
        link = VehicleLink(
            vehicle, Identity("kiva", str(k + 1)), CODEC, TOPICS, self.settings
        )
        self.robots.append(robot)
        self.vehicles.append(link)
        self.loop.add(link.link)

    def _on_message(self, topic, payload, retained):
        who, kind = TOPICS.parse(topic)
        told = None if kind is Kind.ORDER else CODEC.decode(kind, payload).message
        self.told.append((who.serial, kind, told, retained))

    def until(self, condition, steps=True, seconds=10):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, self.told[-3:]
            self.loop.poll(0.01)
            for robot, vehicle in zip(self.robots, self.vehicles):
                if steps:
                    robot.step()
                vehicle.tick(time.monotonic())

    def begin(self):
        """Waits until the master hears all vehicles."""
        self.until(self.connected)
        self.until(lambda: len({s for s, kind, *_ in self.told if kind is Kind.FACTSHEET}) >= len(self.robots))
        for vehicle in self.vehicles:
            vehicle.vehicle.request_state()

    def connected(self):
        return self.master.connected and all(v.link.connected for v in self.vehicles)

    def last(self, kind, serial="1"):
        return next((m for s, k, m, _ in reversed(self.told) if (s, k) == (serial, kind)), None)

    def send(self, kind, message, serial="1", retain=False):
        payload = message if isinstance(message, bytes) else CODEC.encode(message)
        topic = TOPICS.of(Identity("kiva", serial), kind)
        self.master.publish(Outgoing(topic, payload, 0, retain))

    def close(self):
        for vehicle in self.vehicles:
            vehicle.close()
        self.master.close()
        self.loop.close()
        self.broker.close()


@pytest.fixture
def site():
    site = Site()
    site.begin()
    yield site
    site.close()


def connection_is(site, state):
    return lambda: (told := site.last(Kind.CONNECTION)) and told.state is state


def test_order_over_the_wire(site):
    site.until(lambda: site.last(Kind.STATE) and site.last(Kind.FACTSHEET))
    site.send(Kind.ORDER, order("o", row(0, 3)))
    site.until(lambda: site.last(Kind.STATE).last_node == "c3_0" and is_over(site.last(Kind.STATE)))
    ids = [m.header.header_id for _, kind, m, _ in site.told if kind is Kind.STATE]
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


def test_broker_killed_in_mid_order(site):
    site.send(Kind.ORDER, order("o", row(0, 9), released=6))
    site.until(lambda: site.robots[0].cell[0] >= 2)
    site.broker.stop(kill=True)
    site.until(lambda: site.robots[0].cell == (5, 0))  # to the end of its base
    site.broker.start()
    site.told.clear()
    site.begin()
    site.until(lambda: site.last(Kind.STATE))
    assert site.last(Kind.STATE).last_node == "c5_0"
    site.send(Kind.ORDER, order("o", row(0, 9), released=6))  # doubled
    site.send(Kind.ORDER, order("o", row(5, 9), update=1, first=5))
    site.until(lambda: is_over(site.last(Kind.STATE)))
    assert [e[2][0] for e in site.robots[0].events] == list(range(1, 10))


def test_leftovers_are_not_acted_upon(site):
    site.vehicles[0].close()
    site.until(connection_is(site, ConnectionState.OFFLINE))
    site.send(Kind.ORDER, order("left", row(0, 3)), serial="2", retain=True)
    site.until(lambda: any(kind is Kind.ORDER for _, kind, *_ in site.told))
    site.add(1)
    site.until(lambda: (s := site.last(Kind.STATE, "2")) and s.errors)
    assert "retained" in site.last(Kind.STATE, "2").errors[0].description
    assert not site.last(Kind.STATE, "2").order_id


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
