# SPDX-License-Identifier: Apache-2.0
"""The last events, numbered, for readers that come late or read slowly."""

import csv
import io
import re
import threading
from collections import deque
from typing import Any

from warehouse_layout.message_enums import EventKind

KEPT = 2000
OWN = 10  # events of a model that outlast the KEPT of all
MODELS = 4000  # whose own events are kept: models come and go as long as the page's server runs
TROUBLES = frozenset(
    kind.name
    for kind in (
        EventKind.REFUSED,
        EventKind.BLOCKED,
        EventKind.COLLISION,
        EventKind.FAILED,
        EventKind.LOST,
        EventKind.TIPPED,
        EventKind.FELL,
    )
)
ALARM, ALARM_OVER = "ALARM", "ALARM_OVER"  # kinds of entries that a monitor adds
OUTLAST = TROUBLES | {EventKind.REPAIRED.name, ALARM, ALARM_OVER}
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "＝", "＋", "－", "＠")
NUMBER = re.compile(r"[+-]?\d+(\.\d*)?\Z")
COLUMNS = ("id", "time", "kind", "command", "model", "other", "text")


class Journal:
    """Events as dicts of COLUMNS, with a running `id`. Any thread may add, any may read.

    The newest KEPT are there, and the newest OWN of the kinds that OUTLAST others of each model:
    of those MODELS that had one last.
    """

    def __init__(self, kept: int = KEPT, models: int = MODELS) -> None:
        self._lock, self.last_id = threading.Lock(), 0
        self._events: deque[dict[str, Any]] = deque(maxlen=kept)
        self._models = models
        self._own: dict[str, deque[dict[str, Any]]] = {}  # the model that had one last is the last

    def add(self, event: dict[str, Any]) -> dict[str, Any]:
        """Adds an event with all COLUMNS but its id; returns its entry."""
        with self._lock:
            self.last_id += 1
            entry = event | {"id": self.last_id}
            self._events.append(entry)
            if event["kind"] in OUTLAST:
                for name in {event["model"], event["other"]} - {""}:
                    self._keep_own(name, entry)
            return entry

    def _keep_own(self, name: str, entry: dict[str, Any]) -> None:
        own = self._own.pop(name, deque(maxlen=OWN))
        own.append(entry)
        self._own[name] = own
        if len(self._own) > self._models:
            del self._own[next(iter(self._own))]

    def since(
        self, number: int, model: str | None = None, limit: int = KEPT
    ) -> list[dict[str, Any]]:
        """Returns the newest `limit` of the entries with an id above `number`, oldest first.

        With `model` only those that name it.
        """
        if number >= self.last_id:
            return []
        with self._lock:
            entries = [e for e in self._events if e["id"] > number]
            own = () if model is None else tuple(self._own.get(model, ()))
        if model is not None:
            entries = [e for e in entries if model in (e["model"], e["other"])]
            first = entries[0]["id"] if entries else self.last_id + 1
            entries = [e for e in own if number < e["id"] < first] + entries
        return entries[-limit:]

    def csv(self) -> str:
        """Returns all entries, oldest first, for a spreadsheet."""
        text = io.StringIO()
        table = csv.DictWriter(text, COLUMNS)
        table.writeheader()
        table.writerows({name: cell(e[name]) for name in COLUMNS} for e in self.since(0))
        return text.getvalue()


def cell(value: object) -> object:
    """Returns what no spreadsheet takes for a formula: names and texts are of anybody (OWASP, CSV
    injection). Numbers stay numbers."""
    is_formula = isinstance(value, str) and value.startswith(FORMULA) and not NUMBER.match(value)
    return f"'{value}" if is_formula else value
