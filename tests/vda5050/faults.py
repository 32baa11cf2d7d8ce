#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What goes wrong, done to the robots of a running warehouse at a real broker: it is killed while a
robot drives and while it lifts, messages are hostile, doubled or left over, a second master orders
too, headers go back, and the program of all vehicles is killed; then all again by TLS and password.

Run by scripts/peers/test-vda5050 with a warehouse running.
"""

import contextlib
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from floor import cells_of, trips

from warehouse_msgs.msg import FleetState
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.demo_master import DemoMaster, order_of
from warehouse_vda5050.errors import ErrorLevel
from warehouse_vda5050.fetch_trip import wait_for_warehouse
from warehouse_vda5050.model import Action, BlockingType, Header, InstantActions
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import Outgoing
from warehouse_vda5050.mqtt.settings import BrokerSettings, read_settings
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.topics import Identity, Kind, Topics

CODEC, TOPICS = codec_for(), Topics()
WAIT = 90.0  # [s, wall]
BASE = 4  # released nodes of an order
HOSTILE = {  # by a part of what is told of each
    "Expecting ',' delimiter": b'{"orderId": "x"',
    "JSON deeper than": b"[" * 50_000,
    "a message of": b'{"orderId": "' + b"x" * (1 << 20) + b'"}',
    "more than 200000 values": b'{"a": [' + b"1," * 250_000 + b"1]}",
    "NaN is not a number": b'{"orderId": NaN}',
    "beyond what a double holds": b'{"orderUpdateId": 1e999}',
    "an object was expected": b"5",
    "can't decode byte": b"\xff\xfe\x00",
    "orderId is": b'{"orderId": 7, "orderUpdateId": "x", "nodes": {}, "edges": 1}',
    "Expecting value": b" ",
}


def say(text):
    print(f"faults: {text}", flush=True)


class Master(DemoMaster):
    """A master that also sends what none should."""

    def post(self, who, kind, message, retain=False):
        """Sends bytes, or a message with the header that it has."""
        payload = message if isinstance(message, bytes) else CODEC.encode(message)
        self._link.publish(Outgoing(TOPICS.of(who, kind), payload, 0, retain))

    def order(self, who, order):
        self._send(who, Kind.ORDER, order)

    def all_are(self, online, robots):
        self.until(lambda: [*map(self.online.get, robots)] == [online] * len(robots), WAIT, "all")

    def waits_at(self, who, node):
        """Waits until a robot stands at a node, and is done with its actions."""

        def stands():
            state = self.states[who]
            over = all(action.status.is_over for action in state.actions)
            return state.last_node == node and not state.driving and over

        self.until(stands, WAIT, f"{who.serial} to stand at {node}")

    def told(self, who, text):
        def found():
            return [e for e in self.states[who].errors if text in e.description]

        errors = self.until(found, WAIT, f"an error with {text!r}")
        assert {error.level for error in errors} == {ErrorLevel.WARNING}, errors
        return errors[0]


def part(order, first, released, update):
    """Returns an update: the nodes of an order from number `first` on, `released` of all."""
    nodes = tuple(replace(n, released=k < released) for k, n in enumerate(order.nodes))[first:]
    edges = tuple(replace(e, released=k + 1 < released) for k, e in enumerate(order.edges))[first:]
    return replace(order, update=update, nodes=nodes, edges=edges)


def header(number, year):
    return Header(number, f"{year}-01-01T00:00:00.000Z", "2.1.0")


class Ways:
    """Where robots have been, by what the world tells."""

    def __init__(self, grid):
        self._grid, self.cells = grid, {}
        rospy.Subscriber("/warehouse/fleet", FleetState, self._take, queue_size=100)

    def _take(self, fleet):
        for kiva, x, y in zip(fleet.kiva_id, fleet.x, fleet.y):
            cell, been = self._grid.cell_at(x, y), self.cells.setdefault(kiva, [])
            if not been or been[-1] != cell:
                been.append(cell)


class Site:
    """The broker, the vehicles at it, a master, and what is known of the floor."""

    def __init__(self, stack):
        state = wait_for_warehouse()
        self.grid = grid_of(read_map())
        self.robots = [Identity("kiva", str(kiva.kiva_id)) for kiva in state.kivas]
        pair = trips(state, self.grid, *cells_of(state, self.grid))
        self.trip = next(trip for trip in pair if len(trip["there"]) > BASE + 1)
        self.who = Identity("kiva", str(self.trip["robot"]))
        self.ways = Ways(self.grid)
        self.broker = stack.enter_context(OwnBroker())
        stack.enter_context(vehicles(f"broker:=localhost:{self.broker.port}"))
        settings = BrokerSettings("localhost", self.broker.port)
        self.master = Master(settings, CODEC, TOPICS, lambda _: None)
        stack.callback(self.master.close)
        self.master.all_are(True, self.robots)
        self.master.wait_for_vehicles(len(self.robots))

    def order(self, name, cells, **action):
        action = {len(cells) - 1: Action(**action)} if action else {}
        return order_of(f"{name}-{time.time_ns()}", cells, self.grid, action)

    def restart_broker(self):
        self.broker.start()
        self.master.online.clear()
        self.master.all_are(True, self.robots)


@contextlib.contextmanager
def vehicles(*words):
    command = ["roslaunch", "--sigint-timeout=3", "warehouse_vda5050", "vehicles.launch"]
    launch = subprocess.Popen(
        ["setpriv", "--pdeathsig", "TERM", *command, *words], stdout=subprocess.DEVNULL
    )
    try:
        yield
    finally:
        launch.terminate()
        launch.wait()


def broker_is_killed_while_a_robot_drives(site):
    master, who, cells = site.master, site.who, site.trip["there"]
    order = site.order("there", cells)
    been = len(site.ways.cells[int(who.serial)])
    master.order(who, part(order, 0, BASE, 0))
    master.until(lambda: master.states[who].driving, WAIT, "the robot to drive")
    site.broker.stop(kill=True)
    end = site.grid.position(cells[BASE - 1])
    master.until(lambda: site.ways.cells[int(who.serial)][-1] == cells[BASE - 1], WAIT, str(end))
    time.sleep(2.0)  # it would drive on, if it did
    assert site.ways.cells[int(who.serial)][-1] == cells[BASE - 1]
    site.restart_broker()
    master.waits_at(who, site.grid.node_id(cells[BASE - 1]))
    for _ in range(2):  # and what was said before is said again
        master.order(who, part(order, 0, BASE, 0))
        master.order(who, part(order, BASE - 1, len(cells), 1))
    master.waits_at(who, site.grid.node_id(cells[-1]))
    driven = site.ways.cells[int(who.serial)][been:]
    assert driven == cells[1:], (driven, cells)
    say(f"broker killed in mid-order: stood at the end of its base, then went on; {driven}")


def broker_is_killed_while_a_robot_lifts(site):
    master, who, unit = site.master, site.who, str(site.trip["unit"])
    here = [site.trip["there"][-1]]
    for kind, loads in (("pick", [unit]), ("drop", [])):
        order = site.order(kind, here, type=kind, id=kind, parameters=(("loadId", unit),))
        master.order(who, order)
        running = ("RUNNING", "FINISHED")
        master.until(
            lambda: [a.status.value in running for a in master.states[who].actions if a.id == kind],  # noqa: B023
            WAIT,
            kind,
        )
        site.broker.stop(kill=True)
        time.sleep(3.0)
        site.restart_broker()
        master.order(who, order)
        state = master.states[who]
        master.until(lambda: master.states[who] is not state, WAIT, "a state")  # noqa: B023
        master.waits_at(who, site.grid.node_id(here[0]))
        state = master.states[who]
        assert [load.id for load in state.loads] == loads, state.loads
        assert [a.status.value for a in state.actions if a.id == kind] == ["FINISHED"], state
    say("broker killed while a unit was lifted, and while it was put down: each done once")


def messages_are_hostile(site):
    for text, payload in HOSTILE.items():
        for kind in (Kind.ORDER, Kind.INSTANT_ACTIONS):
            site.master.post(site.who, kind, payload)
        error = site.master.told(site.who, text)
        assert error.type == "validationError", error
        say(f"hostile: {len(payload)} bytes, {payload[:20]!r}: {error.description[:100]}")


def another_master_orders_too(site):
    master, who, way = site.master, site.who, site.trip["there"][::-1]
    mine, theirs = site.order("mine", way), site.order("theirs", way[:2])
    master.order(who, part(mine, 0, 3, 0))
    master.until(lambda: master.states[who].order_id == mine.id, WAIT, "the order")
    assert not master.states[who].errors, "errors are over with the next order"
    master.post(who, Kind.ORDER, replace(theirs, header=header(0, 2001)))
    text = master.told(who, "is under way")
    say(f"a second master: {text.type}: {text.description}")
    master.order(who, part(mine, 2, len(way), 1))
    master.waits_at(who, site.grid.node_id(way[-1]))


def headers_go_back(site):
    master, who = site.master, site.who
    for number, year in ((50, 2035), (3, 2001)):
        here = site.grid.cell_of_id(master.states[who].last_node)
        order = replace(site.order("late", [here]), header=header(number, year))
        master.post(who, Kind.ORDER, order)
        master.until(lambda: master.states[who].order_id == order.id, WAIT, f"{year}")  # noqa: B023
    say("an order of 2001 after one of 2035 is carried out: masters may begin again")


def all_vehicles_are_killed(site):
    """Their wills fire; the program comes back, and finds what was left at the broker."""
    master, who = site.master, site.who
    here = site.grid.cell_of_id(master.states[who].last_node)
    left = site.order("left", [here])
    pause = InstantActions((Action("startPause", "left", BlockingType.NONE),))
    master.post(who, Kind.ORDER, left, retain=True)
    master.until(lambda: master.states[who].order_id == left.id, WAIT, "the order, for now")
    master.post(who, Kind.INSTANT_ACTIONS, pause, retain=True)
    pid = pid_of("/vda5050_vehicles")
    subprocess.run(["kill", "-KILL", str(pid)], check=True)
    start = time.monotonic()
    master.all_are(False, site.robots)
    say(f"{len(site.robots)} wills {time.monotonic() - start:.1f} s after the program was killed")
    master.all_are(True, site.robots)
    state = master.states[who]
    master.until(lambda: master.states[who] is not state, WAIT, "a state")
    for kind in (Kind.ORDER, Kind.INSTANT_ACTIONS):
        master.told(who, f"a retained message on {kind.value} is not acted upon")
        master.post(who, kind, b"", retain=True)  # the broker forgets it
    assert not master.states[who].order_id and not master.states[who].paused
    say(f"back after {time.monotonic() - start:.1f} s; what was retained was not acted upon")


def pid_of(node):
    """Returns the process of a node."""
    uri = rosgraph.Master("/faults").lookupNode(node)
    return ServerProxy(uri).getPid("/faults")[2]


def password_and_tls(robots):
    """Vehicles at a broker that lets in by TLS and password alone."""
    run = subprocess.run
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        key, pem, users, secret = (folder / name for name in ("key", "pem", "users", "secret"))
        secret.write_text("secret\n")
        make = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt"]
        make += ["ec_paramgen_curve:P-256", "-nodes", "-keyout", key, "-out", pem]
        name = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"]
        run([*make, *name], check=True, capture_output=True)
        add = ["mosquitto_passwd", "-b", "-c", users, "robots", "secret"]
        run(add, check=True, capture_output=True)
        lines = f"cafile {pem}\ncertfile {pem}\nkeyfile {key}\npassword_file {users}"
        broker = stack.enter_context(OwnBroker(0, f"{lines}\nallow_anonymous false"))
        address = f"localhost:{broker.port}"
        words = [
            f"broker:={address}",
            f"tls:={pem}",
            "user:=robots",
            f"password_file:={secret}",
        ]
        stack.enter_context(vehicles(*words))
        settings = read_settings(address, str(pem), "robots", str(secret))
        master = Master(settings, CODEC, TOPICS, lambda _: None)
        stack.callback(master.close)
        master.all_are(True, robots)
    say(f"{len(robots)} vehicles by TLS and password")


def main():
    rospy.init_node("faults")
    with contextlib.ExitStack() as stack:
        site = Site(stack)
        broker_is_killed_while_a_robot_drives(site)
        broker_is_killed_while_a_robot_lifts(site)
        messages_are_hostile(site)
        another_master_orders_too(site)
        headers_go_back(site)
        all_vehicles_are_killed(site)
    password_and_tls(site.robots)
    say("done")


if __name__ == "__main__":
    sys.exit(main())
