# SPDX-License-Identifier: Apache-2.0
"""How far each transport is, by what the coordinator has told since this began."""

import threading

from warehouse_client.message_names import TRANSPORT
from warehouse_msgs.msg import TransportEvent

KEPT = 2000


class TransportBook:
    """Transports as dicts by their number. Any thread may add, any may read."""

    def __init__(self, kept=KEPT):
        self._lock, self._kept, self._transports = threading.Lock(), kept, {}

    def add(self, event):
        """Takes a warehouse_msgs/TransportEvent in; returns its entry."""
        number, entry = event.transport_id, entry_of(event)
        with self._lock:
            # A coordinator counts from 1; after a restart it has no earlier transports.
            if event.kind == TransportEvent.RECEIVED and number in self._transports:
                self._transports.clear()
            self._transports[number] = entry
            while len(self._transports) > self._kept:
                del self._transports[min(self._transports)]
        return entry

    def get(self, number):
        """One of them, or None."""
        with self._lock:
            return self._transports.get(number)

    def newest_first(self, state=None):
        """All, or those in one state: a kind of TransportEvent by its name."""
        with self._lock:
            found = [t for t in self._transports.values() if state in (None, t["state"])]
        return sorted(found, key=lambda transport: -transport["id"])


def entry_of(event):
    """What the API tells of the transport that a TransportEvent is about."""
    return {
        "id": event.transport_id,
        "state": TRANSPORT[event.kind],
        "since": round(event.header.stamp.to_sec(), 3),
        "robot": f"kiva{event.kiva_id}" if event.kiva_id else "",
        "storage_unit": f"storage_unit{event.shelf_id}",
        "station": event.station,
        "text": event.text,
    }
