# SPDX-License-Identifier: Apache-2.0
"""Many connections in one thread: poll() reads and writes whatever is ready.

A robot's will belongs to a connection of its own, so there are as many as robots; a thread each
would cost more than the messages.
"""

import random
import selectors
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, NamedTuple

from warehouse_vda5050.mqtt.client import begin_connecting, cut, listen, make_client
from warehouse_vda5050.mqtt.settings import BrokerSettings

BACK_OFF = (0.2, 5.0)  # the first and the longest wait before a further attempt [s]
PATIENCE = 10.0  # timeout of a connection to a broker [s]
LAST_ANSWER = 1.0  # longest wait for the broker's answer to the last messages [s]


class Outgoing(NamedTuple):
    """A message to be sent."""

    topic: str
    payload: bytes
    qos: int = 0
    retain: bool = False


class Link:
    """One connection to a broker, made again whenever it is lost.

    on_message(topic, payload, retained) and on_connect() are called by MqttLoop.poll(). make_will()
    returns what the broker is to publish if the connection breaks, or None; it is asked before
    each attempt. Not for other threads than that of poll().
    """

    def __init__(
        self,
        name: str,
        broker: BrokerSettings,
        subscriptions: Iterable[tuple[str, int]],
        on_message: Callable[[str, bytes, bool], None],
        on_connect: Callable[[], None] = lambda: None,
        make_will: Callable[[], Outgoing | None] = lambda: None,
    ) -> None:
        self.name, self.broker = name, broker
        self.connected = False
        self.fault = "not connected yet"  # why it is not connected, '' if it is
        self.is_wanted = True  # whether to connect
        self.closed = False
        self._subscriptions = list(subscriptions)
        self._on_message, self._on_connect, self._make_will = on_message, on_connect, make_will
        self._client: Any = None
        self._attempt: Future | None = None
        self._next_attempt = 0.0
        self._wait = BACK_OFF[0]
        self._asked_at = 0.0
        self._unanswered: list[Any] = []  # since the connection was made
        self._leaves_by: float | None = None  # when it disconnects without an answer

    def publish(self, message: Outgoing) -> bool:
        """Sends a message. Returns False if there is no connection, or if it is closed."""
        return not self.closed and self._publish(message)

    def _publish(self, message: Outgoing) -> bool:
        if not self.connected:
            return False
        info = self._client.publish(message.topic, message.payload, message.qos, message.retain)
        if message.qos and not info.rc:
            self._unanswered = [i for i in self._unanswered if not i.is_published()] + [info]
        return True

    @property
    def is_answered(self) -> bool:
        """Whether the broker has confirmed all messages that it has to. To close a connection
        before that resets it, and the broker may lose what it has not read."""
        return all(info.is_published() for info in self._unanswered)

    def cut(self) -> None:
        """Ends the connection as a lost radio does, until restore()."""
        self.is_wanted = False
        if self._client is not None and self._attempt is None:
            cut(self._client)
            self._lose("cut")

    def restore(self) -> None:
        """Lets the link connect after cut()."""
        self.is_wanted = True

    def close(self, farewell: Outgoing | None = None) -> None:
        """Sends a last message, and disconnects in good order once the broker has confirmed what
        it has to, or after LAST_ANSWER; MqttLoop.close() waits for it. Nothing more is heard."""
        if self.closed:
            return
        self.is_wanted, self.closed = False, True
        if not self.connected:
            return
        self._client.on_message = None
        if farewell:
            self._publish(farewell)
        self._leaves_by = time.monotonic() + LAST_ANSWER
        self._leave(time.monotonic())

    def _leave(self, now: float) -> None:
        """Disconnects, if it is time to."""
        if self._leaves_by is not None and (self.is_answered or now >= self._leaves_by):
            self._leaves_by = None
            self._client.disconnect()

    # Called by MqttLoop.

    @property
    def socket(self) -> Any:
        """The socket, None without one."""
        if self._client is None or self._attempt is not None:
            return None
        return self._client.socket()

    @property
    def wants_to_write(self) -> bool:
        """Whether bytes wait to be sent."""
        return bool(self._client.want_write())

    def read(self) -> None:
        """Reads the messages that arrived."""
        self._client.loop_read()

    def write(self) -> None:
        """Sends what waits."""
        self._client.loop_write()

    def keep_up(self, now: float, pool: ThreadPoolExecutor) -> None:
        """Connects if it is time to, keeps the connection alive otherwise."""
        if self._attempt is not None:
            self._end_attempt(now)
        elif self._client is not None:
            self._client.loop_misc()
            if self._client is not None:
                self._leave(now)
            if not self.connected and self._client and now - self._asked_at > PATIENCE:
                cut(self._client)
                self._lose("the broker does not answer")
        elif self.is_wanted and now >= self._next_attempt:
            self._attempt = pool.submit(self._connect)

    def _connect(self) -> Any:
        """Returns a client that has said hello; in a thread of the pool. Raises OSError."""
        client = make_client(self.name, self.broker)
        will = self._make_will()
        if will:
            client.will_set(will.topic, will.payload, will.qos, will.retain)
        listen(client, self._answered, lambda: self._lose("the connection broke"), self._on_message)
        begin_connecting(client, self.broker)
        return client

    def _end_attempt(self, now: float) -> None:
        assert self._attempt
        if not self._attempt.done():
            return
        attempt, self._attempt = self._attempt, None
        self._asked_at = now
        try:
            self._client = attempt.result()
        except OSError as error:
            self._lose(str(error))
        if not self.is_wanted and self._client is not None:
            cut(self._client)
            self._lose("cut")

    def _answered(self, fault: str) -> None:
        if fault:
            self._lose(fault)
            return
        self.connected, self.fault, self._wait = True, "", BACK_OFF[0]
        if self._subscriptions:
            self._client.subscribe(self._subscriptions)
        self._on_connect()

    def _lose(self, fault: str) -> None:
        client, self._client = self._client, None
        if client is not None:
            client.on_disconnect = client.on_message = client.on_connect = None
        self.connected, self.fault, self._unanswered = False, fault, []
        self._leaves_by = None
        self._next_attempt = time.monotonic() + self._wait * random.uniform(0.5, 1.0)
        self._wait = min(2 * self._wait, BACK_OFF[1])


class MqttLoop:
    """Reads and writes the sockets of all links."""

    def __init__(self) -> None:
        self.links: list[Link] = []
        self._selector = selectors.DefaultSelector()
        self._watched: dict[Link, tuple[Any, int]] = {}  # the socket, and which events
        self._pool = ThreadPoolExecutor(8, thread_name_prefix="mqtt-connect")

    def add(self, link: Link) -> Link:
        """Begins to look after a link; returns it."""
        self.links.append(link)
        return link

    def remove(self, link: Link) -> None:
        """Stops serving a link."""
        self.links.remove(link)

    def poll(self, timeout: float = 0.0) -> None:
        """Waits at most `timeout` [s] for something to read or write, then does what is due."""
        end = time.monotonic() + timeout
        while True:
            now = time.monotonic()
            self._keep_up(now)
            self._serve(max(0.0, min(end - now, 0.05)))
            if now >= end:
                return

    def _keep_up(self, now: float) -> None:
        # A client that comes back before it has left takes its own connection over, and the broker
        # publishes the will.
        leaving = {link.name for link in self.links if link.closed}
        for link in [*self.links]:
            if link.closed or link.name not in leaving:
                link.keep_up(now, self._pool)
            if link.closed and link.socket is None:
                self.links.remove(link)

    def _serve(self, timeout: float) -> None:
        self._watch()
        if not self._watched:
            time.sleep(timeout)
            return
        for key, events in self._selector.select(timeout):
            _serve_one(key.data, events)

    def _watch(self) -> None:
        """Brings the selector up to date; of a thousand links few change from time to time."""
        waiting = {}
        for link in self.links:
            socket = link.socket
            if socket is not None and socket.fileno() >= 0:
                writes = selectors.EVENT_WRITE if link.wants_to_write else 0
                waiting[link] = socket, selectors.EVENT_READ | writes
        # First those that go: a new socket may have the number of a closed one.
        for link in [link for link in self._watched if self._watched[link] != waiting.get(link)]:
            self._selector.unregister(self._watched.pop(link)[0])
        for link in waiting.keys() - self._watched.keys():
            self._watched[link] = waiting[link]
            self._selector.register(*waiting[link], link)

    def close(self, timeout: float = 2.0) -> None:
        """Waits until links that were closed have said goodbye; ends the others."""
        end = time.monotonic() + timeout
        while time.monotonic() < end and any(link.socket for link in self.links):
            self.poll(0.01)
        self._pool.shutdown(wait=False, cancel_futures=True)
        self._selector.close()


def _serve_one(link: Link, events: int) -> None:
    if events & selectors.EVENT_READ and link.socket is not None:
        link.read()
    if events & selectors.EVENT_WRITE and link.socket is not None:
        link.write()
