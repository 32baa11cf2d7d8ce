# SPDX-License-Identifier: Apache-2.0
"""Commands that came over ROS topics: of people with rostopic, and of programs of others."""

import json
from collections.abc import Callable
from types import ModuleType
from typing import Any, NamedTuple

import yaml

from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import Command
from warehouse_viewer.api.command_log import MOST_TEXT, CommandLog

COORDINATOR = "coordinator"
TOPIC = "TOPIC"  # instead of an HTTP method
UNANSWERED = 0  # status: a topic has no answer; the events have it


class Heard(NamedTuple):
    """A command as its sender gave it; `fields` are those of its message."""

    topic: str
    sender: str
    fields: dict[str, Any]


def hear(ros: ModuleType, *takers: Callable[[Heard], None]) -> None:
    """Passes each command to the takers.

    They come from the world, which alone listens for commands: a client that waits for a connection
    before it commands has that to the world.
    """

    def take(command: Command) -> None:
        heard = Heard(command.topic, command.sender, yaml.safe_load(command.fields))
        for taker in takers:
            taker(heard)

    subscribe(ros, "warehouse/commands", Command, take, queue_size=1000)


class CommandNotes:
    """Notes each command with the node that sent it.

    Those of this node are requests over HTTP, which are noted as such; the coordinator's are no
    person's.
    """

    def __init__(self, ros: ModuleType, log: CommandLog) -> None:
        self._log = log
        self._spared = ros.get_name(), ros.resolve_name(COORDINATOR)

    def note(self, heard: Heard) -> None:
        """Notes a command, unless it is one of the spared nodes'."""
        if heard.sender in self._spared:
            return
        self._log.add(
            by=heard.sender,
            address="",
            method=TOPIC,
            path=heard.topic,
            body=json.dumps(heard.fields)[:MOST_TEXT],
            status=UNANSWERED,
        )
