#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Whatever any program publishes or asks for, each node of a shift lives, and each page answers.

Topics, services and their types are those of the running graph. BURST=all sends the burst on each
topic, which takes minutes.
"""

import itertools
import json
import math
import os
import unittest
from xmlrpc.client import ServerProxy

import rosgraph
import roslib.message
import rospy
import rosservice
import rostest
import rostopic
from rosgraph_msgs.msg import Log
from rostest_support.node_test import call, wait_until
from rostest_support.page_test import fetch

from gazebo_msgs.srv import SetPhysicsProperties, SetPhysicsPropertiesRequest
from warehouse_msgs.srv import Forecast, ForecastRequest

BURST = 10_000  # messages
LOUD = {"/warehouse/events", "/warehouse/fleet", "/mov"}  # topics that get the burst
NUMBERS = (math.nan, math.inf, -math.inf, 1.7e308, -1.7e308, 1.0)
WHOLES = (min, max, lambda *_: 0, lambda *_: 1)  # of the smallest and the largest that there are
LENGTHS = (lambda _: 0, lambda _: 2, lambda place: place % 4)  # of an array, by its place
TEXTS = ("", "kiva1", "ä\u2028🤖" * 1000)
FLOAT32 = 3.4e38
# Time itself and the record of all nodes are no data of the warehouse.
SPARED_TOPICS = {"/clock", "/rosout", "/tf", "/tf_static"}
# What writes files, and what makes an empty floor of the warehouse.
SPARED_SERVICES = {"/gazebo/step", "/warehouse/checkpoint"}


class Filler:
    """Fills all fields of a message alike."""

    def __init__(self, number, whole, length, text):
        self._number, self._whole, self._length, self._text = number, whole, length, text

    def fill(self, message):
        fields = zip(message.__slots__, message._slot_types)
        for place, (name, kind) in enumerate(fields):
            setattr(message, name, self._value(kind, place))
        return message

    def _value(self, kind, place):
        base, _, size = kind.partition("[")
        if size:
            count = int(size[:-1]) if size != "]" else self._length(place)
            return [self._value(base, place) for _ in range(count)]
        if base in ("time", "duration"):
            value = abs(self._whole(0, 2**31 - 1))
            return rospy.Time(value) if base == "time" else rospy.Duration(value)
        if base == "string":
            return self._text
        if base == "bool":
            return bool(self._whole(0, 1))
        if base == "float64":
            return self._number
        if base == "float32":
            finite = math.isfinite(self._number)
            return max(-FLOAT32, min(FLOAT32, self._number)) if finite else self._number
        if "/" in base:
            return self.fill(roslib.message.get_message_class(base)())
        return self._whole(*limits(base))


def limits(kind):
    """The smallest and the largest number of a type."""
    bits = int(kind.strip("uint") or 8) if "int" in kind else 8
    return (0, 2**bits - 1) if kind[0] in "ubc" else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def malformed(kind):
    """Messages of a type, some of them sound."""
    for choice in itertools.product(NUMBERS, WHOLES, LENGTHS, TEXTS[:1]):
        yield Filler(*choice).fill(kind())
    for text in TEXTS[1:]:
        yield Filler(math.nan, max, LENGTHS[2], text).fill(kind())


def system_state():
    """{topic: nodes that publish}, {topic: nodes that subscribe}, {service: nodes}, but this."""
    services = rosgraph.Master("/test").getSystemState()
    mine = {rospy.get_name(), "/rosout"}
    return [{name: {*nodes} - mine for name, nodes in part if {*nodes} - mine} for part in services]


def pids():
    """The process of each node."""
    nodes = set().union(*(nodes for part in system_state() for nodes in part.values()))
    master = rosgraph.Master("/test")
    return {node: ServerProxy(master.lookupNode(node)).getPid("/test")[2] for node in nodes}


def paths():
    """Returns the paths that can be read over HTTP, of the first robot, unit, item and order."""
    about = json.loads(fetch("openapi.json")[1])["paths"]
    readable = [path for path, does in about.items() if "get" in does]
    pages = [page["path"].strip("/") for page in json.loads(fetch("pages")[1])]
    return [*pages, *(path[1:].replace("{number}", "1") for path in readable)]


class Malformed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dropped = []
        rospy.Subscriber("/rosout", Log, cls.hear)
        wait_until(lambda: fetch("api/v1/kpis")[0] == 200, "the shift's first figures")
        wait_until(lambda: fetch("api/v1/transports/1")[0] == 200, "a first transport")
        assert call("/warehouse/forecast", Forecast, ForecastRequest(minutes=1.0, runs=1)).accepted
        wait_until(lambda: fetch("api/v1/forecasts/1")[0] == 200, "a first forecast")
        cls.answers = cls.statuses()
        cls.pids = pids()
        assert cls.dropped == [], "what the nodes tell each other is sound"

    @classmethod
    def hear(cls, log):
        if "a message is dropped" in log.msg:
            cls.dropped.append(log.msg)

    @staticmethod
    def statuses():
        return {path: fetch(path)[0] for path in paths()}

    def tearDown(self):
        self.assertEqual(pids(), self.pids)
        wait_until(lambda: self.statuses() == self.answers, self.differences, 20)

    @property
    def differences(self):
        return {p: s for p, s in self.statuses().items() if s != self.answers[p]}

    def test_services(self):
        for name in sorted(set(system_state()[2]) - SPARED_SERVICES):
            kind = rosservice.get_service_class_by_name(name)
            if not kind._request_class.__slots__ or name.endswith("/set_logger_level"):
                continue
            service = rospy.ServiceProxy(name, kind, persistent=True)
            for request in malformed(kind._request_class):
                self.assertIsInstance(service(request), kind._response_class, name)
            service.close()
        physics = SetPhysicsPropertiesRequest(time_step=0.001, max_update_rate=2000)
        physics.gravity.z = -9.81
        self.assertTrue(
            call("/gazebo/set_physics_properties", SetPhysicsProperties, physics).success
        )

    def test_topics(self):
        published, subscribed, _ = system_state()
        for topic in sorted({*published, *subscribed} - SPARED_TOPICS):
            kind, _, _ = rostopic.get_topic_class(topic)
            publisher = rospy.Publisher(topic, kind, queue_size=0)  # waits until it is sent
            ears = len(subscribed.get(topic, ()))
            wait_until(lambda: publisher.get_num_connections() >= ears, f"ears at {topic}")  # noqa: B023
            messages = malformed(kind)
            if topic in LOUD or os.environ.get("BURST") == "all":
                messages = itertools.islice(itertools.cycle(messages), BURST)
            for message in messages:
                publisher.publish(message)
            publisher.unregister()


if __name__ == "__main__":
    rospy.init_node("test_malformed")
    rostest.rosrun("warehouse_tests", "malformed", __name__)
