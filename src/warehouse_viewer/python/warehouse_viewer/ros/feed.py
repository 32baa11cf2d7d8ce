# SPDX-License-Identifier: Apache-2.0
"""The topics of the world, subscribed to only while a page or a request needs them."""

import threading
import time
from collections.abc import Callable, Iterable, Sequence
from types import ModuleType
from typing import Any

import rospy
from genpy import Message
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from gazebo_msgs.msg import PerformanceMetrics
from warehouse_client.message_check import fit, subscribe
from warehouse_msgs.msg import (
    ClosedZones,
    CoordinatorPaths,
    CoordinatorState,
    Event,
    FleetPaths,
    FleetState,
    Scenery,
    TransportEvent,
    UnitStates,
    WarehouseObjects,
)
from warehouse_viewer.ros.simulation import Standing
from warehouse_viewer.ros.vda5050_feed import Vda5050Feed

TOPICS = {
    "fleet": ("warehouse/fleet", numpy_msg(FleetState)),
    "objects": ("warehouse/objects", WarehouseObjects),
    "states": ("warehouse/unit_states", numpy_msg(UnitStates)),
    "scenery": ("warehouse/scenery", Scenery),
    "coordinator": ("warehouse/coordinator", CoordinatorState),
    "zones": ("warehouse/zones", ClosedZones),
    "performance": ("gazebo/performance_metrics", PerformanceMetrics),
}
SILENT = 5.0  # after which a coordinator counts as gone [s, simulated and wall]
KEPT = ("fleet", "coordinator", "zones")  # always subscribed, because pages show their history
LINGER = 10.0  # subscriptions end this long after their last use [s, wall]


class Feed:
    """The newest message of each topic, as page.source.Feed wants it.

    `ros` is rospy. `on_event(Event)`, `on_transport(TransportEvent)` and `on_message()` are called
    in ROS's threads.
    """

    def __init__(
        self,
        ros: ModuleType,
        on_event: Callable[[Event], None],
        on_transport: Callable[[TransportEvent], None],
        on_message: Callable[[], None],
    ) -> None:
        self._ros, self._on_message, self._lock = ros, on_message, threading.Lock()
        self._messages: dict[str, Any] = {}
        self._subscribers: dict[str, Any] = {}
        self._extras: dict[str, Any] = {}
        self._used, self._coordinated = 0.0, 0.0
        self.vda5050 = Vda5050Feed(ros)
        subscribe(ros, "warehouse/events", Event, on_event, queue_size=10000)
        topic = "warehouse/transports"
        subscribe(ros, topic, TransportEvent, on_transport, queue_size=10000)

    def __getitem__(self, name: str) -> Any:
        return self._messages.get(name)

    @property
    def objects_and_states(self) -> tuple[WarehouseObjects, UnitStates] | None:
        """(WarehouseObjects, UnitStates) of the same revision; None if there are none yet."""
        objects, states = self["objects"], self["states"]
        return (objects, states) if fit(objects, states) else None

    @property
    def coordinator(self) -> CoordinatorState | None:
        """The newest CoordinatorState; None if no coordinator runs.

        A killed coordinator does not say goodbye: it is silent while time goes on. One that refuses
        the floor is silent too after it has said so once, and coordinates no robot.
        """
        state, fleet = self["coordinator"], self["fleet"]
        subscriber = self._subscribers.get("coordinator")
        if not (state and fleet and subscriber and subscriber.get_num_connections()):
            return None
        behind = (fleet.stamp - state.header.stamp).to_sec()
        is_silent = min(behind, time.monotonic() - self._coordinated) > SILENT
        return None if is_silent and (state.automatic or not state.alarms) else state

    @property
    def zones(self) -> ClosedZones | None:
        """The newest ClosedZones; None if no coordinator runs."""
        return self["zones"] if self.coordinator else None

    def subscribe(self, names: Iterable[str] = tuple(TOPICS)) -> None:
        """Subscribes to these TOPICS, and keeps all subscriptions for another LINGER seconds."""
        with self._lock:
            self._used = time.monotonic()
            for name in set(names) - self._subscribers.keys():
                self._subscribers[name] = self._subscribe(name, *TOPICS[name])

    def resubscribe(self, name: str) -> None:
        """Forgets a topic's message and subscribes again, which brings a message of now."""
        with self._lock:
            if name in self._subscribers:
                self._subscribers.pop(name).unregister()
                self._messages.pop(name, None)
                self._subscribers[name] = self._subscribe(name, *TOPICS[name])

    def unsubscribe_if_idle(self) -> bool:
        """Drops all but KEPT subscriptions LINGER seconds after their last use; True if it did."""
        with self._lock:
            idle = self._subscribers.keys() - KEPT
            if not idle or time.monotonic() - self._used < LINGER:
                return False
            for name in idle:
                self._subscribers.pop(name).unregister()
                self._messages.pop(name, None)
            return True

    def keep(self) -> None:
        """Subscribes for good to what is KEPT."""
        with self._lock:
            for name in KEPT:
                if name not in self._subscribers:
                    self._subscribers[name] = self._subscribe(name, *TOPICS[name])

    @property
    def has_positions(self) -> bool:
        """Whether it is known where every robot, storage unit and item is."""
        return bool(self.objects_and_states and self["fleet"])

    def reflects(
        self, standing: Standing, objects: WarehouseObjects | None, fleet: FleetState | None
    ) -> bool:
        """Whether the newest messages describe the models of `standing`.

        `objects` and `fleet` are the messages from before a change; they never count as newest.
        """
        if not self.has_positions:
            return False
        names = _names(self["objects"])
        robots = {f"kiva{n}" for n in self["fleet"].kiva_id}
        if names != standing.names or robots != {n for n in names if n.startswith("kiva")}:
            return False
        is_new = self["objects"] is not objects or not names
        stamp = self["fleet"].stamp.to_sec()
        came_later = standing.is_paused or stamp >= standing.time
        return is_new and (not robots or (self["fleet"] is not fleet and came_later))

    @property
    def is_complete(self) -> bool:
        """Whether everything is there that a picture needs."""
        return bool(self.has_positions and self["scenery"])

    def subscribe_extras(self, paths: bool, ways: bool, scans: Sequence[int]) -> None:
        """Subscribes to paths, to ways, and to the scans of exactly these robots (ids)."""
        topics = {f"scan{n}": (f"kiva{n}/chassis/laser/scan", LaserScan) for n in scans}
        if scans:
            topics["frames"] = ("tf_static", TFMessage)
        if paths:
            topics["paths"] = ("warehouse/paths", FleetPaths)
        if ways:
            topics["ways"] = ("warehouse/coordinator_paths", numpy_msg(CoordinatorPaths))
        with self._lock:
            for name in self._extras.keys() - topics.keys():
                self._extras.pop(name).unregister()
                self._messages.pop(name, None)
            for name in topics.keys() - self._extras.keys():
                self._extras[name] = self._subscribe(name, *topics[name])

    def _subscribe(self, name: str, topic: str, kind: type) -> rospy.Subscriber:
        return subscribe(self._ros, topic, kind, self._keep, name, queue_size=1)

    def _keep(self, message: Message, name: str) -> None:
        self._messages[name] = message
        if name == "coordinator":
            self._coordinated = time.monotonic()
        self._on_message()


def _names(objects: WarehouseObjects) -> set[str]:
    """Returns the names of every model in a WarehouseObjects."""
    robots = (f"kiva{n}" for n in objects.kiva_id)
    return {*robots, *objects.storage_units, *objects.items, *objects.belts}
