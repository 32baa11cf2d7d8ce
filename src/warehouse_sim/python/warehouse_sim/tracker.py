# SPDX-License-Identifier: Apache-2.0
"""Publishes the objects of one kind: a topic for each, and one for all of them."""

import resource
import threading
import time
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any

import numpy as np
from genpy import Time
from geometry_msgs.msg import PoseStamped
from rospy.numpy_msg import numpy_msg
from std_msgs.msg import Header

from warehouse_client import tracking
from warehouse_client.latest import LatestMessages, LazyPublisher
from warehouse_msgs.msg import TrackedObjects, UnitStates, WarehouseObjects

Kind = type[tracking.Items] | type[tracking.StorageUnits]

# Topics that change between two updates of poses; each costs the master half a millisecond.
BATCH = 200
# Time that topics outlive their objects [s, wall]: a warehouse that is built again has the same
# ones.
LINGER = 15.0
SPARE_FILES = 500


class PoseTopics:
    """A latched topic `<prefix>/<name>/pose` for each of the first `limit` objects.

    `advertise(topic)` returns something with publish(message) and unregister().
    """

    def __init__(
        self,
        prefix: str,
        advertise: Callable[[str], Any],
        limit: int,
        linger: float = LINGER,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._prefix, self._advertise, self._limit = prefix, advertise, limit
        self._topics: dict[str, Any] = {}
        self._names: Sequence[str] | None = None  # at the last update
        self._rows: dict[str, int] = {}  # likewise
        self._gone: list[str] = []  # names whose topics are still to be removed
        self._new: list[str] = []  # and to be added
        self._linger, self._clock, self._gone_at = linger, clock, 0.0

    def update(self, objects: tracking.Tracked, moved: np.ndarray, stamp: Time) -> bool:
        """Publishes the poses that `moved` marks. Returns whether topics still have to change."""
        if objects.names is not self._names:
            self._plan(objects.names)
        is_full = len(self._topics) + len(self._new) > self._limit
        are_gone = is_full or self._clock() >= self._gone_at
        if are_gone:
            for name in self._gone[:BATCH]:
                self._topics.pop(name).unregister()
            self._gone = self._gone[BATCH:]
        count = min(BATCH, self._limit - len(self._topics))
        new, self._new = self._new[:count], self._new[count:]
        for name in new:
            self._topics[name] = self._advertise(f"{self._prefix}/{name}/pose")
        known = [objects.names[i] for i in np.flatnonzero(moved[: self._limit])]
        for name in {*new, *(name for name in known if name in self._topics)}:
            pose = tracking.message(objects.pose[self._rows[name]])
            self._topics[name].publish(PoseStamped(Header(0, stamp, "world"), pose))
        return bool(self._new or (are_gone and self._gone))

    def _plan(self, names: Sequence[str]) -> None:
        """Determines the topics to remove and to add for other objects."""
        self._names = names
        self._rows = {name: i for i, name in enumerate(names[: self._limit])}
        self._gone = [name for name in self._topics if name not in self._rows]
        self._new = [name for name in self._rows if name not in self._topics]
        self._gone_at = self._clock() + self._linger


class ObjectList:
    """The TrackedObjects message; only what changed since the last call is rebuilt."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._objects, self._stamp = tracking.Tracked(), None
        self._messages: list[Any] = []
        self._stale = np.zeros(0, bool)

    def update(self, objects: tracking.Tracked, changed: np.ndarray, stamp: Time) -> None:
        """Updates the objects that `changed` marks."""
        with self._lock:
            if len(changed) != len(self._stale):
                self._messages = [None] * len(changed)
                self._stale = np.ones(len(changed), bool)
            self._objects, self._stale, self._stamp = objects, self._stale | changed, stamp

    def message(self) -> TrackedObjects | None:
        """Returns the message; None before the first update."""
        with self._lock:
            if self._stamp is None:
                return None
            for i in np.flatnonzero(self._stale):
                self._messages[i] = self._objects.message(i)
            self._stale[:] = False
            return TrackedObjects(Header(0, self._stamp, "world"), list(self._messages))


class Tracker:
    """Follows one kind of object; `kind` is tracking.Items or tracking.StorageUnits."""

    def __init__(self, kind: Kind, pose_topics: PoseTopics) -> None:
        self._kind, self._pose_topics = kind, pose_topics
        self._objects: WarehouseObjects | None = None  # the message
        self._places: tracking.Items | tracking.StorageUnits | None = (
            None  # where the objects in it are
        )
        self._last: tracking.Tracked | None = None
        self._stamp: Time | None = None
        self._list = ObjectList()
        self.message = self._list.message

    @property
    def count(self) -> int:
        """The number of objects of the last update."""
        return len(self._last.names) if self._last else 0

    def update(self, objects: WarehouseObjects, states: UnitStates) -> tuple[bool, bool]:
        """Updates from the newest messages. Returns whether the list changed, and whether work is
        left."""
        if self._places is None or objects is not self._objects:
            self._objects, self._places = objects, self._kind(objects)
        new, old = self._places.at(states), self._last or tracking.Tracked()
        moved, changed = tracking.moved(old, new), tracking.changed(old, new)
        differs = self._last is None or changed.any() or len(old.names) != len(new.names)
        self._stamp = max(objects.header.stamp, states.header.stamp)
        self._list.update(new, changed, self._stamp)
        self._last = new
        return bool(differs), self._pose_topics.update(new, moved, self._stamp)

    def go_on(self) -> bool:
        """Continues the work of update(). Returns whether any is left."""
        if self._last is None:
            return False
        nothing = np.zeros(self.count, bool)
        return self._pose_topics.update(self._last, nothing, self._stamp)


class PoseTopic:
    """What PoseTopics advertises. `ros` is rospy."""

    def __init__(self, ros: ModuleType, topic: str) -> None:
        self._publisher = ros.Publisher(topic, PoseStamped, latch=True, queue_size=1)
        self.publish = self._publisher.publish

    def unregister(self) -> None:
        """Closes the topic's file at once: rospy leaves it to the garbage collector, which comes
        late, and with thousands of topics none could be opened any more."""
        poller = self._publisher.impl.connection_poll.poller
        self._publisher.unregister()
        poller.close()


def topics_allowed(count: int) -> int:
    """Returns the most topics of a process: rospy opens a file for each, beside those of
    sockets."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    needed = count + SPARE_FILES
    if soft < needed:
        soft = needed if hard == resource.RLIM_INFINITY else min(needed, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    return min(count, max(0, soft - SPARE_FILES))


def follow(ros: ModuleType, kind: Kind, prefix: str) -> None:
    """Publishes until shutdown: the body of a tracking node. `ros` is rospy."""

    def advertise(topic: str) -> PoseTopic:
        return PoseTopic(ros, topic)

    asked = ros.get_param("~max_topics", 30000)
    limit = topics_allowed(asked)
    tracker = Tracker(kind, PoseTopics(prefix, advertise, limit))
    listing = LazyPublisher(ros, prefix, TrackedObjects, tracker.message)
    newest = LatestMessages(
        ros,
        objects=("warehouse/objects", numpy_msg(WarehouseObjects)),
        states=("warehouse/unit_states", numpy_msg(UnitStates)),
    )
    work_left = False
    while not ros.is_shutdown():
        if newest.wait(0 if work_left else 0.2) and newest.units_and_objects:
            differs, work_left = tracker.update(*newest.units_and_objects)
            if differs:
                listing.publish()
        else:
            work_left = tracker.go_on()
        if asked > 0 and tracker.count > limit:
            ros.logwarn_once(
                f"{limit} of {tracker.count} objects have a topic of their own; {prefix} has all."
                " More need a larger ~max_topics, or limit of open files (ulimit -Hn)"
            )
