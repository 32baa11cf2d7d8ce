# SPDX-License-Identifier: Apache-2.0
"""A client of the coordinator of a running warehouse, by its services and topics."""

import threading
from types import ModuleType
from typing import Any, NamedTuple

from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import CoordinatorState, TransportEvent
from warehouse_msgs.srv import CancelTransport, ReleaseTransport, Transport


class ServiceAnswer(NamedTuple):
    """The answer to a request for a transport; `transport_id` is 0 if it was refused."""

    transport_id: int
    accepted: bool
    message: str


class CoordinatorClient:
    """A client of the coordinator.

    ros: rospy, or what stands in for it in a test. state: its last CoordinatorState, or None.
    """

    def __init__(self, ros: ModuleType) -> None:
        self._ros = ros
        self._events: list[TransportEvent] = []
        self._lock = threading.Lock()
        self.state: CoordinatorState | None = None
        self._transport = ros.ServiceProxy("warehouse/transport", Transport)
        self._release = ros.ServiceProxy("warehouse/release_transport", ReleaseTransport)
        self._cancel = ros.ServiceProxy("warehouse/cancel_transport", CancelTransport)
        subscribe(ros, "warehouse/transports", TransportEvent, self._on_event, queue_size=10000)
        subscribe(ros, "warehouse/coordinator", CoordinatorState, self._on_state, queue_size=1)

    @property
    def time(self) -> float:
        """The time of the last state [s, simulated]; 0 before the first."""
        return float(self.state.header.stamp.to_sec()) if self.state else 0.0

    def submit(
        self,
        shelf_id: int,
        station: str = "",
        x: float = 0.0,
        y: float = 0.0,
        then: int = 0,
        priority: int = 0,
    ) -> ServiceAnswer:
        """Asks for a transport to a station, or without one to x, y in world [m].

        A coordinator that does not answer refuses.
        """
        try:
            answer = self._transport(shelf_id, station, x, y, then, priority)
        except self._ros.ServiceException as error:
            return ServiceAnswer(0, False, str(error))
        return ServiceAnswer(answer.transport_id, answer.accepted, answer.message)

    def release(self, transport_id: int) -> tuple[bool, str]:
        """Lets a unit leave its station. Returns success and the fault."""
        return self._call(self._release, transport_id)

    def cancel(self, transport_id: int) -> tuple[bool, str]:
        """Cancels a transport. Returns success and the fault."""
        return self._call(self._cancel, transport_id)

    def _call(self, service: Any, transport_id: int) -> tuple[bool, str]:
        try:
            answer = service(transport_id)
        except self._ros.ServiceException as error:
            return False, str(error)
        return answer.success, answer.message

    def take_events(self) -> list[TransportEvent]:
        """Returns the TransportEvent messages that came since the last call, in order."""
        with self._lock:
            events, self._events = self._events, []
        return events

    def _on_event(self, event: Any) -> None:
        with self._lock:
            self._events.append(event)

    def _on_state(self, state: Any) -> None:
        self.state = state
