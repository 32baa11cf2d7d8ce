# SPDX-License-Identifier: Apache-2.0
"""What happened to a vehicle last, and reports of it that masters ask for."""

import time
from collections import deque
from pathlib import Path


class Journal:
    """Lines of text, the newest 200. `folder` is where reports are stored, None: nowhere; `name` is
    how their names begin."""

    def __init__(self, name: str, folder: Path | None) -> None:
        self._name, self._folder = name, folder
        self._lines: deque[str] = deque(maxlen=200)
        self._count = 0

    def write(self, line: str) -> None:
        """Adds a line."""
        self._lines.append(line[:300])

    def store(self, reason: str) -> str:
        """Stores a report with all lines; returns its name. Raises OSError."""
        if self._folder is None:
            raise OSError("this vehicle has no folder for reports")
        self._count += 1
        moment = time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())
        name = f"{self._name}-{moment}-{self._count}.log"
        self._folder.mkdir(parents=True, exist_ok=True)
        text = "\n".join([f"reason: {reason[:200]}", *self._lines, ""])
        (self._folder / name).write_text(text, encoding="utf-8")
        return name
