# SPDX-License-Identifier: Apache-2.0
"""Sends commands to robots and returns what becomes of each.

An answer carries the number by which the command is known from then on. The answer itself names the
robot alone, so commands to one robot are sent one after the other; a command
that another client sends to the same robot at the same moment can be taken for ours.
"""

import asyncio
import time
from collections.abc import Collection
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

from warehouse_client.commands import COMMANDS
from warehouse_layout.message_enums import EventKind

ANSWERS = EventKind.ACCEPTED.name, EventKind.REFUSED.name
ENDS = EventKind.DONE.name, EventKind.BLOCKED.name


@dataclass
class Outcome:
    """`kind` of the last event that matters, in small letters; or pending, if none came in time."""

    kind: str = "pending"
    events: list = field(default_factory=list)  # entries of the Journal


class Commander:
    """Lives in an asyncio loop. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._ros = ros
        self._publishers = {t: ros.Publisher(t, k, queue_size=100) for t, k in COMMANDS.items()}
        self._locks: dict[int, asyncio.Lock] = {}
        self._listeners: set[tuple[str, asyncio.Queue]] = set()

    async def ready(self, topic: str, patience: float = 3.0) -> bool:
        """Waits at most `patience` [s, wall] for the world to subscribe; returns whether it has."""
        deadline = time.monotonic() + patience
        while not self._listeners_elsewhere(topic):
            if time.monotonic() > deadline:
                return False
            await asyncio.sleep(0.05)
        return True

    def _listeners_elsewhere(self, topic: str) -> int:
        """Returns how many other nodes have subscribed: this one may listen to commands itself."""
        publisher = self._publishers[topic]
        connections = getattr(getattr(publisher, "impl", None), "connections", None)
        if connections is None:  # what stands in for rospy's
            return publisher.get_num_connections()
        return sum(each.endpoint_id != self._ros.get_name() for each in list(connections))

    def note(self, entry: dict[str, Any]) -> None:
        """Passes a journal entry to the commands that wait for it. Call it in the loop."""
        for model, events in list(self._listeners):
            if entry["model"] == model:
                events.put_nowait(entry)

    async def send(
        self, topic: str, kiva_id: int, fields: dict[str, Any], until_end: bool, timeout: float
    ) -> Outcome:
        """Publishes a command and waits at most `timeout` [s, wall] for its answer or end."""
        lock = self._locks.setdefault(kiva_id, asyncio.Lock())
        outcome = Outcome()
        events: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        listener = (f"kiva{kiva_id}", events)
        self._listeners.add(listener)
        try:
            async with asyncio.timeout(timeout):
                async with lock:
                    _drain(events)
                    self._publishers[topic].publish(COMMANDS[topic](kiva_id=kiva_id, **fields))
                    await _follow(events, outcome, ANSWERS)
                if until_end and outcome.kind == "accepted":
                    await _follow(events, outcome, ENDS, outcome.events[-1]["command"])
        except TimeoutError:
            pass
        finally:
            self._listeners.discard(listener)
        return outcome


async def _follow(
    events: asyncio.Queue[dict[str, Any]],
    outcome: Outcome,
    kinds: Collection[str],
    command: int | None = None,
) -> None:
    """Reads events, only those of one command if it is known, until one of these kinds."""
    while True:
        entry = await events.get()
        if command is not None and entry["command"] != command:
            continue
        outcome.events.append(entry)
        if entry["kind"] in kinds:
            outcome.kind = entry["kind"].lower()
            return


def _drain(events: asyncio.Queue[dict[str, Any]]) -> None:
    while not events.empty():
        events.get_nowait()
