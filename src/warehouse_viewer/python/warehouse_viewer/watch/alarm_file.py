# SPDX-License-Identifier: Apache-2.0
"""The file from which a viewer that is restarted has the alarms of its warehouse."""

import json
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from warehouse_layout.file import user_file

MOST_BYTES = 10_000_000
KEPT = 20  # files, of as many launches


def default_path(run: str, namespace: str, environment: Mapping[str, str] = os.environ) -> Path:
    """Returns where the alarms of a launch are kept. `run`: roslaunch's run_id."""
    home = environment.get("ROS_HOME") or Path.home() / ".ros"
    name = re.sub(r"[^\w-]+", "_", f"{run}{namespace}".rstrip("/"))
    return Path(home) / "warehouse" / "alarms" / f"{name[:200]}.json"


class AlarmFile:
    """Keeps the state of an AlarmBook, for its owner's eyes alone."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def read(self) -> dict[str, Any] | None:
        """Returns the state, or None without a file. Raises OSError, ValueError."""
        try:
            state = json.loads(user_file.read_text(self._path, most=MOST_BYTES))
        except FileNotFoundError:
            return None
        if not isinstance(state, dict):
            raise ValueError(f"{self._path}: an object was expected")
        return state

    def write(self, state: Mapping[str, Any]) -> None:
        """Replaces the state at once or not at all. Raises OSError."""
        self._path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        new = self._path.with_suffix(".new")
        with open(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as out:
            json.dump(state, out)
        new.replace(self._path)
        files = sorted(self._path.parent.glob("*.json"), key=_age)
        for old in files[:-KEPT]:
            old.unlink(missing_ok=True)


def _age(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except FileNotFoundError:  # another viewer removed it
        return 0.0
