# SPDX-License-Identifier: Apache-2.0
"""Lets robots act: each follows a script of commands and waits for what becomes of each.

A script is a generator. It yields Commands; each `yield` returns the Event that ended the command:
DONE, BLOCKED or REFUSED. All scripts of a scene run at once, driven by the robots' events alone.
"""

import queue
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any

from warehouse_client.commands import COMMANDS
from warehouse_client.message_check import subscribe
from warehouse_client.message_names import EVENT
from warehouse_msgs.msg import Event, KivaStatus

ENDS = (Event.DONE, Event.BLOCKED, Event.REFUSED)
SILENT = (Event.ACCEPTED, Event.SPAWNED, Event.DELETED)


class DeadlineError(TimeoutError):
    """The scene did not end in time; the message says which robots still wait, and for what."""


class Interrupted(Exception):  # noqa: N818 (nothing went wrong)
    """ROS shuts down."""


@dataclass(frozen=True)
class Command:
    """A message for a robot, and the topic it goes to."""

    topic: str
    message: Any

    def __str__(self) -> str:
        fields = (f"{n} {getattr(self.message, n):g}" for n in self.message.__slots__)
        return f"{self.topic} {', '.join(f for f in fields if not f.startswith('kiva_id'))}"


def command(topic: str, kiva: int, **fields: float | str) -> Command:
    """Returns a Command for the robot number `kiva`; fields as in interface messages."""
    return Command(topic, COMMANDS[topic](kiva_id=kiva, **fields))


class ScriptExecutor:
    """`ros` is rospy. `say(seconds, who, text)` tells what happens; seconds are simulated."""

    def __init__(
        self, ros: ModuleType, say: Callable[[float, str, str], object], deadline: float
    ) -> None:
        """`deadline` [s, wall] bounds each scene."""
        self._ros, self._say, self._deadline = ros, say, deadline
        self._inbox: queue.Queue[Any] = queue.Queue()
        self._publishers: dict[str, Any] = {}
        self._status: dict[int, KivaStatus] = {}
        self._scripts: dict[int, Any] = {}
        self._pending: dict[int, Any] = {}
        self._ended: dict[int, Any] = {}
        self._now = 0.0  # [s, simulated]
        self.events: list[Event] = []
        self._answers = subscribe(ros, "warehouse/events", Event, self._inbox.put, queue_size=1000)
        for topic, kind in COMMANDS.items():
            self._publishers[topic] = ros.Publisher(topic, kind, queue_size=10)

    def watch(self, kiva: int) -> None:
        """Follows the status of a robot, so that it can take part."""
        subscribe(self._ros, f"kiva{kiva}/status", KivaStatus, self._inbox.put, queue_size=100)

    def status(self, kiva: int) -> KivaStatus | None:
        """Returns the robot's newest KivaStatus; None if none has come yet."""
        return self._status.get(kiva)

    def play(self, scripts: Mapping[int, Any]) -> None:
        """Runs scripts, {kiva: generator}, until all have ended. Raises DeadlineError."""
        end = time.monotonic() + self._deadline
        self._scripts = dict(scripts)
        self._pump(end, lambda: self._heard() and all(map(self._idle, scripts)))
        for kiva in scripts:
            self._advance(kiva, None)
        self._pump(end, lambda: not self._scripts)

    def _heard(self) -> bool:
        """Returns whether the commands have a subscriber, and what becomes of them a publisher."""
        return all(p.get_num_connections() for p in (self._answers, *self._publishers.values()))

    def until(self, condition: Callable[[], object], patience: float = 10.0) -> object:
        """Waits for condition() at most `patience` [s, wall]; returns its last value."""
        try:
            self._pump(time.monotonic() + patience, condition)
        except DeadlineError:
            return condition()
        return True

    def _pump(self, end: float, done: Callable[[], Any]) -> None:
        while not done():
            if self._ros.is_shutdown():
                raise Interrupted
            if time.monotonic() > end:
                waiting = ", ".join(f"kiva{k} for {c}" for k, c in self._pending.items())
                raise DeadlineError(f"out of time; waiting: {waiting or 'no robot'}")
            try:
                self._take(self._inbox.get(timeout=0.1))
            except queue.Empty:
                continue

    def _take(self, message: KivaStatus | Event) -> None:
        self._now = max(self._now, message.header.stamp.to_sec())
        if isinstance(message, KivaStatus):
            self._status[message.kiva_id] = message
            self._go_on(message.kiva_id)
            return
        self.events.append(message)
        if message.kind not in SILENT:
            parts = (EVENT[message.kind], message.other, message.text)
            self._say(message.header.stamp.to_sec(), message.model, " ".join(filter(None, parts)))
        kiva = next((k for k in self._pending if message.model == f"kiva{k}"), None)
        if kiva and message.kind in ENDS:
            self._ended[kiva] = message
            self._go_on(kiva)

    def _go_on(self, kiva: int) -> None:
        """A command has ended once its event came and the robot may take the next."""
        event = self._ended.get(kiva)
        if event and self._idle(kiva, since=event):
            del self._ended[kiva], self._pending[kiva]
            self._advance(kiva, event)

    def _idle(self, kiva: int, since: Event | None = None) -> bool:
        status = self._status.get(kiva)
        if not status or status.status != KivaStatus.STATUS_IDLE:
            return False
        # A refusal does not change the status.
        if since is None or since.kind == Event.REFUSED:
            return True
        return status.header.stamp >= since.header.stamp

    def _advance(self, kiva: int, event: Event | None) -> None:
        try:
            wish = self._scripts[kiva].send(event)
        except StopIteration:
            del self._scripts[kiva]
            return
        self._pending[kiva] = wish
        self._say(self._now, f"kiva{kiva}", str(wish))
        self._publishers[wish.topic].publish(wish.message)
