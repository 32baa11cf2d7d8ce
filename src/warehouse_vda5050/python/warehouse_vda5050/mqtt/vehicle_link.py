# SPDX-License-Identifier: Apache-2.0
"""A vehicle at a broker: its own connection with its will, its messages in and out."""

import math
from collections import Counter
from dataclasses import replace
from typing import Any

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.errors import ErrorType
from warehouse_vda5050.faults.vehicle_faults import VehicleFaults
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.model import Connection, ConnectionState, Message
from warehouse_vda5050.mqtt.loop import Link, Outgoing
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import Identity, Kind, Topics, heard_by_vehicle
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.vehicle import Vehicle

REST = 1.0  # at most between two ticks of a vehicle that rests [s]


class VehicleLink:
    """Carries messages between one Vehicle and its broker.

    `link` is to be added to an MqttLoop; tick() is called between its poll()s. `faults` are those
    whose driver the vehicle has.
    """

    def __init__(
        self,
        vehicle: Vehicle,
        identity: Identity,
        codec: Codec,
        topics: Topics,
        broker: BrokerSettings,
        faults: VehicleFaults | None = None,
    ) -> None:
        self.vehicle, self.identity = vehicle, identity
        self.faults = faults or VehicleFaults(vehicle.driver, lambda _text, _begins: None)
        self._codec, self._topics = codec, topics
        self._headers = Headers(identity, codec.version)
        self._online = self._connection(ConnectionState.ONLINE)
        self._now = -math.inf
        self.sent_counts: Counter[Kind] = Counter()  # without connections
        self._called = False  # something came since the last tick
        name = f"{identity.manufacturer}.{identity.serial}.vehicle"
        heard = heard_by_vehicle(codec.version)
        subscriptions = [(topics.of(identity, kind), kind.qos) for kind in heard]
        self.link = Link(
            name, broker, subscriptions, self._on_message, self._on_connect, self._make_will
        )

    def rests(self, now: float) -> bool:
        """Whether a tick would change nothing, as long as the robot reports the same."""
        is_due = now >= min(self._now + REST, self.vehicle.next_state)
        return not (self._called or self.vehicle.is_taken or is_due or self.faults.is_busy)

    def tick(self, now: float) -> None:
        """Updates the vehicle, and sends its messages. now: any clock [s]."""
        self._now, self._called = now, False
        self.faults.tick(now)
        self.vehicle.update(now)
        report = self.vehicle.report
        if report is not None and not report.answers:
            if self.link.is_wanted:
                self._cut(report.silent)
        elif not self.link.closed:
            self.link.restore()
        if self.link.connected:
            self._send_news(now)

    def _cut(self, silent: str) -> None:
        """Ends the connection as a lost radio does; of a robot that is silent, a state says so."""
        if silent and self.link.connected:
            self._send(Kind.STATE, self.vehicle.state())
        self.link.cut()

    def _send_news(self, now: float) -> None:
        state = self.vehicle.take_state(now)
        if state:
            self._send(Kind.STATE, state)
        visualization = self.vehicle.take_visualization(now)
        if visualization:
            shown = replace(visualization, state_id=self._headers.last(Kind.STATE))
            self._send(Kind.VISUALIZATION, shown)
        factsheet = self.vehicle.take_factsheet()
        if factsheet:
            self._send(Kind.FACTSHEET, factsheet)
        for message in self.faults.wire.late(now):
            self.link.publish(message)

    def close(self) -> None:
        """Says OFFLINE and disconnects."""
        self.link.close(self._connection(ConnectionState.OFFLINE))

    def _send(self, kind: Kind, message: Any) -> None:
        for outgoing in self.faults.wire.outgoing(kind, self._outgoing(kind, message), self._now):
            self.sent_counts[kind] += self.link.publish(outgoing)

    def _outgoing(self, kind: Kind, message: Message) -> Outgoing:
        header = self.faults.wire.stamped(self._headers.next(kind))
        message = replace(message, header=header)
        payload = self._codec.encode(message)
        return Outgoing(self._topics.of(self.identity, kind), payload, kind.qos, kind.retained)

    def _connection(self, state: ConnectionState) -> Outgoing:
        return self._outgoing(Kind.CONNECTION, Connection(state))

    def _make_will(self) -> Outgoing:
        # Masters drop what is older than what they had: ONLINE must not be newer than the will.
        self._online = self._connection(ConnectionState.ONLINE)
        return self._connection(ConnectionState.CONNECTIONBROKEN)

    def _on_connect(self) -> None:
        self._called = True
        self.link.publish(self._online)
        self.vehicle.request_state()
        self.vehicle.request_factsheet()

    def _on_message(self, topic: str, payload: bytes, retained: bool) -> None:
        if not payload:
            return  # what the broker kept for a topic is removed this way
        if not self.faults.wire.hears:
            return
        self._called = True
        try:
            _, kind = self._topics.parse(topic)
            if retained:
                # Left by an earlier run: what it asks for may be over since long.
                raise MessageError(f"a retained message on {kind.value} is not acted upon")
            message, unknown = self._codec.decode(kind, payload)
            self._check_address(message)
        except MessageError as error:
            refer = (("topic", topic.rpartition("/")[2]), *error.error.references)
            self.vehicle.note(replace(error.error, references=refer))
            return
        self._deliver(kind, message, unknown)

    def _deliver(self, kind: Kind, message: Any, unknown: tuple[str, ...]) -> None:
        if kind is Kind.ORDER:
            self.vehicle.on_order(message, self._now, unknown)
        elif kind is Kind.ZONE_SET:
            self.vehicle.on_zone_set(message, unknown)
        elif kind is Kind.RESPONSES:
            self.vehicle.on_responses(message, unknown)
        else:
            self.vehicle.on_instant_actions(message, self._now, unknown)

    def _check_address(self, message: Any) -> None:
        addressee = (message.header.manufacturer, message.header.serial)
        ours = (self.identity.manufacturer, self.identity.serial)
        if any(theirs and theirs != our for theirs, our in zip(addressee, ours)):
            text = f"the message is for {'/'.join(addressee)}, and came to {'/'.join(ours)}"
            raise MessageError(text, ErrorType.VALIDATION.value)
