#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Whatever the fields of a call or a message hold, there is an answer, and the world goes on."""

import math
import os
import random
import unittest

import rosgraph
import roslib.message
import rospy
import rosservice
import rostest
import rostopic
from rostest_support.node_test import wait_until
from rostest_support.warehouse_test import BOX, delete, pose, sim_time, spawn, world

SEED = 1
CALLS = 60  # of each service, and messages on each topic
NUMBERS = (0.0, -0.0, 1.0, -1.0, math.nan, math.inf, -math.inf, 1e308, -1e308, 1e-308, 1e17)
NAMES = (
    "",
    " ",
    "kiva1",
    "kiva1::chassis",
    "box1",
    "box1::link",
    "::",
    "kiva1::",
    "::chassis",
    "nothing",
    "world",
    "/map",
    "left_wheel_joint",
    "kiva1::tower_joint",
    "sun",
    "ä\u2028🤖",
    "%s%n%d",
    "../../etc/passwd",
    "x" * 10000,
    "a::" * 1000,
    "\x00\x01",
)
TEXTS = (
    BOX,
    "<sdf",
    "<sdf version='1.6'/>",
    "<robot name='r'/>",
    "<robot name='r'><link name='l'/></robot>",
    "<?xml version='1.0'?>" + BOX,
    BOX.replace("0.2", "nan"),
    BOX.replace("0.2", "1e308"),
    BOX.replace("link", ""),
    "<a>" * 20000,
)
# What stops the world or takes it away is left to other tests.
# Steps are made, however many; checkpoints are written to wherever they are asked for.
SPARED = {
    "/gazebo/set_logger_level",
    "/gazebo/get_loggers",
    "/gazebo/step",
    "/warehouse/checkpoint",
}


class Fuzzer:
    """Fills messages with what programs seldom send."""

    def __init__(self, seed):
        self._random = random.Random(seed)

    def fill(self, message):
        for name, kind in zip(message.__slots__, message._slot_types):
            setattr(message, name, self._value(name, kind, getattr(message, name)))
        return message

    def _value(self, name, kind, default):
        if kind.endswith("]"):
            inner = kind[: kind.index("[")]
            size = kind[kind.index("[") + 1 : -1]
            count = int(size) if size else self._random.choice((0, 1, 2, 7, 30))
            return [self._value(name, inner, None) for _ in range(count)]
        if kind in ("time", "duration"):
            return self._time(kind)
        if kind == "string":
            return self._random.choice(TEXTS if name == "model_xml" else NAMES)
        if kind == "bool":
            return self._random.random() < 0.5
        if kind in ("float64", "float32"):
            value = self._random.choice((*NUMBERS, self._random.uniform(-10, 10)))
            too_large = kind == "float32" and math.isfinite(value) and abs(value) > 3e38
            return 3e38 if too_large else value
        if "/" not in kind and "int" in kind or kind in ("byte", "char"):
            return self._whole(kind)
        if default is None:
            default = roslib.message.get_message_class(kind)()
        return self.fill(default)

    def _time(self, kind):
        seconds = self._random.choice((0, 1, 100, 2**31 - 1))
        if kind == "time":
            return rospy.Time(seconds, self._random.choice((0, 999999999)))
        return rospy.Duration(seconds * self._random.choice((1, -1)), 0)

    def _whole(self, kind):
        bits = int(kind.strip("uint") or 8) if "int" in kind else 8
        low, high = (
            (0, 2**bits - 1) if kind.startswith("u") else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
        )
        return self._random.choice((0, 1, low, high))


def memory_of_the_world():
    """Resident memory [kB]."""
    pid = int(rosnode_pid())
    with open(f"/proc/{pid}/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


def rosnode_pid():
    uri = rosgraph.Master("/test").lookupNode("/gazebo")
    code, message, pid = rospy.core.xmlrpcapi(uri).getPid("/test")
    assert code == 1, message
    return pid


def calls(kind, most=CALLS):
    """How often a service is called: one whose request has no fields answers the same each time."""
    return most if kind._request_class.__slots__ else 1


def services():
    names = rosservice.get_service_list(node="/gazebo")
    return sorted(set(names) - SPARED)


class Fuzz(unittest.TestCase):
    def setUp(self):
        self.fuzzer = Fuzzer(SEED)
        for name in ("kiva1", "box1"):
            if name not in world().model_names:
                model = '<sdf version="1.6"><world name="w"><include><uri>model://kiva</uri></include></world></sdf>'
                spawn(name, model if name == "kiva1" else BOX, pose(3.0))

    def tearDown(self):
        for name in world().model_names:
            if name != "ground_plane":
                delete(name)

    def goes_on(self):
        rospy.ServiceProxy("/gazebo/unpause_physics", self.kind("/gazebo/unpause_physics"))()
        self.set_back()
        before = sim_time()
        wait_until(lambda: sim_time() != before, "time going on")

    def set_back(self):
        """A fuzzed physics may creep: a step of a nanosecond, or one a day."""
        kind = self.kind("/gazebo/set_physics_properties")
        request = kind._request_class(time_step=0.001, max_update_rate=0.0)
        request.gravity.z = -9.81
        assert rospy.ServiceProxy("/gazebo/set_physics_properties", kind)(request).success

    @staticmethod
    def kind(service):
        return rosservice.get_service_class_by_name(service)

    def test_every_service_answers_every_call(self):
        names = services()
        self.assertGreater(len(names), 25)
        for name in names:
            kind = self.kind(name)
            proxy = rospy.ServiceProxy(name, kind, persistent=True)
            for _ in range(calls(kind)):
                request = self.fuzzer.fill(kind._request_class())
                answer = proxy(request)
                self.assertIsInstance(answer, kind._response_class, name)
            proxy.close()
            self.goes_on()

    def test_every_topic_takes_every_message(self):
        topics = [
            t for t, nodes in rosgraph.Master("/test").getSystemState()[1] if "/gazebo" in nodes
        ]
        for topic in topics:
            if topic == "/clock":
                continue
            kind, _, _ = rostopic.get_topic_class(topic)
            publisher = rospy.Publisher(topic, kind, queue_size=CALLS)
            wait_until(publisher.get_num_connections, f"an ear at {topic}")
            for _ in range(CALLS):
                publisher.publish(self.fuzzer.fill(kind()))
            self.goes_on()
            publisher.unregister()

    def test_memory_stays_where_it_was(self):
        def call_all():
            for name in services():
                kind = self.kind(name)
                proxy = rospy.ServiceProxy(name, kind, persistent=True)
                for _ in range(calls(kind, 20)):
                    proxy(self.fuzzer.fill(kind._request_class()))
                proxy.close()

        call_all()
        before = memory_of_the_world()
        for _ in range(3):
            call_all()
        self.goes_on()
        self.assertLess(memory_of_the_world() - before, 20000)


if __name__ == "__main__":
    rospy.init_node("test_gazebo_fuzz")
    rostest.rosrun("warehouse_tests", "gazebo_fuzz", __name__)
