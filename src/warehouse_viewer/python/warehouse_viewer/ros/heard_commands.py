# SPDX-License-Identifier: Apache-2.0
"""Notes of commands that came over ROS topics and services: of people with rostopic and rosservice,
and of programs of others."""

import json
import math
import time
from collections.abc import Callable
from types import ModuleType

from warehouse_client.heard_commands import Heard
from warehouse_viewer.api.command_log import MOST_TEXT, CommandLog

# Nodes that command by themselves, or for a call that is noted already.
SPARED = ("coordinator", "operations", "create_warehouse_service_node")
# What programs call in a loop: a thousand times a second, and each would push out another command.
LOOPED = ("step", "set_model_state", "set_link_state", "apply_body_wrench", "apply_joint_effort")
AGAIN = 1.0  # from one note of such a service to the next by the same node [s, wall]
TOPIC, SERVICE = "TOPIC", "SERVICE"  # instead of an HTTP method
UNNAMED = "a ROS service"  # instead of a caller that did not say its name
UNANSWERED = 0  # status: a topic has no answer, and a service's is its caller's; events have it


class CommandNotes:
    """Notes each command with the node that sent it.

    Those of this node are requests over HTTP, which are noted as such; those of the coordinator, of
    the shift and of the node that builds are no person's. Of services that are called in a loop one
    call a second is.
    """

    def __init__(
        self, ros: ModuleType, log: CommandLog, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._log, self._clock = log, clock
        self._spared = ros.get_name(), *map(ros.resolve_name, SPARED)
        self._looped = {ros.resolve_name(f"gazebo/{name}") for name in LOOPED}
        self._noted: dict[tuple[str, str], float] = {}  # when, by node and service

    def note(self, heard: Heard) -> None:
        """Notes a command over a topic, unless it is one of the spared nodes'."""
        self._add(TOPIC, heard)

    def note_call(self, heard: Heard) -> None:
        """Notes a call of a service, unless it is one of the spared nodes'."""
        if not self._repeats(heard):
            self._add(SERVICE, heard)

    def _repeats(self, heard: Heard) -> bool:
        if heard.topic not in self._looped:
            return False
        key, now = (heard.sender, heard.topic), self._clock()
        if now - self._noted.get(key, -math.inf) < AGAIN:
            return True
        self._noted[key] = now
        return False

    def _add(self, method: str, heard: Heard) -> None:
        if heard.sender in self._spared:
            return
        self._log.add(
            by=heard.sender or UNNAMED,
            address="",
            method=method,
            path=heard.topic,
            body=json.dumps(heard.fields, default=str)[:MOST_TEXT],
            status=UNANSWERED,
        )
