# SPDX-License-Identifier: Apache-2.0
"""Transports of the coordinator node, with the interface that a shift uses."""

from collections.abc import Iterable
from typing import Any

from warehouse_client.coordinator import CoordinatorClient
from warehouse_fleet.transports.transports import ENDS, STORE, Kind, TransportAnswer, TransportEvent

UNKEPT = 100  # most transports that a run requests between two writes to the database


class RemoteTransports:
    """Requests the transports of one run; see protocols.Requests."""

    def __init__(self, coordinator: CoordinatorClient) -> None:
        self._coordinator = coordinator
        self._open: set[int] = set()  # transports that this run asked for
        self.robot_of: dict[int, int] = {}  # the robot of each of these that has one
        self._left: set[int] = set()  # transports that an earlier run asked for
        # The newest known transport of the earlier run, until this run asks for one.
        self._last_left: int | None = None
        coordinator.take_events()  # those of an earlier run

    def submit(
        self,
        shelf_id: int,
        station: str = "",
        x: float | None = None,
        y: float | None = None,
        then: int = STORE,
        priority: int = 0,
    ) -> TransportAnswer:
        """Asks for a transport to a station, or to the cell at x, y in world [m]."""
        answer = self._coordinator.submit(shelf_id, station, x or 0.0, y or 0.0, then, priority)
        if answer.accepted:
            self._release_unknown(answer.transport_id)
            self._open.add(answer.transport_id)
        return TransportAnswer(*answer)

    def release(self, transport_id: int) -> tuple[bool, str]:
        """Lets a unit leave its station. Returns success and the fault."""
        return self._coordinator.release(transport_id)

    def cancel(self, transport_id: int) -> tuple[bool, str]:
        """Cancels a transport. Returns success and the fault."""
        return self._coordinator.cancel(transport_id)

    def set_open(self, station: str, is_open: bool) -> None:
        """Does nothing: a shift cancels its requests at a closed station, and makes no others
        there."""

    def release_left(self, transports: Iterable[int], last: int | None) -> None:
        """Releases the transports of an earlier run at once, or when they arrive.

        last: the newest known transport.
        """
        self._left.update(number for number in transports if not self.release(number)[0])
        self._last_left = last

    def _release_unknown(self, first: int) -> None:
        """Releases the transports that the earlier run requested and did not record: all before
        `first`."""
        if self._last_left is not None:
            self.release_left(range(max(self._last_left + 1, first - UNKEPT), first), None)

    def take_events(self) -> list[TransportEvent]:
        """Returns what happened to the transports of this run since the last call, in order."""
        known = []
        for message in self._coordinator.take_events():
            event = _event(message)
            if event.transport_id in self._open:
                known.append(event)
                if event.kiva_id:
                    self.robot_of[event.transport_id] = event.kiva_id
                if event.kind in ENDS:
                    self._open.discard(event.transport_id)
                    self.robot_of.pop(event.transport_id, None)
            elif event.transport_id in self._left and event.kind == Kind.ARRIVED:
                self._left.discard(event.transport_id)
                self.release(event.transport_id)
        return known


def _event(message: Any) -> TransportEvent:
    return TransportEvent(
        message.header.stamp.to_sec(),
        message.transport_id,
        Kind(message.kind),
        message.kiva_id,
        message.shelf_id,
        message.station,
        message.text,
    )
