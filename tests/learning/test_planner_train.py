# SPDX-License-Identifier: Apache-2.0
"""The example that teaches a planner writes one that drives a fleet."""

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("gymnasium", reason="gymnasium is missing: scripts/learning_packages")

from kiva_plugin_cpp import World  # noqa: E402
from warehouse_fleet.hosts.fleet_driver import FleetDriver  # noqa: E402

EXAMPLE = Path(__file__).parents[2] / "examples/planner_train.py"


def test_a_planner_is_taught(tmp_path):
    out = tmp_path / "planner.npz"
    options = "--size small --rounds 2 --minutes 0.5 --steps 300 --hidden 4"
    command = [sys.executable, EXAMPLE, *options.split(), "--out", out]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    agrees = [float(line.split("%")[0]) for line in said.splitlines() if "%" in line]
    assert len(agrees) == 2 and min(agrees) > 80, said
    spec = {"planner": "learned", "options": {"file": str(out)}}
    driver = FleetDriver(World.preset("small"), planner=spec)
    unit = min(driver.transports.cell_of_unit)
    driver.transports.submit(unit, "pick1")
    while driver.time < 90 and driver.transports.cell_of_unit[unit] >= 0:
        driver.step()
    assert driver.transports.cell_of_unit[unit] < 0 and not driver.traffic.plans.refused
    driver.close()
