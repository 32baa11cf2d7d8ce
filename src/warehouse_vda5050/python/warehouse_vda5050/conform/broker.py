# SPDX-License-Identifier: Apache-2.0
"""The connection of a program to an MQTT broker."""

import time
from typing import Any

from warehouse_vda5050.conform.proxy import Proxy
from warehouse_vda5050.conform.wire import Arrived, Wire
from warehouse_vda5050.mqtt.client import begin_connecting, make_client
from warehouse_vda5050.mqtt.settings import BrokerSettings

PATIENCE = 10.0  # timeout of connecting [s]
STEP = 0.05  # longest wait for a message before the clock is looked at [s]


class UnreachableError(RuntimeError):
    """No connection to a broker; the message says why."""


class Broker(Wire):
    """One client of a broker, named `name`. proxy: what the vehicle is connected by, if it can be
    cut. Raises UnreachableError."""

    def __init__(
        self, settings: BrokerSettings, proxy: Proxy | None = None, name: str = "conform"
    ) -> None:
        self._settings, self._proxy = settings, proxy
        self.cuts = proxy is not None
        self.take = lambda _message: None
        self._topics: list[str] = []
        self._fault = "the broker does not answer"
        self._client = make_client(f"{name}-{time.time_ns()}", settings)
        self._client.on_connect = self._connected
        self._client.on_message = self._arrived
        try:
            begin_connecting(self._client, settings)
        except OSError as error:
            raise UnreachableError(f"{settings.host}:{settings.port}: {error}") from None
        self._await()

    def _await(self) -> None:
        end = self.now() + PATIENCE
        while self._fault and self.now() < end:
            self._client.loop(STEP)
        if self._fault:
            raise UnreachableError(f"{self._settings.host}:{self._settings.port}: {self._fault}")

    def _connected(self, _client: Any, _data: Any, _flags: Any, code: Any, *_: Any) -> None:
        failed = getattr(code, "is_failure", code != 0)
        self._fault = f"refused: {code}" if failed else ""
        for topic in self._topics:
            self._client.subscribe(topic, 1)

    def _arrived(self, _client: Any, _data: Any, m: Any) -> None:
        self.take(Arrived(m.topic, m.payload, m.qos, bool(m.retain)))

    def now(self) -> float:
        """Returns the time [s]."""
        return time.monotonic()

    def poll(self, seconds: float) -> None:
        """Reads what arrives within `seconds`."""
        if self._client.loop(min(seconds, STEP)):
            time.sleep(STEP)
            self._reconnect()

    def _reconnect(self) -> None:
        try:
            self._client.reconnect()
        except OSError:
            return  # it is tried again by the next poll

    def publish(self, topic: str, payload: bytes) -> None:
        """Sends a message."""
        self._client.publish(topic, payload, 0)

    def subscribe(self, topic: str) -> None:
        """Subscribes by quality of service 1, so that messages come by that of their sender."""
        if topic not in self._topics:
            self._topics.append(topic)
        self._client.subscribe(topic, 1)

    def cut(self) -> None:
        """Ends the vehicle's connection."""
        assert self._proxy
        self._proxy.cut()

    def restore(self) -> None:
        """Lets the vehicle connect again."""
        assert self._proxy
        self._proxy.restore()

    def close(self) -> None:
        """Disconnects."""
        self._client.disconnect()
        if self._proxy:
            self._proxy.close()
