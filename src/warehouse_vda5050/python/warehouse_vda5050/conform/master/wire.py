# SPDX-License-Identifier: Apache-2.0
"""What carries messages between a master and the vehicles of a stage."""

import abc
from collections.abc import Callable

from warehouse_vda5050.conform.wire import Arrived
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink


class StageWire(abc.ABC):
    """A connection of each vehicle, one more that hears all of their topics, and a clock."""

    take: Callable[[Arrived], None]  # called by poll() with what the latter hears

    @abc.abstractmethod
    def now(self) -> float:
        """Returns the time [s]; never set back."""

    @abc.abstractmethod
    def poll(self, seconds: float) -> None:
        """Passes `seconds`, or less if something arrived."""

    @abc.abstractmethod
    def join(self, link: VehicleLink) -> None:
        """Lets a vehicle connect, and serves its connection until it is closed."""

    @abc.abstractmethod
    def hear(self, topic: str) -> None:
        """Listens to a topic by quality of service 1, so that messages come by that of their
        sender."""

    @abc.abstractmethod
    def close(self) -> None:
        """Disconnects."""
