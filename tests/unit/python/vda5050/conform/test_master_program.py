# SPDX-License-Identifier: Apache-2.0
"""The program conform --master, at a real broker, with our master at the same broker."""

import contextlib
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time

import pytest
from paper_master import FRAMES, GRID, Coordinator, roles
from test_conform_program import PROGRAM, free_port

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.master_link import MasterLink
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import Topics

pytestmark = pytest.mark.skipif(
    not (shutil.which("mosquitto") or pathlib.Path("/usr/sbin/mosquitto").exists()),
    reason="mosquitto is not installed",
)
PLAYED = [
    f"{role.identity.manufacturer}/{role.identity.serial}@{role.x},{role.y},0,{role.node}"
    for role in roles()
]


@pytest.fixture
def broker():
    with OwnBroker(free_port()) as broker:
        yield broker


class Master(threading.Thread):
    """Our master in a thread of its own, with a coordinator that always has something to carry."""

    def __init__(self, port):
        super().__init__(daemon=True)
        who = [role.identity for role in roles()]
        robots = [RemoteRobot(k, *pair) for k, pair in enumerate(zip(who, FRAMES), 1)]
        self.fleet, self.loop = RemoteFleet(robots, GRID, "real"), MqttLoop()
        self.coordinator, self.ended = Coordinator(self.fleet), threading.Event()
        settings = BrokerSettings("127.0.0.1", port)
        self.link = MasterLink("master", who, codec_for(), Topics(), settings, self.take)
        self.loop.add(self.link.link)

    def take(self, identity, message):
        self.fleet.take(identity, message, time.monotonic())

    def run(self):
        while not self.ended.is_set():
            self.loop.poll(0.05)
            self.coordinator.step(time.monotonic())
            for identity, message in self.fleet.messages(time.monotonic()):
                self.link.send(identity, message)
            for event in self.fleet.take_events():
                self.coordinator.take(event)
        self.link.link.close()
        self.loop.close()


@contextlib.contextmanager
def master_at(port):
    master = Master(port)
    master.start()
    try:
        yield master
    finally:
        master.ended.set()
        master.join(10)


def command(port, *arguments):
    return [
        *(sys.executable, str(PROGRAM), "--master", "--broker", f"127.0.0.1:{port}"),
        *("--play", *PLAYED),
        *map(str, arguments),
    ]


AUDITS = ("order", "update", "messages", "actions.ids", "instant.repeats", "instant.copies")


@pytest.mark.long
def test_our_master_conforms_at_a_real_broker(broker, tmp_path):
    tried = ("modes.manual", "connection.broken", "states.stale", "horizon.base_request", *AUDITS)
    with master_at(broker.port):
        run = subprocess.run(
            command(broker.port, "--out", tmp_path / "out", "--strict", "--only", *tried),
            check=False,
            capture_output=True,
            text=True,
            timeout=300,
        )
    assert run.returncode == 0, run.stdout + run.stderr
    assert "differs" not in run.stdout and "not testable" not in run.stdout
    page = (tmp_path / "out" / "report.html").read_text()
    assert "the master of conform/1, conform/2" in page
    lines = (tmp_path / "out" / "messages.jsonl").read_text().splitlines()
    kept = [json.loads(line) for line in lines if "CONNECTIONBROKEN" in line]
    assert kept, "the broker published no will"


def test_without_a_master_it_is_not_tried(broker, tmp_path):
    run = subprocess.run(
        command(broker.port, "--out", tmp_path, "--patience", 1, "--only", "order", "modes.manual"),
        check=False,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert run.returncode == 2, run.stdout + run.stderr
    assert "let the master send an order to conform/1 or conform/2" in run.stdout
    assert "the master sent no order" in run.stdout


def test_ctrl_c_ends_with_the_report_so_far(broker, tmp_path):
    with master_at(broker.port):
        run = subprocess.Popen(
            command(broker.port, "--out", tmp_path, "--only", "modes", "order"),
            stdout=subprocess.PIPE,
            text=True,
        )
        first = run.stdout.readline()
        run.send_signal(signal.SIGINT)
        text, _ = run.communicate(timeout=60)
    assert run.returncode == 2, first + text
    assert "conforms     order.nodes" in text and (tmp_path / "junit.xml").is_file()


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ([], "--out is missing"),
        (["--out", "x", "--patience", "0"], "--patience has to be above 0"),
        (["--out", "x", "--only", "orders"], "no case or chapter orders"),
        (["--out", "x", "--vehicle", "a/1"], "not allowed with argument"),
    ],
)
def test_wrong_arguments_are_refused(tmp_path, arguments, text):
    run = subprocess.run(
        command(1883, *arguments),
        check=False,
        capture_output=True,
        text=True,
        timeout=60,
        cwd=tmp_path,
    )
    assert run.returncode == 2 and text in run.stderr


def test_list():
    run = subprocess.run(
        command(free_port(), "--list"), check=False, capture_output=True, text=True, timeout=60
    )
    assert run.returncode == 0 and len(run.stdout.splitlines()) > 90
