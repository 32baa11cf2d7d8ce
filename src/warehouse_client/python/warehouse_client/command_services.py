# SPDX-License-Identifier: Apache-2.0
"""ROS services that change something, and a topic that says which node called them and how."""

from collections.abc import Callable
from typing import Any

import genpy
import yaml

from warehouse_msgs.msg import Command

CALLS = "warehouse/service_calls"  # a Command each; `topic` is the name of the service
QUEUE = 1000
MOST_TEXT = 200  # characters of a text in a request


class CommandServices:
    """Advertises services and publishes each call of them on CALLS, before it is answered.

    ros: rospy, or what stands in for it in a test.
    """

    def __init__(self, ros: Any) -> None:
        self._ros = ros
        self._calls = ros.Publisher(CALLS, Command, queue_size=QUEUE)

    def serve(self, name: str, kind: Any, answer: Callable[[Any], Any]) -> None:
        """Advertises a service of that name and kind, whose requests answer(request) answers."""
        resolved = self._ros.resolve_name(name)

        def take(request: Any) -> Any:
            fields = yaml.safe_dump(_plain(request), sort_keys=False, allow_unicode=True)
            self._calls.publish(Command(resolved, caller(request), fields))
            return answer(request)

        self._ros.Service(name, kind, take)


def caller(request: Any) -> str:
    """Returns the name of the node that called a service; "" where its client did not say it."""
    header = getattr(request, "_connection_header", None) or {}
    return str(header.get("callerid", ""))


def _plain(value: Any) -> Any:
    """Returns a message, or a value in one, as what YAML has."""
    if isinstance(value, genpy.TVal):  # a time or a duration
        return value.to_sec()
    if isinstance(value, genpy.Message):
        return {name: _plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, (list, tuple, bytes)):
        return [_plain(each) for each in value]
    if isinstance(value, str) and len(value) > MOST_TEXT:  # such as a layout's
        return f"{value[:MOST_TEXT]}… ({len(value)} characters)"
    return value
