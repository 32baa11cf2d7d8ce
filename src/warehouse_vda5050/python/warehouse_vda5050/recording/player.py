# SPDX-License-Identifier: Apache-2.0
"""Sends recorded messages again, in their order and at their times."""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from warehouse_vda5050.mqtt.loop import Link, MqttLoop, Outgoing
from warehouse_vda5050.recording.entry import Entry
from warehouse_vda5050.topics import Kind

PATIENCE = 5.0  # for the broker's last answer [s]
STEP = 0.05  # longest wait before the clock is looked at [s]
RETAINED = tuple(f"/{kind.value}" for kind in Kind if kind.retained)


@dataclass
class Extent:
    """Count and times [s] of the messages of a recording."""

    count: int = 0
    begin: float = 0.0
    end: float = 0.0

    @classmethod
    def of(cls, entries: Iterable[Entry]) -> "Extent":
        """Returns the extent of some messages."""
        extent = cls()
        for entry in entries:
            extent.begin = entry.time if not extent.count else extent.begin
            extent.end = max(extent.end, entry.time)
            extent.count += 1
        return extent

    @property
    def seconds(self) -> float:
        """The time between the first message and the last."""
        return max(0.0, self.end - self.begin)


class Player:
    """Publishes by one connection, which poll() of `loop` serves. speed: times real time.

    A message never overtakes another: one whose time is before that of the last, as after a clock
    was set back, comes right after it. While there is no connection the recording stands still.
    `stopped` ends play().
    """

    def __init__(self, loop: MqttLoop, link: Link, speed: float) -> None:
        self._loop, self._link, self._speed = loop, link, speed
        self.stopped = False
        self.sent = 0
        self.time = 0.0  # of the message that was sent last

    def play(self, entries: Iterable[Entry], progress: Callable[[], None]) -> None:
        """Sends all; progress() is called after each wait."""
        start = first = None
        for entry in entries:
            if start is None or first is None:
                start, first = time.monotonic(), entry.time
            self._wait_until(start + max(0.0, entry.time - first) / self._speed, progress)
            start += self._send(entry, progress)
            if self.stopped:
                return
            self.sent, self.time = self.sent + 1, entry.time
        end = time.monotonic() + PATIENCE
        self._wait(lambda: self._link.is_answered or time.monotonic() > end, progress)

    def _send(self, entry: Entry, progress: Callable[[], None]) -> float:
        """Sends a message once there is a connection; returns how long there was none [s]."""
        begin = time.monotonic()
        self._wait(lambda: self._link.connected, progress)
        waited = time.monotonic() - begin
        if not self.stopped:
            retain = entry.topic.endswith(RETAINED)
            self._link.publish(Outgoing(entry.topic, entry.payload, entry.qos, retain))
            self._wait(self._is_idle, progress)
        return waited if waited > STEP else 0.0

    def _is_idle(self) -> bool:
        """Returns whether all bytes are sent."""
        return not (self._link.connected and self._link.wants_to_write)

    def _wait_until(self, due: float, progress: Callable[[], None]) -> None:
        while not self.stopped and (left := due - time.monotonic()) > 0:
            self._loop.poll(min(left, STEP))
            progress()

    def _wait(self, condition: Callable[[], bool], progress: Callable[[], None]) -> None:
        while not (self.stopped or condition()):
            self._loop.poll(0.001)
            progress()
