# SPDX-License-Identifier: Apache-2.0
"""Checks that mypy reads the types of an installed wheel: it refuses what is wrong, and no more."""

import subprocess
import sys

RIGHT = """
from kiva_plugin_cpp import World
from warehouse_fleet import _core as planner
from warehouse_layout import _core as layout
from warehouse_learning.marl import policy
from warehouse_learning.rware import RwareVectorEnv, Warehouse

world: World = World.preset("small")
time: float = world.time
robots: policy.GridPolicy = policy.load("tiny-4ag")
env: Warehouse = Warehouse(n_agents=2, physics="bodies")
envs: RwareVectorEnv = RwareVectorEnv(64, n_agents=2)
"""
WRONG = RIGHT + "world.step('a minute')\n"


def faults(text: str) -> str:
    """Returns what mypy says of a program; "" if nothing."""
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", "-c", text]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stdout + done.stderr


if __name__ == "__main__":
    if reported := faults(RIGHT):
        sys.exit(f"mypy refuses what is right:\n{reported}")
    reported = faults(WRONG)
    if 'Argument 1 to "step" of "World"' not in reported:
        sys.exit(f"mypy does not see what is wrong:\n{reported}")
    print("mypy reads the stubs")
