# SPDX-License-Identifier: Apache-2.0
"""What carries messages to a vehicle and back."""

import abc
from collections.abc import Callable
from typing import NamedTuple


class Arrived(NamedTuple):
    """A message as the broker delivered it."""

    topic: str
    payload: bytes
    qos: int
    retained: bool


class Wire(abc.ABC):
    """A connection to a broker, and its clock."""

    take: Callable[[Arrived], None]  # called by poll()
    cuts = False  # whether cut() and restore() end and renew the vehicle's connection

    @abc.abstractmethod
    def now(self) -> float:
        """Returns the time [s]; never set back."""

    @abc.abstractmethod
    def poll(self, seconds: float) -> None:
        """Passes `seconds`, or less if something arrived."""

    @abc.abstractmethod
    def publish(self, topic: str, payload: bytes) -> None:
        """Sends a message, by quality of service 0."""

    @abc.abstractmethod
    def subscribe(self, topic: str) -> None:
        """Subscribes, once more as well: the broker sends what it has retained."""

    def cut(self) -> None:
        """Ends the vehicle's connection as a lost radio does."""
        raise NotImplementedError

    def restore(self) -> None:
        """Lets the vehicle connect again."""
        raise NotImplementedError

    @abc.abstractmethod
    def close(self) -> None:
        """Disconnects."""
