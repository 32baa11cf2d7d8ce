# SPDX-License-Identifier: Apache-2.0
"""What the world publishes, heard only while somebody looks."""

import threading
import time

from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from gazebo_msgs.msg import PerformanceMetrics
from warehouse_msgs.msg import (
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

TOPICS = {
    "fleet": ("/warehouse/fleet", numpy_msg(FleetState)),
    "objects": ("/warehouse/objects", WarehouseObjects),
    "states": ("/warehouse/unit_states", numpy_msg(UnitStates)),
    "scenery": ("/warehouse/scenery", Scenery),
    "coordinator": ("/warehouse/coordinator", CoordinatorState),
    "performance": ("/gazebo/performance_metrics", PerformanceMetrics),
}
SILENT = 5.0  # after which nobody coordinates any more [s, simulated and wall]
LINGER = 10.0  # after the last look, before the ears are closed [s, wall]


class Feed:
    """The newest message of each topic; None where none came since somebody looked.

    `ros` is rospy. `on_event(Event)`, `on_transport(TransportEvent)` and `on_news()` are called in
    ROS's threads.
    """

    def __init__(self, ros, on_event, on_transport, on_news):
        self._ros, self._on_news, self._lock = ros, on_news, threading.Lock()
        self._messages, self._subscribers, self._extras = {}, {}, {}
        self._looked, self._coordinated = 0.0, 0.0
        ros.Subscriber("/warehouse/events", Event, on_event, queue_size=10000)
        topic = "/warehouse/transports"
        ros.Subscriber(topic, TransportEvent, on_transport, queue_size=10000)

    def __getitem__(self, name):
        return self._messages.get(name)

    @property
    def units_and_objects(self):
        """(WarehouseObjects, UnitStates) if both are there and fit each other, else None."""
        objects, states = self["objects"], self["states"]
        fit = objects and states and objects.revision == states.revision
        return (objects, states) if fit else None

    @property
    def coordinator(self):
        """The newest CoordinatorState; None where no coordinator runs.

        One that was killed says no goodbye, but falls silent while time goes on. One that refuses
        the floor says so once, and coordinates nobody.
        """
        state, fleet = self["coordinator"], self["fleet"]
        subscriber = self._subscribers.get("coordinator")
        if not (state and fleet and subscriber and subscriber.get_num_connections()):
            return None
        behind = (fleet.stamp - state.header.stamp).to_sec()
        is_silent = min(behind, time.monotonic() - self._coordinated) > SILENT
        return None if is_silent and (state.automatic or not state.alarms) else state

    def look(self, names=tuple(TOPICS)):
        """Somebody looks at these TOPICS: they are heard for a while."""
        with self._lock:
            self._looked = time.monotonic()
            for name in set(names) - self._subscribers.keys():
                self._subscribers[name] = self._subscribe(name, *TOPICS[name])

    def hear_anew(self, name):
        """Forgets a topic's message. Whoever comes to it anew gets one of now."""
        with self._lock:
            if name in self._subscribers:
                self._subscribers.pop(name).unregister()
                self._messages.pop(name, None)
                self._subscribers[name] = self._subscribe(name, *TOPICS[name])

    def rest(self):
        """Stops to listen if nobody has looked for a while. True if it did."""
        with self._lock:
            if not self._subscribers or time.monotonic() - self._looked < LINGER:
                return False
            for subscriber in self._subscribers.values():
                subscriber.unregister()
            self._subscribers.clear()
            self._messages.clear()
            return True

    @property
    def tells_all(self):
        """Whether it is known where everything is."""
        return bool(self.units_and_objects and self["fleet"])

    def shows(self, standing, objects, fleet):
        """Whether the newest messages tell of what stands there: a simulation.Standing.

        Those from before it came, `objects` and `fleet`, don't, even where they look the same.
        """
        if not self.tells_all:
            return False
        told = _names(self["objects"])
        robots = {f"kiva{n}" for n in self["fleet"].kiva_id}
        if told != standing.names or robots != {n for n in told if n.startswith("kiva")}:
            return False
        is_new = self["objects"] is not objects or not told
        stamp = self["fleet"].stamp.to_sec()
        came_later = standing.is_paused or stamp >= standing.time
        return is_new and (not robots or (self["fleet"] is not fleet and came_later))

    @property
    def complete(self):
        """Whether there is all that a picture needs."""
        return bool(self.tells_all and self["scenery"])

    def want(self, paths, ways, scans):
        """Hears paths or not, ways or not, and the scans of exactly these robots (ids)."""
        wanted = {f"scan{n}": (f"/kiva{n}/chassis/laser/scan", LaserScan) for n in scans}
        if scans:
            wanted["frames"] = ("/tf_static", TFMessage)
        if paths:
            wanted["paths"] = ("/warehouse/paths", FleetPaths)
        if ways:
            wanted["ways"] = ("/warehouse/coordinator_paths", numpy_msg(CoordinatorPaths))
        with self._lock:
            for name in self._extras.keys() - wanted.keys():
                self._extras.pop(name).unregister()
                self._messages.pop(name, None)
            for name in wanted.keys() - self._extras.keys():
                self._extras[name] = self._subscribe(name, *wanted[name])

    def _subscribe(self, name, topic, kind):
        return self._ros.Subscriber(topic, kind, self._keep, callback_args=name, queue_size=1)

    def _keep(self, message, name):
        self._messages[name] = message
        if name == "coordinator":
            self._coordinated = time.monotonic()
        self._on_news()


def _names(objects):
    """Of all that a WarehouseObjects tells of."""
    robots = (f"kiva{n}" for n in objects.kiva_id)
    return {*robots, *objects.storage_units, *objects.items, *objects.belts}
