# SPDX-License-Identifier: Apache-2.0
"""Saves the world of a simulation that runs as a file."""

from pathlib import Path
from typing import Any

from warehouse_sim.hub import programs
from warehouse_sim.hub.simulation import Simulation


def save(simulation: Simulation, path: Path) -> dict[str, Any]:
    """Writes the world into a file that may be there; returns what was saved. Raises OSError."""
    code, text = programs.run(simulation, "save_world", str(path), "--replace")
    if code:
        raise OSError(text)
    said = text.replace(str(path), f"the world '{path.stem}'")
    return {"world": path.stem, "path": str(path), "message": said}
