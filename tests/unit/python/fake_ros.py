# SPDX-License-Identifier: Apache-2.0
"""Stands in for rospy where a test needs no master."""

from types import SimpleNamespace

from warehouse_msgs.msg import FleetState


def fleet_state(**fields):
    """A FleetState as a world sends it: columns that are not given are zeros."""
    rows = len(fields["kiva_id"])
    unsaid = {
        n: [0] * rows for n, t in zip(FleetState.__slots__, FleetState._slot_types) if "[" in t
    }
    return FleetState(**(unsaid | fields))


class Publisher:
    """Remembers what was published."""

    def __init__(self, topic, kind, subscriber_listener=None, **_):
        self.topic, self.kind, self.listener = topic, kind, subscriber_listener
        self.sent, self.listeners, self.open = [], 0, True

    def publish(self, message=None, **fields):
        message = self.kind(**fields) if message is None else message
        assert isinstance(message, self.kind)
        self.sent.append(message)

    def connect(self):
        """A subscriber comes."""
        self.listeners += 1
        self.listener.peer_subscribe(self.topic, self.publish, self.publish)

    def get_num_connections(self):
        return self.listeners

    def unregister(self):
        self.open = False


class FakeRos:
    """Publishers and callbacks by topic; parameters as given."""

    def __init__(self, **parameters):
        self.parameters = {f"~{name}": value for name, value in parameters.items()}
        self.publishers, self.callbacks, self.warnings = {}, {}, []
        self.connections = 1  # of each subscriber

    def logwarn(self, text):
        self.warnings.append(text)

    logwarn_once = logwarn

    def get_namespace(self):
        return "/"

    @staticmethod
    def get_name():
        return "/viewer"

    @staticmethod
    def resolve_name(name):
        return f"/{name.lstrip('/')}"

    def get_param(self, name, default):
        return self.parameters.get(name, default)

    def Publisher(self, topic, kind, **options):  # noqa: N802 (rospy's name)
        self.publishers[topic] = Publisher(topic, kind, **options)
        return self.publishers[topic]

    def Subscriber(self, topic, kind, callback, callback_args=None, **_):  # noqa: N802
        args = () if callback_args is None else (callback_args,)
        self.callbacks[topic] = lambda message: callback(message, *args)
        return SimpleNamespace(
            unregister=lambda: self.callbacks.pop(topic),
            get_num_connections=lambda: self.connections,
        )
