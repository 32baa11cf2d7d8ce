# SPDX-License-Identifier: Apache-2.0
"""Every message between master and vehicle, with its time."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from warehouse_vda5050.topics import Kind


@dataclass(frozen=True)
class Entry:
    """A message. time: since the run began [s]. value: with the names of 2.1.0, None if it is no
    JSON object. sent: by us. qos and retained: as the broker delivered it. Where we play vehicles:
    which one it is of, the facts of the scene when it came, and whether the vehicle missed it."""

    time: float
    kind: Kind
    payload: bytes
    value: dict[str, Any] | None
    sent: bool = False
    qos: int = 0
    retained: bool = False
    vehicle: str = ""
    scene: Mapping[str, Any] = field(default_factory=dict, repr=False, compare=False)
    missed: bool = False

    @property
    def topic(self) -> str:
        """The kind of message, with its vehicle if there are several."""
        return f"{self.vehicle}/{self.kind.value}" if self.vehicle else self.kind.value

    @property
    def stamp(self) -> datetime:
        """The timestamp of its header. Raises ValueError."""
        return datetime.fromisoformat(str((self.value or {}).get("timestamp")))

    @property
    def text(self) -> str:
        """The payload for people."""
        return self.payload.decode("utf-8", "replace")


@dataclass
class Log:
    """All messages, oldest first."""

    entries: list[Entry] = field(default_factory=list)

    def add(self, entry: Entry) -> None:
        """Adds the newest message."""
        self.entries.append(entry)

    def heard(self, kind: Kind, since: int = 0) -> Iterator[Entry]:
        """Yields the messages of the other side of one kind, from number `since` on."""
        return (e for e in self.entries[since:] if e.kind is kind and not e.sent)

    def values(self, kind: Kind, since: int = 0) -> list[dict[str, Any]]:
        """Returns the readable messages of the other side of one kind."""
        return [e.value for e in self.heard(kind, since) if e.value is not None]

    def last(self, kind: Kind) -> dict[str, Any] | None:
        """Returns the newest readable message of one kind."""
        return next(
            (e.value for e in reversed(self.entries) if e.kind is kind and not e.sent and e.value),
            None,
        )

    def newest(self, condition: Callable[[Entry], bool]) -> int:
        """Returns the number of the newest message that a condition holds for, 0 without any."""
        numbers = range(len(self.entries) - 1, -1, -1)
        return next((i for i in numbers if condition(self.entries[i])), 0)

    def write(self, file: Path) -> None:
        """Writes a JSON line a message."""
        lines = (
            json.dumps(
                {
                    "time": round(entry.time, 3),
                    "topic": entry.topic,
                    "direction": "sent" if entry.sent else "received",
                    "payload": entry.text,
                }
            )
            for entry in self.entries
        )
        file.write_text("".join(line + "\n" for line in lines), encoding="utf-8")
