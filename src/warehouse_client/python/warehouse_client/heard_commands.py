# SPDX-License-Identifier: Apache-2.0
"""Commands that came over ROS topics and services, as the world tells of them."""

from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any, NamedTuple

import yaml

from warehouse_client.command_services import CALLS
from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import Command

# libyaml's loader takes a quarter of the time of the one in Python, and a busy fleet gets hundreds
# of commands a second.
LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class Heard(NamedTuple):
    """A command as its sender gave it; `fields` are those of its message or request, `topic` is the
    name of the topic or service."""

    topic: str
    sender: str
    fields: dict[str, Any]


def hear(ros: ModuleType, *takers: Callable[[Heard], None]) -> None:
    """Passes each command to the takers.

    They come from the world, which alone listens for commands: a client that waits for a connection
    before it commands has that to the world.
    """

    _subscribe(ros, "warehouse/commands", takers)


def hear_calls(ros: ModuleType, *takers: Callable[[Heard], None]) -> None:
    """Passes each call of a service that changes something to the takers."""
    _subscribe(ros, CALLS, takers)


def _subscribe(ros: ModuleType, topic: str, takers: Sequence[Callable[[Heard], None]]) -> None:
    def take(command: Command) -> None:
        fields = _fields_of(command)
        if fields is None:  # another program publishes here, too
            return
        for taker in takers:
            taker(Heard(command.topic, command.sender, fields))

    subscribe(ros, topic, Command, take, queue_size=1000)


def _fields_of(command: Command) -> dict[str, Any] | None:
    """Returns the fields of a command by name; None if its text has none."""
    try:
        fields = yaml.load(command.fields, LOADER) or {}
    except yaml.YAMLError:
        return None
    return fields if isinstance(fields, dict) else None
