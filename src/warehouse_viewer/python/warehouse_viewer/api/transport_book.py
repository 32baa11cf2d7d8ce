# SPDX-License-Identifier: Apache-2.0
"""The progress of each transport, from the coordinator's messages since this program began."""

import threading
from typing import Any

from warehouse_client.message_names import TRANSPORT
from warehouse_msgs.msg import TransportEvent

KEPT = 2000
UNDER_WAY = ("ASSIGNED", "LIFTED", "ARRIVED")


class TransportBook:
    """Transports as dicts by their number. Any thread may add, any may read."""

    def __init__(self, kept: int = KEPT) -> None:
        self._lock, self._kept = threading.Lock(), kept
        self._transports: dict[int, dict[str, Any]] = {}

    def add(self, event: TransportEvent) -> dict[str, Any]:
        """Adds what an event says of its transport; returns the transport's entry."""
        number, entry = event.transport_id, entry_of(event)
        with self._lock:
            # A coordinator counts from 1; after a restart it has no earlier transports. One whose
            # unit was put back, and waits, is the same.
            if event.kind == TransportEvent.RECEIVED and not self._is_known(entry):
                self._transports.clear()
            self._transports[number] = entry
            while len(self._transports) > self._kept:
                del self._transports[min(self._transports)]
        return entry

    def _is_known(self, entry: dict[str, Any]) -> bool:
        """Returns whether a transport that was received is new, or the one of that number."""
        known = self._transports.get(entry["id"])
        same = ("storage_unit", "station")
        return known is None or (
            known["state"] in UNDER_WAY and all(known[name] == entry[name] for name in same)
        )

    def get(self, number: int) -> dict[str, Any] | None:
        """Returns the transport of that number, or None."""
        with self._lock:
            return self._transports.get(number)

    def assigned(self) -> dict[int, tuple[int, str]]:
        """Returns the unit and the station of each robot whose transport is not at its goal yet."""
        with self._lock:
            rows = [t for t in self._transports.values() if t["robot"] and t["state"] in UNDER_WAY]
        return {_number(t["robot"]): (_number(t["storage_unit"]), t["station"]) for t in rows}

    def newest_first(self, state: str | None = None) -> list[dict[str, Any]]:
        """Returns all transports, or those in one state: the name of a kind of TransportEvent."""
        with self._lock:
            rows = [t for t in self._transports.values() if state in (None, t["state"])]
        return sorted(rows, key=lambda transport: -transport["id"])


def entry_of(event: TransportEvent) -> dict[str, Any]:
    """Returns what the API says of the transport that an event is about."""
    return {
        "id": event.transport_id,
        "state": TRANSPORT[event.kind],
        "since": round(event.header.stamp.to_sec(), 3),
        "robot": f"kiva{event.kiva_id}" if event.kiva_id else "",
        "storage_unit": f"storage_unit{event.shelf_id}",
        "station": event.station,
        "text": event.text,
    }


def _number(name: str) -> int:
    return int(name.lstrip("abcdefghijklmnopqrstuvwxyz_"))
