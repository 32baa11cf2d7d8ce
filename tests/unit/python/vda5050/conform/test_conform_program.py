# SPDX-License-Identifier: Apache-2.0
"""The program conform, at a real broker, with a vehicle that is connected through its proxy."""

import contextlib
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest
from paper_vehicle import TICK, WHO, PaperRobot
from paths import ROOT

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.topics import Topics
from warehouse_vda5050.vehicle import Vehicle

from grid_robot import GRID  # isort: skip

PROGRAM = ROOT / "src" / "warehouse_vda5050" / "nodes" / "conform"
pytestmark = pytest.mark.skipif(
    not (shutil.which("mosquitto") or pathlib.Path("/usr/sbin/mosquitto").exists()),
    reason="mosquitto is not installed",
)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def vehicle_at(port):
    """A vehicle in a thread of its own, connected to a port."""
    robot, loop, ended = PaperRobot(), MqttLoop(), threading.Event()
    vehicle = Vehicle(robot, GRID)
    link = VehicleLink(vehicle, WHO, codec_for(), Topics(), BrokerSettings("127.0.0.1", port))
    loop.add(link.link)

    def run():
        while not ended.is_set():
            loop.poll(TICK)
            robot.step()
            link.tick(time.monotonic())

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield robot
    finally:
        ended.set()
        thread.join()
        link.close()
        loop.close()


def command(*arguments):
    return [sys.executable, str(PROGRAM), *map(str, arguments)]


@pytest.fixture
def broker():
    with OwnBroker(free_port()) as broker:
        yield broker


@pytest.mark.long
def test_a_vehicle_conforms_and_its_connection_is_cut(broker, tmp_path):
    proxy = free_port()
    with vehicle_at(proxy):
        arguments = ["--broker", f"127.0.0.1:{broker.port}", "--vehicle", "paper/1"]
        only = ["--only", "connection", "recovery", "order.one_edge", "fields.max_speed"]
        run = subprocess.run(
            command(*arguments, "--proxy", proxy, "--out", tmp_path / "out", *only),
            check=False,
            capture_output=True,
            text=True,
            timeout=120,
        )
    assert run.returncode == 0, run.stdout + run.stderr
    assert "14 of 14 cases conform" in run.stdout
    assert (tmp_path / "out" / "report.html").is_file()


def test_ctrl_c_ends_with_the_report_so_far(broker, tmp_path):
    with vehicle_at(broker.port) as robot:
        run = subprocess.Popen(
            command(
                *("--broker", f"127.0.0.1:{broker.port}", "--vehicle", "paper/1"),
                *("--out", tmp_path, "--only", "order", "update"),
            ),
            stdout=subprocess.PIPE,
            text=True,
        )
        deadline = time.monotonic() + 30
        while robot.reached < 2 and time.monotonic() < deadline:
            time.sleep(0.02)
        run.send_signal(signal.SIGINT)
        text, _ = run.communicate(timeout=30)
        assert not robot.busy
    assert run.returncode == 2, text
    assert "interrupted" in text and "interrupted" in (tmp_path / "report.html").read_text()


def ended(*arguments):
    return subprocess.run(
        command(*arguments), check=False, capture_output=True, text=True, timeout=60
    )


def test_without_a_broker_it_is_not_tried(tmp_path):
    run = ended("--broker", f"127.0.0.1:{free_port()}", "--vehicle", "a/1", "--out", tmp_path)
    assert run.returncode == 2 and "refused" in run.stderr


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["--vehicle", "a/1"], "--out"),
        (["--vehicle", "a", "--out", "x"], "serial is ''"),
        (
            ["--vehicle", "a/1", "--out", "x", "--version", "1.1"],
            "2.0.0, 2.1.0, 3.0.0 was expected",
        ),
        (["--vehicle", "a/1", "--out", "x", "--only", "orders"], "no case or chapter orders"),
        (["--vehicle", "a/1", "--out", "x", "--edges", "0"], "above 0"),
    ],
)
def test_wrong_arguments_are_refused(tmp_path, arguments, text):
    run = subprocess.run(
        command(*arguments), check=False, capture_output=True, text=True, timeout=60, cwd=tmp_path
    )
    assert run.returncode == 2 and text in run.stderr


def test_list():
    run = ended("--list")
    assert run.returncode == 0 and len(run.stdout.splitlines()) > 200
