# SPDX-License-Identifier: Apache-2.0
"""Who commanded what: clicks on pages and requests of programs over HTTP, commands over ROS."""

import csv
import io
import json
import threading
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Any
from urllib.parse import unquote

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from warehouse_viewer.page.journal import cell
from warehouse_viewer.rows import Columns, Rows

KEPT = 5000  # commands
MOST_TEXT = 300  # of a request's body
MOST_NAME = 60
PREFIX = "/api/v1/"
READS = ("GET", "HEAD", "OPTIONS")
COLUMNS: Columns = {
    "id": int,
    "time": float,
    "wall": 29,
    "by": 36,
    "address": 16,
    "method": 8,
    "path": 40,
    "body": 64,
    "status": int,
}
PERSON = b"x-person"  # a header: the person's name, percent-encoded


class CommandLog:
    """The newest KEPT commands as dicts of COLUMNS. Any thread may call. now(): simulated time."""

    def __init__(self, now: Callable[[], float]) -> None:
        self._now, self._lock, self._last = now, threading.Lock(), 0
        self._rows = Rows(KEPT, COLUMNS)

    def add(self, **fields: Any) -> None:
        """Adds a command with all COLUMNS but id and times."""
        wall = datetime.now(UTC).isoformat(timespec="milliseconds")
        with self._lock:
            self._last += 1
            row = {"id": self._last, "time": round(self._now(), 3), "wall": wall}
            self._rows[self._last % KEPT] = row | fields

    def rows(self, by: str = "", limit: int = KEPT) -> list[dict[str, Any]]:
        """Returns the newest commands, the oldest of them first; with `by` those of one person."""
        with self._lock:
            ids = range(max(0, self._last - KEPT) + 1, self._last + 1)
            rows = [self._rows[i % KEPT] for i in ids]
        return [row for row in rows if by in ("", row["by"])][-limit:]

    def csv(self) -> str:
        """Returns all commands, oldest first, for a spreadsheet."""
        text = io.StringIO()
        table = csv.DictWriter(text, COLUMNS)
        table.writeheader()
        table.writerows({name: cell(row[name]) for name in COLUMNS} for row in self.rows())
        return text.getvalue()


class LogsCommands:
    """ASGI middleware that notes each request that changes something, and its answer."""

    def __init__(self, app: ASGIApp, log: CommandLog) -> None:
        self._app, self._log = app, log

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        is_command = (
            scope["type"] == "http"
            and scope["method"] not in READS
            and scope["path"].startswith(PREFIX)
        )
        if not is_command:
            await self._app(scope, receive, send)
            return
        body, status = bytearray(), 0

        async def heard() -> Message:
            message = await receive()
            body.extend(message.get("body", b"")[: 4096 - len(body)])
            return message

        async def answered(message: Message) -> None:
            nonlocal status
            status = message.get("status", status)
            await send(message)

        try:
            await self._app(scope, heard, answered)
        finally:
            self._note(scope, bytes(body), status or 500)

    def _note(self, scope: Scope, body: bytes, status: int) -> None:
        client = scope.get("client")
        self._log.add(
            by=_person(scope, body),
            address=client[0] if client else "",
            method=scope["method"],
            path=scope["path"].removeprefix(PREFIX[:-1]),
            body=body.decode(errors="replace")[:MOST_TEXT],
            status=status,
        )


def _person(scope: Scope, body: bytes) -> str:
    """Returns the name that a request gives: in its header, or as `by` in its body."""
    name = dict(scope["headers"]).get(PERSON, b"").decode("latin-1")
    if not name:
        try:
            content = json.loads(body)
            name = content.get("by", "") if isinstance(content, dict) else ""
        except ValueError:
            name = ""
    return "".join(c for c in unquote(str(name)) if c.isprintable())[:MOST_NAME]
