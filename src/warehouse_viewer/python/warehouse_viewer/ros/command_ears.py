# SPDX-License-Identifier: Apache-2.0
"""Who commands robots over ROS topics: people with rostopic, and programs of others."""

import json
from types import ModuleType
from typing import Any

from warehouse_client.commands import COMMANDS
from warehouse_client.message_check import subscribe
from warehouse_viewer.api.command_log import MOST_TEXT, CommandLog

PLANS = ("follow", "warehouse/follow")  # of planners, many a second: no command of a person
COORDINATOR = "coordinator"
TOPIC = "TOPIC"  # instead of an HTTP method
UNANSWERED = 0  # status: a topic has no answer; the events have it


class CommandEars:
    """Notes each command that comes over a topic, with the node that sent it.

    Those of this node are requests over HTTP, which are noted as such; the coordinator's are no
    person's.
    """

    def __init__(self, ros: ModuleType, log: CommandLog) -> None:
        self._ros, self._log = ros, log
        self._subscribers: list[Any] = []

    def begin(self) -> None:
        """Listens from now on. Call it once the world is there: a program that waits for a listener
        before it commands waits for the world."""
        if self._subscribers:
            return
        self._subscribers = [
            subscribe(self._ros, topic, kind, self._note, topic, queue_size=100)
            for topic, kind in COMMANDS.items()
            if topic not in PLANS
        ]

    def _note(self, message: Any, topic: str) -> None:
        header = getattr(message, "_connection_header", None) or {}
        sender = header.get("callerid", "")
        if sender in (self._ros.get_name(), self._ros.resolve_name(COORDINATOR)):
            return
        self._log.add(
            by=sender,
            address="",
            method=TOPIC,
            path=f"/{topic}",
            body=json.dumps(_fields(message))[:MOST_TEXT],
            status=UNANSWERED,
        )


def _fields(message: Any) -> dict[str, Any]:
    """Returns the fields of a message; those of a message within it as text."""
    values = {name: getattr(message, name) for name in message.__slots__}
    return {
        name: value if isinstance(value, int | float | str) else str(value)
        for name, value in values.items()
    }
