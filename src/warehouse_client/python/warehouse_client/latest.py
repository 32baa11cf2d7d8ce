# SPDX-License-Identifier: Apache-2.0
"""News and the newest messages for a node's worker thread, and messages made on demand."""

import threading
from collections.abc import Callable
from typing import Any

from warehouse_client.message_check import fit, subscribe


class News:
    """Wakes a worker thread. What comes just as a wait ends in vain is kept for the next one."""

    def __init__(self) -> None:
        self._event = threading.Event()

    def set(self) -> None:
        """Ends the worker's wait, the present one or the next."""
        self._event.set()

    def wait(self, timeout: float) -> bool:
        """Waits for news, at most `timeout` wall seconds. Returns whether there were any; the
        worker looks at them after that."""
        came = self._event.wait(timeout)
        if came:
            self._event.clear()
        return came


class LatestMessages:
    """Keeps the newest message of each topic, for a worker that may be slower than the topics.

    `ros` is rospy, or what stands in for it in a test.
    """

    def __init__(self, ros: Any, **topics: Any) -> None:
        """Subscribes; `topics` maps a name to (topic, message type)."""
        self._fresh, self._lock = News(), threading.Lock()
        self._messages = dict.fromkeys(topics)
        for name, (topic, kind) in topics.items():
            subscribe(ros, topic, kind, self._keep, name, queue_size=1)

    def _keep(self, message: Any, name: str) -> None:
        with self._lock:
            self._messages[name] = message
        self._fresh.set()

    def wait(self, timeout: float) -> bool:
        """Waits for a new message, at most `timeout` wall seconds. Returns whether one came."""
        return self._fresh.wait(timeout)

    def __getitem__(self, name: str) -> Any:
        with self._lock:
            return self._messages[name]

    @property
    def units_and_objects(self) -> tuple[Any, Any] | None:
        """Returns (WarehouseObjects, UnitStates) of the same revision; None without both.

        Between the two messages of a change the revisions differ; the second is on its way.
        """
        objects, states = self["objects"], self["states"]
        return (objects, states) if fit(objects, states) else None


class LazyPublisher:
    """A latched topic whose message is made only if it has subscribers.

    It is sent to all on publish(), and a newcomer gets the newest at once. `make()` returns the
    message, or None while there is nothing to publish. `news()` returns the message of publish()
    where that is shorter than what a new subscriber needs.
    """

    def __init__(
        self,
        ros: Any,
        topic: str,
        kind: Any,
        make: Callable[[], Any],
        news: Callable[[], Any] | None = None,
    ) -> None:
        self._make, self._news, self._lock = make, news or make, threading.Lock()
        self._publisher: Any = None
        self._publisher = ros.Publisher(
            topic, kind, subscriber_listener=self, latch=True, queue_size=1
        )
        # A subscriber that connected during the line above has no message yet.
        self.publish()

    def publish(self) -> None:
        """Publishes the news if there is a subscriber."""
        if self._publisher.get_num_connections():
            self._send(self._news)

    def peer_subscribe(self, _topic: str, _publish: Any, _publish_to_newcomer: Any) -> None:
        """Called by rospy, just before it sends the latched message."""
        if self._publisher:
            self._send(self._make)

    def peer_unsubscribe(self, _topic: str, _connections: Any) -> None:
        """Called by rospy."""

    def _send(self, make: Callable[[], Any]) -> None:
        with self._lock:
            message = make()
            if message is not None:
                self._publisher.publish(message)
