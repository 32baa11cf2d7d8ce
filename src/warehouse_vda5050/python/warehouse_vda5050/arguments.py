# SPDX-License-Identifier: Apache-2.0
"""The parameters of nodes that talk to a broker, and a broker of their own."""

import contextlib
import os
import pathlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from warehouse_vda5050.codec import DEFAULT_VERSION, Codec, codec_for
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.settings import BrokerSettings, read_settings
from warehouse_vda5050.topics import Topics, prefix_of

START = "start"


@dataclass(frozen=True)
class BrokerArguments:
    """broker: HOST:PORT or start."""

    broker: str
    tls: str
    user: str
    password_file: str
    codec: Codec
    topics: Topics


def read_arguments(parameter: Callable[[str, Any], Any]) -> BrokerArguments:
    """Returns the arguments from a node's private parameters; `parameter` is rospy.get_param.
    Raises ValueError."""
    strict = bool(parameter("~strict", False))
    codec = codec_for(str(parameter("~version", DEFAULT_VERSION)), strict)
    return BrokerArguments(
        str(parameter("~broker", "localhost:1883")),
        str(parameter("~tls", "")),
        str(parameter("~user", "")),
        str(parameter("~password_file", "")),
        codec,
        Topics(str(parameter("~prefix", "")) or prefix_of(codec.version)),
    )


def own_broker(
    arguments: BrokerArguments, stack: contextlib.ExitStack
) -> tuple[BrokerSettings, str]:
    """Returns the broker to connect to, and its address; starts one where broker is `start`, which
    ends with `stack`. Raises ValueError and BrokerStartError."""
    if arguments.broker != START:
        settings = read_settings(
            arguments.broker, arguments.tls, arguments.user, arguments.password_file
        )
        return settings, f"{settings.host}:{settings.port}"
    if arguments.tls.lower() not in ("", "false") or arguments.user:
        raise ValueError("broker:=start listens on this machine alone, without tls and user")
    broker = stack.enter_context(OwnBroker())
    file = port_file()
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"{broker.port}\n")
    stack.callback(file.unlink, missing_ok=True)
    return BrokerSettings("localhost", broker.port), f"localhost:{broker.port}"


def port_file() -> pathlib.Path:
    """Returns the file that holds the port of the broker that was started here."""
    return home() / "vda5050_port"


def home() -> pathlib.Path:
    """Returns the folder for files of this system in ROS's own."""
    ros = os.environ.get("ROS_HOME") or pathlib.Path.home() / ".ros"
    return pathlib.Path(ros, "warehouse")
