# SPDX-License-Identifier: Apache-2.0
"""What the tests of the warehouse's nodes share: wait for a topic, command a robot, ask a service.

Everything waits for what it needs, with a deadline of wall time; nothing sleeps.
"""

import os
import signal
import subprocess
import threading
import time
from xmlrpc.client import ServerProxy

import rosgraph
import rospy

from warehouse_client.commands import COMMANDS
from warehouse_msgs.msg import Event, KivaStatus
from warehouse_msgs.srv import CreateWarehouse

PATIENCE = 60.0  # [s, wall]
START = rospy.Time(0)


class Listener:
    """Keeps the messages of a topic; until() waits for the right one."""

    def __init__(self, topic, kind):
        self.topic, self.messages = topic, []
        self._came = threading.Condition()
        self._subscriber = rospy.Subscriber(topic, kind, self._keep, queue_size=1000)

    def _keep(self, message):
        with self._came:
            self.messages.append(message)
            self._came.notify_all()

    def until(self, condition=lambda message: True):
        """The newest message if it meets the condition, or the first to come that does."""
        end = time.monotonic() + PATIENCE
        with self._came:
            while not (self.messages and condition(self.messages[-1])):
                left = end - time.monotonic()
                if left <= 0:
                    last = self.messages[-1] if self.messages else "nothing"
                    raise AssertionError(f"{self.topic}: not what was waited for: {last}")
                self._came.wait(left)
            return self.messages[-1]

    def connections(self):
        """How many publishers it hears."""
        return self._subscriber.get_num_connections()

    def close(self):
        self._subscriber.unregister()


def latched(topic, kind, condition=lambda message: True):
    """The message that a newcomer gets, once it meets the condition."""
    listener = Listener(topic, kind)
    try:
        return listener.until(condition)
    finally:
        listener.close()


def wait_until(condition, what, patience=PATIENCE):
    """Until condition() holds, where nothing is published that one could wait for."""
    end = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < end, f"waited in vain: {what}"
        threading.Event().wait(0.05)


def pid(node):
    """Process of a node; None while it is not there."""
    try:
        address = rosgraph.Master("/test").lookupNode(node)
        return ServerProxy(address).getPid("/test")[2]
    except (rosgraph.MasterException, OSError):
        return None


def sends(publisher, subscriber, topic):
    """Whether what one node publishes on a topic from now on goes to another, by what the first
    knows; a subscriber believes so a moment before."""
    try:
        address = rosgraph.Master("/test").lookupNode(publisher)
        rows = ServerProxy(address).getBusInfo("/test")[2]
    except (rosgraph.MasterException, OSError):
        return False
    return any((to, way, name) == (subscriber, "o", topic) for _, to, way, _, name, *_ in rows)


def comes_here(topic):
    """Whether what some node publishes on a topic from now on goes to this one."""
    topic = rospy.resolve_name(topic)
    publishers = dict(rosgraph.Master("/test").getSystemState()[0]).get(topic, [])
    return any(sends(publisher, rospy.get_name(), topic) for publisher in publishers)


def kill(node, meanwhile=lambda: None):
    """Kills a node without a chance to say goodbye, and waits for the next of that name. What is
    done meanwhile it does not see."""
    before = pid(node)
    os.kill(before, signal.SIGSTOP)
    meanwhile()
    os.kill(before, signal.SIGKILL)
    wait_until(lambda: pid(node) not in (None, before), f"{node} comes back")


def call(name, kind, *args, **fields):
    """The answer of a service, once it is there."""
    rospy.wait_for_service(name, PATIENCE)
    return rospy.ServiceProxy(name, kind)(*args, **fields)


def create(name="", **fields):
    """The answer of /warehouse/create_warehouse_models."""
    service = "/warehouse/create_warehouse_models"
    return call(service, CreateWarehouse, warehouse_name=name, **fields)


def run(node, *args):
    """(exit code, what it prints) of a node of warehouse_sim that ends by itself."""
    done = subprocess.run(
        ["rosrun", "warehouse_sim", node, *args],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=150,
        check=False,
    )
    return done.returncode, done.stdout


class Robot:
    """Commands one robot, each command after the one before has ended."""

    def __init__(self, number):
        self._number, self._publishers = number, {}
        self._events = Listener("warehouse/events", Event)
        self._status = Listener(f"kiva{number}/status", KivaStatus)

    def do(self, topic, **fields):
        """The command's last Event; it is DONE."""
        if topic not in self._publishers:
            self._publishers[topic] = rospy.Publisher(topic, COMMANDS[topic], queue_size=1)
        publisher, before = self._publishers[topic], len(self._events.messages)
        wait_until(publisher.get_num_connections, f"a subscriber of {topic}")
        wait_until(self._events.connections, "the publisher of events")
        self._wait_for_idle()
        publisher.publish(kiva_id=self._number, **fields)
        wait_until(lambda: self._ends(before), f"the end of {topic} {fields}")
        end = self._ends(before)[0]
        assert end.kind == Event.DONE, f"{topic} {fields}: {end.text}"
        self._wait_for_idle(end.header.stamp)
        return end

    def _ends(self, before):
        kinds, name = (Event.DONE, Event.BLOCKED, Event.REFUSED), f"kiva{self._number}"
        messages = self._events.messages[before:]
        return [event for event in messages if event.model == name and event.kind in kinds]

    def _wait_for_idle(self, since=START):
        self._status.until(lambda s: s.status == KivaStatus.STATUS_IDLE and s.header.stamp >= since)
