# SPDX-License-Identifier: Apache-2.0
"""The last events, numbered, for readers that come late or read slowly."""

import csv
import io
import re
import threading
from typing import Any

from warehouse_layout.message_enums import EventKind
from warehouse_viewer.page.own_events import OwnEvents
from warehouse_viewer.rows import Columns, Rows

KEPT = 2000
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
COLUMNS: Columns = {
    "id": int,
    "time": float,
    "kind": 16,
    "command": int,
    "model": 20,
    "other": 20,
    "text": 88,
}


class Journal:
    """Events as dicts of COLUMNS, with a running `id`. Any thread may add, any may read.

    The newest KEPT are there, and the newest of the kinds that OUTLAST others of each model: of
    those MODELS that had one last.
    """

    def __init__(self, kept: int = KEPT, models: int = MODELS) -> None:
        self._lock, self.last_id = threading.Lock(), 0
        self._events, self._own = Rows(kept, COLUMNS), OwnEvents(COLUMNS, models)

    def expect(self, models: int) -> None:
        """Allocates memory for the own events of `models` models before they come."""
        with self._lock:
            self._own.expect(models)

    def add(self, event: dict[str, Any]) -> dict[str, Any]:
        """Adds an event with all COLUMNS but its id; returns its entry."""
        with self._lock:
            self.last_id += 1
            entry = event | {"id": self.last_id}
            self._events[self.last_id % len(self._events)] = entry
            names = {event["model"], event["other"]} - {""}
            if names and event["kind"] in OUTLAST:
                self._own.add(names, entry)
            return entry

    def since(
        self, number: int, model: str | None = None, limit: int = KEPT
    ) -> list[dict[str, Any]]:
        """Returns the newest `limit` of the entries with an id above `number`, oldest first.

        With `model` only those that name it.
        """
        if number >= self.last_id:
            return []
        with self._lock:
            if model is None:
                return self._newest(max(number, self.last_id - limit))
            entries = [e for e in self._newest(number) if model in (e["model"], e["other"])]
            first = entries[0]["id"] if entries else self.last_id + 1
            own = [e for e in self._own.of(model) if number < e["id"] < first]
        return (own + entries)[-limit:]

    def _newest(self, number: int) -> list[dict[str, Any]]:
        kept = len(self._events)
        ids = range(max(number, self.last_id - kept) + 1, self.last_id + 1)
        return [self._events[i % kept] for i in ids]

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
