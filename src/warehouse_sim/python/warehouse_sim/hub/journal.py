# SPDX-License-Identifier: Apache-2.0
"""The hub's journal: what was changed by whom, by assistants and by people.

A line of JSON for each entry, in a file that is kept below a size; the one before it stays.
"""

import json
import threading
import time
from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

NAME = "journal.jsonl"
MOST_BYTES = 8 << 20  # of a file; two are kept
KEPT = 2000  # entries that are read
MOST_TEXT = {"who": 120, "action": 80, "simulation": 40, "arguments": 1000, "outcome": 400}
KINDS = ("assistant", "person", "hub")


class Journal:
    """Entries with a running `id`, in a folder's file NAME. Any thread may call."""

    def __init__(self, folder: Path) -> None:
        self._file, self._lock = folder / NAME, threading.Lock()
        self._entries: deque[dict[str, Any]] = deque(maxlen=KEPT)
        for path in (self._older, self._file):
            with suppress(OSError):
                for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
                    self._read(line)
        self._last = max((entry["id"] for entry in self._entries), default=0)

    @property
    def _older(self) -> Path:
        return self._file.with_suffix(".1.jsonl")

    def _read(self, line: str) -> None:
        with suppress(ValueError, KeyError, TypeError):  # a line that was cut off
            entry = json.loads(line)
            self._entries.append(entry | {"id": int(entry["id"])})

    def add(self, kind: str, texts: Mapping[str, object], is_done: bool) -> dict[str, Any]:
        """Adds an entry: who asked (`who`), what for (`action`, `arguments`), of which simulation,
        and what came of it (`outcome`). Returns it."""
        bounded = {key: _line(texts.get(key, ""), most) for key, most in MOST_TEXT.items()}
        with self._lock:
            self._last += 1
            wall = time.strftime("%Y-%m-%dT%H:%M:%S%z")
            entry = {"id": self._last, "wall": wall, "kind": kind, **bounded, "done": is_done}
            self._entries.append(entry)
            with suppress(OSError):  # what runs is worth more than its journal
                self._write(json.dumps(entry, ensure_ascii=False))
        return entry

    def note_end(self, simulation: str, reason: str) -> None:
        """Adds an entry about a simulation that ended without a request."""
        texts = {"who": "the hub", "action": "end", "simulation": simulation, "outcome": reason}
        self.add("hub", texts, True)

    def _write(self, line: str) -> None:
        with suppress(FileNotFoundError):
            if self._file.stat().st_size > MOST_BYTES:
                self._file.replace(self._older)
        with self._file.open("a", encoding="utf-8") as file:
            file.write(line + "\n")

    def since(self, number: int, simulation: str = "", limit: int = KEPT) -> list[dict[str, Any]]:
        """Returns the newest `limit` of the entries with an id above `number`, oldest first; those
        of a simulation, if one is named."""
        with self._lock:
            entries = [
                e for e in self._entries if e["id"] > number and simulation in ("", e["simulation"])
            ]
        return entries[-limit:]


def _line(value: object, most: int) -> str:
    """Returns a text on one line, without what a terminal would obey."""
    text = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=str)
    line = "".join(c if c.isprintable() else " " for c in text[: 2 * most])
    return line if len(line) <= most else line[: most - 1] + "…"
