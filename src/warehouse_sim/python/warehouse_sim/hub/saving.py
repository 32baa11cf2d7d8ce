# SPDX-License-Identifier: Apache-2.0
"""Saves the world of a simulation that runs as a file."""

import subprocess
from pathlib import Path
from typing import Any

from warehouse_sim.hub.simulation import Simulation

PATIENCE = 120.0  # with a large world [s, wall]


def save(simulation: Simulation, path: Path) -> dict[str, Any]:
    """Writes the world into a file that may be there; returns what was saved. Raises OSError."""
    assert simulation.process
    command = ["rosrun", "warehouse_sim", "save_world", str(path), "--replace"]
    try:
        ran = subprocess.run(
            command,
            env=simulation.process.environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise OSError(f"the world did not answer within {PATIENCE:g} s") from error
    if ran.returncode:
        reason = (ran.stderr.strip().splitlines() or ["save_world failed"])[-1]
        raise OSError(reason.removeprefix("save_world: "))
    said = ran.stdout.strip().replace(str(path), f"the world '{path.stem}'")
    return {"world": path.stem, "path": str(path), "message": said}
