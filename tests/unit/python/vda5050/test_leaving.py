# SPDX-License-Identifier: Apache-2.0
"""A connection ends after the broker's confirmation of the last message, or after a deadline."""

import selectors
import socket
import threading
import time

import pytest

from warehouse_vda5050.mqtt.loop import LAST_ANSWER, Link, MqttLoop, Outgoing
from warehouse_vda5050.mqtt.settings import BrokerSettings

CONNECT, PUBLISH, PUBACK, DISCONNECT = 1, 3, 4, 14
PATIENCE = 10.0  # [s]
SLOW = 0.3  # time that the broker takes for a confirmation [s]


class SlowBroker(threading.Thread):
    """An MQTT broker that confirms each PUBLISH after `answers` [s]; never, if that is None. It
    reads what a client sent before it accepts another that came later. `packets`: the type of each
    packet, in and out, and the time [s]."""

    def __init__(self, answers):
        super().__init__(daemon=True)
        self.answers, self.packets = answers, []
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.selector = selectors.DefaultSelector()
        self.selector.register(self.listener, selectors.EVENT_READ)
        self.ended = threading.Event()
        self.start()

    def run(self):
        while not self.ended.is_set():
            ready = [key.fileobj for key, _ in self.selector.select(0.05)]
            if ready == [self.listener]:
                self.selector.register(self.listener.accept()[0], selectors.EVENT_READ)
            for client in set(ready) - {self.listener}:
                self.read(client)

    def read(self, client):
        head = client.recv(2, socket.MSG_WAITALL)
        if not head:
            self.selector.unregister(client)
            client.close()
            return
        body = client.recv(head[1], socket.MSG_WAITALL)
        self.note(head[0] >> 4)
        if head[0] >> 4 == CONNECT:
            client.sendall(b"\x20\x02\0\0")
        elif head[0] >> 4 == PUBLISH and self.answers is not None:
            topic = int.from_bytes(body[:2], "big")
            answer = b"\x40\x02" + body[2 + topic : 4 + topic]
            threading.Timer(self.answers, self.confirm, (client, answer)).start()

    def confirm(self, client, answer):
        self.note(PUBACK)
        client.sendall(answer)

    def note(self, packet):
        self.packets.append((packet, time.monotonic()))

    def types(self):
        return [packet for packet, _ in self.packets]

    def close(self):
        self.ended.set()
        self.join()
        self.selector.close()
        self.listener.close()


@pytest.fixture
def broker(request):
    broker = SlowBroker(request.param)
    yield broker
    broker.close()


def until(loop, condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        loop.poll(0.01)


def connected(loop, broker):
    link = Link("leaves", BrokerSettings("127.0.0.1", broker.port), [], lambda *_: None)
    loop.add(link)
    until(loop, lambda: link.connected)
    return link


@pytest.mark.parametrize("broker", [SLOW], indirect=True)
def test_the_last_message_is_confirmed_before_the_connection_ends(broker):
    loop = MqttLoop()
    link = connected(loop, broker)
    link.close(Outgoing("connection", b"OFFLINE", 1))
    assert not link.publish(Outgoing("state", b"late"))
    loop.close()
    until(loop, lambda: DISCONNECT in broker.types())
    assert broker.types() == [CONNECT, PUBLISH, PUBACK, DISCONNECT]


@pytest.mark.parametrize("broker", [None], indirect=True)
def test_a_broker_that_never_confirms_is_left_after_a_deadline(broker):
    loop = MqttLoop()
    link = connected(loop, broker)
    link.close(Outgoing("connection", b"OFFLINE", 1))
    until(loop, lambda: DISCONNECT in broker.types())
    times = dict(broker.packets)
    assert LAST_ANSWER - 0.1 < times[DISCONNECT] - times[PUBLISH] < LAST_ANSWER + 1


@pytest.mark.parametrize("broker", [SLOW], indirect=True)
def test_a_client_comes_back_only_after_it_has_left(broker):
    loop = MqttLoop()
    connected(loop, broker).close(Outgoing("connection", b"OFFLINE", 1))
    connected(loop, broker)
    assert broker.types() == [CONNECT, PUBLISH, PUBACK, DISCONNECT, CONNECT]
