# SPDX-License-Identifier: Apache-2.0
"""The stage's connections to an MQTT broker."""

from collections.abc import Callable

from warehouse_vda5050.conform.broker import Broker
from warehouse_vda5050.conform.master.wire import StageWire
from warehouse_vda5050.conform.wire import Arrived
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink


class BrokerWire(StageWire):
    """A listener, and a connection of each vehicle in one loop. Raises UnreachableError."""

    def __init__(self, settings: BrokerSettings) -> None:
        self.take: Callable[[Arrived], None] = lambda _message: None
        self._listener = Broker(settings)
        self._listener.take = self._pass_on
        self._loop = MqttLoop()

    def _pass_on(self, message: Arrived) -> None:
        self.take(message)

    def now(self) -> float:
        """Returns the time [s]."""
        return self._listener.now()

    def poll(self, seconds: float) -> None:
        """Serves all connections for a while."""
        self._listener.poll(seconds / 2)
        self._loop.poll(seconds / 2)

    def join(self, link: VehicleLink) -> None:
        """Lets a vehicle connect."""
        self._loop.add(link.link)

    def hear(self, topic: str) -> None:
        """Listens to a topic."""
        self._listener.subscribe(topic)

    def close(self) -> None:
        """Disconnects; the vehicles have to be closed before."""
        self._listener.close()
        self._loop.close()
