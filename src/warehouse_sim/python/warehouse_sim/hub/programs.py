# SPDX-License-Identifier: Apache-2.0
"""Runs programs of warehouse_sim within a simulation."""

import subprocess

from warehouse_sim.hub.simulation import Simulation

PATIENCE = 120.0  # with a large world [s, wall]


def run(simulation: Simulation, program: str, *arguments: str) -> tuple[int, str]:
    """Returns the exit code of a program, and what it printed; of one that failed the last line of
    its errors, without its name. Raises TimeoutError."""
    assert simulation.process
    try:
        ran = subprocess.run(
            ["rosrun", "warehouse_sim", program, *arguments],
            env=simulation.process.environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise TimeoutError(f"the world did not answer within {PATIENCE:g} s") from error
    if ran.returncode == 0:
        return 0, ran.stdout.strip()
    reason = (ran.stderr.strip().splitlines() or [f"{program} failed"])[-1]
    return ran.returncode, reason.removeprefix(f"{program}: ")
