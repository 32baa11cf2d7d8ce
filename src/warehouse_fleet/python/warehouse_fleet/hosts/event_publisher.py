# SPDX-License-Identifier: Apache-2.0
"""Publishes the events of transports, and keeps the ledger of those that are open."""

import time as clock
from collections.abc import Container

import rosgraph
import rospy

from warehouse_fleet.hosts.coordinator_messages import event_message
from warehouse_fleet.hosts.ledger import Entry, Ledger
from warehouse_fleet.transports.transport_book import ENDS, Kind, TransportEvent
from warehouse_msgs.msg import TransportEvent as TransportEventMessage

CONNECTING = 5.0  # wall time in which subscribers connect to a node that has begun [s]


class EventPublisher:
    """The publisher of /warehouse/transports. `ledger` outlives this node."""

    def __init__(self) -> None:
        self.ledger = Ledger()
        self._abandoned: list[Entry] = []
        self._connected_by = clock.monotonic() + CONNECTING
        self._topic = rospy.Publisher(
            "warehouse/transports", TransportEventMessage, queue_size=1000
        )

    def begin(self) -> None:
        """Notes the transports that are open in the ledger now: a controller that begins knows
        none of them."""
        self._abandoned = list(self.ledger)

    def publish(self, event: TransportEvent, under_way: Container[int]) -> None:
        """Publishes an event; `under_way` holds the numbers of transports that are not over."""
        if event.kind == Kind.RECEIVED:
            self.ledger.add(event.transport_id, event.shelf_id, event.station)
        self._topic.publish(event_message(event))
        # A transport that was cancelled with its unit lifted is over when that is stored.
        is_cancelled = event.kind == Kind.CANCELLED and event.transport_id not in under_way
        if event.kind in ENDS or is_cancelled:
            self.ledger.remove(event.transport_id)

    def fail_abandoned(self, time: float) -> None:
        """Reports FAILED for transports left open by a coordinator that died, once all subscribers
        are connected."""
        if not self._abandoned or not self._is_connected():
            return
        text = "the coordinator was restarted"
        for entry in self._abandoned:
            failed = TransportEvent(time, entry.number, Kind.FAILED, 0, *entry[1:], text)
            self.publish(failed, ())
        self._abandoned = []

    def _is_connected(self) -> bool:
        """Returns whether all live subscribers are connected."""
        if clock.monotonic() > self._connected_by:
            return True
        subscribers = rosgraph.Master(rospy.get_name()).getSystemState()[1]
        topic = self._topic.resolved_name
        expected = sum(len(nodes) for name, nodes in subscribers if name == topic)
        return self._topic.get_num_connections() >= expected
