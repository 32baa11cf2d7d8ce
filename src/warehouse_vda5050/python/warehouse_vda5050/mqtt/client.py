# SPDX-License-Identifier: Apache-2.0
"""One MQTT client of paho, 1.6 or 2: Debian 12 has the former, Debian 13 the latter."""

from collections.abc import Callable
from typing import Any

import paho.mqtt.client as paho

from warehouse_vda5050.mqtt.settings import BrokerSettings

KEEPALIVE = 15  # the broker takes a silent robot as gone after one and a half of it [s]


def make_client(client_id: str, broker: BrokerSettings) -> Any:
    """Returns a client that is not connected yet. Raises OSError for a bad certificate file."""
    if hasattr(paho, "CallbackAPIVersion"):
        client = paho.Client(paho.CallbackAPIVersion.VERSION2, client_id=client_id)
    else:
        client = paho.Client(client_id=client_id)
    if broker.user:
        client.username_pw_set(broker.user, broker.password or None)
    if broker.tls:
        client.tls_set(ca_certs=broker.authority or None)
    client.max_queued_messages_set(100)
    return client


def listen(
    client: Any,
    connected: Callable[[str], None],
    lost: Callable[[], None],
    message: Callable[[str, bytes, bool], None],
) -> None:
    """Calls connected('' or why not), lost(), message(topic, payload, retained)."""

    def on_connect(_client: Any, _data: Any, _flags: Any, code: Any, *_: Any) -> None:
        failed = getattr(code, "is_failure", code != 0)
        connected(_text(code) if failed else "")

    client.on_connect = on_connect
    client.on_disconnect = lambda *_: lost()
    client.on_message = lambda _client, _data, m: message(m.topic, m.payload, bool(m.retain))


def _text(code: Any) -> str:
    return paho.connack_string(code) if isinstance(code, int) else str(code)


def begin_connecting(client: Any, broker: BrokerSettings) -> None:
    """Opens the socket and says hello; the answer comes later. Raises OSError."""
    try:
        client.connect(broker.host, broker.port, KEEPALIVE)
    except ValueError as error:  # a name that no host can have
        raise OSError(str(error)) from error


def cut(client: Any) -> None:
    """Closes the socket without a DISCONNECT: the broker publishes the will."""
    socket = client.socket()
    if socket:
        socket.close()
