# SPDX-License-Identifier: Apache-2.0
"""Events by simulated time, for a shift and for the ideal fleet."""

import heapq
import itertools
import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple


class Event(NamedTuple):
    """A call that is due at a time [s]; events of the same time keep their order."""

    time: float
    number: int
    act: Callable[[Any], object]
    argument: Any


class EventQueue:
    """Calls that are due at a simulated time, the earliest first."""

    def __init__(self) -> None:
        self._events: list[Event] = []
        self._numbers = itertools.count()

    def schedule(self, time: float, act: Callable[[Any], object], argument: Any = None) -> None:
        """Calls act(argument) at a time [s]."""
        heapq.heappush(self._events, Event(time, next(self._numbers), act, argument))

    def __iter__(self) -> Iterator[Event]:
        """Returns an iterator over the events, in no order."""
        return iter(self._events)

    @property
    def next_time(self) -> float:
        """The time of the earliest event [s]; infinity without events."""
        return self._events[0].time if self._events else math.inf

    def run_next(self) -> None:
        """Removes the earliest event and carries it out."""
        event = heapq.heappop(self._events)
        event.act(event.argument)

    def run_until(self, time: float) -> None:
        """Carries out all events up to a time [s], and those that they schedule."""
        while self.next_time <= time:
            self.run_next()


class Clock(EventQueue):
    """The simulated time of a shift, and the calls that are due.

    began: begin of the shift [s]. now: time up to which it has handled all events [s].
    """

    def __init__(self, began: float = 0.0) -> None:
        super().__init__()
        self.began = self.now = began
