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

from warehouse_msgs.msg import Event
from warehouse_msgs.srv import CreateWarehouse
from warehouse_sim.script_executor import ScriptExecutor, command

PATIENCE = 60.0  # [s, wall]


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
        self.number = number
        self._executor = ScriptExecutor(rospy, lambda *_: None, PATIENCE)
        self._executor.watch(number)

    def do(self, topic, **fields):
        """The command's last Event; it is DONE."""
        script = self._script(command(topic, self.number, **fields))
        self._executor.play({self.number: script})

    def _script(self, commands):
        event = yield commands
        assert event.kind == Event.DONE, f"{commands}: {event.text}"
