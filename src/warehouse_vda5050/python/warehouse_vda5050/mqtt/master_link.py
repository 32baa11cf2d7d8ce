# SPDX-License-Identifier: Apache-2.0
"""A master at a broker: one connection, by which it hears its vehicles and commands them."""

from collections.abc import Callable, Iterable
from dataclasses import replace

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.model import (
    Connection,
    Factsheet,
    InstantActions,
    InvalidFactsheet,
    Responses,
    ToVehicle,
    VehicleOrder,
    VehicleState,
    ZoneSet,
)
from warehouse_vda5050.mqtt.loop import Link, Outgoing
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.schemas.factsheet_faults import factsheet_faults
from warehouse_vda5050.topics import Identity, Kind, TopicError, Topics
from warehouse_vda5050.validation import MessageError

HEARD = (Kind.CONNECTION, Kind.STATE, Kind.FACTSHEET)
KEPT = (Kind.CONNECTION, Kind.FACTSHEET)  # by brokers, for masters that come later
KINDS: dict[type, Kind] = {
    VehicleOrder: Kind.ORDER,
    InstantActions: Kind.INSTANT_ACTIONS,
    ZoneSet: Kind.ZONE_SET,
    Responses: Kind.RESPONSES,
}
FromVehicle = VehicleState | Connection | Factsheet | InvalidFactsheet


def _filters(topics: Topics, who: Iterable[Identity] | None, kind: Kind) -> list[str]:
    return [topics.everyone(kind)] if who is None else [topics.of(vehicle, kind) for vehicle in who]


class MasterLink:
    """Carries messages between a master and the vehicles `who`; None: all that are at the broker.

    `link` is to be added to an MqttLoop, whose poll() calls take(identity, message); `write` takes
    lines for a person: what a vehicle sent that can't be read.
    """

    def __init__(
        self,
        name: str,
        who: Iterable[Identity] | None,
        codec: Codec,
        topics: Topics,
        broker: BrokerSettings,
        take: Callable[[Identity, FromVehicle], None],
        write: Callable[[str], None] = lambda _line: None,
    ) -> None:
        self._codec, self._topics, self._take, self._write = codec, topics, take, write
        self._headers: dict[Identity, Headers] = {}
        who = None if who is None else [*who]
        subscriptions = [
            (topic, kind.qos) for kind in HEARD for topic in _filters(topics, who, kind)
        ]
        self.link = Link(name, broker, subscriptions, self._on_message)

    def send(self, identity: Identity, message: ToVehicle) -> None:
        """Sends a message to a vehicle, if there is a connection."""
        kind = KINDS[type(message)]
        headers = self._headers.get(identity)
        if headers is None:
            headers = self._headers[identity] = Headers(identity, self._codec.version)
        message = replace(message, header=headers.next(kind))
        topic = self._topics.of(identity, kind)
        self.link.publish(Outgoing(topic, self._codec.encode(message), kind.qos, kind.retained))

    def _on_message(self, topic: str, payload: bytes, retained: bool) -> None:
        try:
            identity, kind = self._topics.parse(topic)
            if retained and kind not in KEPT:
                return  # left by an earlier run: the vehicle may be elsewhere
            message = self._decoded(kind, payload)
        except (MessageError, TopicError) as error:
            self._write(f"{topic}: {error}")
            return
        self._take(identity, message)

    def _decoded(self, kind: Kind, payload: bytes) -> FromVehicle:
        """Returns the message; of a factsheet also what is invalid in it. Raises MessageError."""
        if kind is not Kind.FACTSHEET or not payload:  # empty: the broker keeps it no more
            return self._codec.decode(kind, payload).message
        try:
            sheet: Factsheet = self._codec.decode(kind, payload).message
        except MessageError as error:
            return InvalidFactsheet(str(error))
        return replace(sheet, faults=factsheet_faults(payload, self._codec.version))
