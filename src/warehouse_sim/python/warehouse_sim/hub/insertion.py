# SPDX-License-Identifier: Apache-2.0
"""Adds the models of a world file to a simulation that runs, all of them or none."""

import math
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from warehouse_layout.file import files
from warehouse_layout.models import world_file
from warehouse_sim.hub import programs
from warehouse_sim.hub.simulation import Simulation
from warehouse_sim.hub.wish import MOST_TEXT, WishError

IN_THE_WAY = 3  # exit code of insert_world


class InTheWay(RuntimeError):  # noqa: N818 (an answer)
    """Raised where the running world refuses the models, as for an overlap; says why."""


def insert(simulation: Simulation, body: Mapping[str, Any]) -> str:
    """Returns what was added. Raises WishError, InTheWay."""
    unknown = sorted(body.keys() - {"world", "x", "y", "yaw"})
    if unknown:
        raise WishError(unknown[0][:100], "world, x, y and yaw were expected")
    x, y, yaw = (_number(body, key) for key in ("x", "y", "yaw"))
    text = body.get("world")
    if not isinstance(text, str) or not text or len(text) > MOST_TEXT or "\0" in text:
        raise WishError("world", "the name, the path or the text of an SDF world was expected")
    place = [f"at:={x!r},{y!r}", f"yaw:={yaw!r}"]
    if text.lstrip().startswith("<"):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "sent.sdf")
            path.write_text(text, encoding="utf-8")
            return _run(simulation, str(path), place)
    try:
        return _run(
            simulation, str(world_file.find(text, files.worlds(), simulation.folder)), place
        )
    except world_file.WorldFileError as error:
        raise WishError("world", str(error)) from error


def _number(body: Mapping[str, Any], key: str) -> float:
    value = body.get(key, 0)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise WishError(key, "a finite number was expected")
    return float(value)


def _run(simulation: Simulation, path: str, place: list[str]) -> str:
    try:
        code, text = programs.run(simulation, "insert_world", path, *place)
    except TimeoutError as error:
        raise InTheWay(str(error)) from error
    if code == IN_THE_WAY:
        raise InTheWay(text)
    if code:
        raise WishError("world", text)
    return text
