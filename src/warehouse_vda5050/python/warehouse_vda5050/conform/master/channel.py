# SPDX-License-Identifier: Apache-2.0
"""How the states of a vehicle travel: quality of service 0 promises little."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum, auto

from warehouse_vda5050.mqtt.loop import Outgoing

LATE, STALE = 1.0, 3.0  # how much later a state comes, and a copy of it [s]
LOST = 3  # of this many states, all but one are lost


class Travel(Enum):
    """What becomes of each state."""

    PLAIN = auto()
    DOUBLED = auto()
    LATE = auto()
    SWAPPED = auto()  # each second one overtakes the one before it
    STALE = auto()  # a copy of each comes once more, long after
    LOSSY = auto()
    SILENT = auto()  # none arrives


class Channel:
    """The states of one vehicle on their way. Times are [s] of any clock."""

    def __init__(self) -> None:
        self.travel = Travel.PLAIN
        self._held: list[tuple[float, Outgoing]] = []  # when due
        self._count = 0

    def put(self, message: Outgoing, now: float) -> list[Outgoing]:
        """Takes a state; returns what arrives now."""
        self._count += 1
        travel = self.travel
        if travel is Travel.SILENT or (travel is Travel.LOSSY and self._count % LOST):
            return []
        if travel is Travel.LATE:
            self._held.append((now + LATE, message))
            return []
        if travel is Travel.SWAPPED:
            return self._swap(message, now)
        if travel is Travel.STALE:
            self._held.append((now + STALE, message))
        return [message] * (2 if travel is Travel.DOUBLED else 1)

    def _swap(self, message: Outgoing, now: float) -> list[Outgoing]:
        if not self._held:
            self._held.append((now + LATE, message))
            return []
        return [message, *self._release(lambda _due: True)]

    def due(self, now: float) -> Iterable[Outgoing]:
        """Returns what arrives late."""
        return self._release(lambda due: due <= now)

    def _release(self, condition: Callable[[float], bool]) -> list[Outgoing]:
        released = [message for due, message in self._held if condition(due)]
        self._held = [(due, message) for due, message in self._held if not condition(due)]
        return released
