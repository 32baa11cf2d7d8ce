# SPDX-License-Identifier: Apache-2.0
"""Many vehicles without a world, and the robots of theirs that drive by a formula."""

import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time

import pytest
from paths import ROOT

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.demo_master import DemoMaster, order_of
from warehouse_vda5050.formula_driver import FormulaRobot
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import Identity, Topics
from warehouse_vda5050.virtual import VirtualFleet, VirtualSettings

PROGRAM = ROOT / "src" / "warehouse_vda5050" / "nodes" / "virtual"
GRID = Grid(0.0, 0.0, 1.0, 20, 10)
needs_mosquitto = pytest.mark.skipif(
    not (shutil.which("mosquitto") or pathlib.Path("/usr/sbin/mosquitto").exists()),
    reason="mosquitto is not installed",
)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def test_a_formula_drives_along_its_path_at_its_speed():
    robot = FormulaRobot(0.0, 0.0, 0.0, speed=2.0)
    robot.follow(7, 0, [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)], 3)
    robot.step(1.0)
    assert robot.report().x == pytest.approx(2.0) and robot.report().vx == pytest.approx(2.0)
    robot.step(1.5)
    report = robot.report()
    assert (report.x, report.y, report.reached) == (4.0, pytest.approx(1.0), 2)
    assert report.yaw == pytest.approx(1.5708, abs=1e-3) and report.busy
    robot.step(10.0)
    report = robot.report()
    assert (report.y, report.reached, report.busy, report.moving) == (3.0, 3, False, False)


def test_a_formula_stands_while_it_is_paused_and_ends_at_the_next_point():
    robot = FormulaRobot(0.0, 0.0, 0.0, speed=1.0)
    robot.follow(1, 0, [(0.0, 0.0), (2.0, 0.0), (9.0, 0.0)], 3)
    robot.step(1.0)
    robot.stop(True)
    robot.step(5.0)
    assert robot.report().x == pytest.approx(1.0) and not robot.report().moving
    robot.stop(False)
    robot.cancel()
    robot.step(5.0)
    assert (robot.report().x, robot.report().busy) == (2.0, False)


def test_a_formula_lifts_in_its_time():
    robot = FormulaRobot(0.0, 0.0, 0.0, speed=1.0)
    robot.lift("7", True)
    robot.step(1.0)
    assert robot.report().busy and robot.report().load == ""
    robot.step(1.5)
    assert not robot.report().busy and robot.report().load == "7"
    robot.lift("", False)
    robot.step(3.0)
    assert robot.report().load == ""


def fleet_of(count, grid=GRID):
    return VirtualFleet(
        VirtualSettings(count, "kiva", codec_for(), Topics(), BrokerSettings(), grid)
    )


def test_vehicles_are_spread_over_the_floor():
    fleet = fleet_of(40)
    fleet.tick(0.0)
    cells = {GRID.cell_at(link.vehicle.report.x, link.vehicle.report.y) for link in fleet.links}
    assert len(cells) == 40 and {row for _, row in cells} == set(range(10))


@pytest.mark.parametrize("count", [0, -1, 201])
def test_too_many_for_the_floor_are_refused(count):
    with pytest.raises(ValueError, match=rf"vehicles is {count}; 1 to 200 was expected"):
        fleet_of(count)


@needs_mosquitto
def test_a_master_drives_a_virtual_fleet_some_of_which_has_faults(tmp_path):
    faults = tmp_path / "faults.yaml"
    faults.write_text(
        "- {at: 0, vehicle: 2, fault: battery}\n- {at: 0, vehicle: 99, fault: lost}\n"
    )
    with OwnBroker(free_port()) as broker:
        address = f"127.0.0.1:{broker.port}"
        command = [sys.executable, "-u", str(PROGRAM), "--broker", address, "--vehicles", "30"]
        command += ["--floor", "20x10", "--speed", "5", "--faults", str(faults)]
        process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        settings = BrokerSettings("127.0.0.1", broker.port)
        master = DemoMaster(settings, codec_for(), Topics(), lambda _line: None)
        try:
            assert len(master.wait_for_vehicles(30)) == 30
            who = Identity("kiva", "1")
            at = master.states[who].position
            here = GRID.cell_at(at.x, at.y)
            way = [(here[0] + k, here[1]) for k in range(5)]
            state = master.carry_out(who, order_of("o", way, GRID), 30)
            assert state.last_node == GRID.node_id(way[-1])
            second = Identity("kiva", "2")
            master.until(lambda: master.states[second].battery.charge == 4, 10, "the fault")
            process.send_signal(signal.SIGINT)
            master.until(lambda: not any(master.online.values()), 10, "OFFLINE of all")
            text, _ = process.communicate(timeout=20)
        finally:
            master.close()
            process.kill()
    assert "30 vehicles are connected" in text
    assert f"{faults}:2: vehicle 99 is not there; 1 to 30 are" in text
    assert process.returncode == 0


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("--vehicles", "0"), "vehicles is 0; 1 to 1000 was expected"),
        (("--floor", "big"), "floor is 'big'; 40x25, say, was expected"),
        (("--floor", "0x5"), "floor is '0x5'"),
        (("--speed", "nan"), "speed is nan; 0.01 or more was expected"),
        (("--interval", "-1"), "interval is -1; 0.01 or more was expected"),
        (("--visualization", "inf"), "visualization is inf; 0 or more was expected"),
        (("--version", "9"), "version is '9'"),
        (("--faults", "/none.yaml"), "/none.yaml"),
        (("--manufacturer", "a b"), "manufacturer is 'a b'"),
    ],
)
def test_bad_arguments_get_a_sentence(arguments, reason):
    begin = time.monotonic()
    done = subprocess.run(
        [sys.executable, str(PROGRAM), *arguments],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 2 and reason in done.stderr and "Traceback" not in done.stderr
    assert time.monotonic() - begin < 50
