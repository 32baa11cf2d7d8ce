# SPDX-License-Identifier: Apache-2.0
"""What the tests of the simulated world share: collect a topic, send commands, ask its services.

Everything waits for what it needs, with a deadline of wall time; nothing sleeps.
"""

import functools
import math
import re
import threading

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion
from rosgraph_msgs.msg import Log
from rostest_support.node_test import PATIENCE, call, comes_here, sends, wait_until
from std_srvs.srv import Empty

from gazebo_msgs.srv import DeleteModel, GetModelState, GetWorldProperties, SpawnModel
from warehouse_client import commands
from warehouse_msgs.msg import Event
from warehouse_msgs.srv import Step

COMMANDS = {f"/{topic}": kind for topic, kind in commands.COMMANDS.items()}
STEP = 0.001  # [s]
ANSWERS = (Event.ACCEPTED, Event.REFUSED)

BOX = """<sdf version="1.6"><model name="box"><static>true</static><link name="link">
  <collision name="body"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
</link></model></sdf>"""


class Collector:
    """Keeps all messages of a topic from the moment on when a publisher knows of it: a
    subscriber knows of a publisher before that."""

    def __init__(self, topic, kind, connected=True):
        self.topic, self.messages = topic, []
        self._came = threading.Condition()
        self._subscriber = rospy.Subscriber(topic, kind, self._keep, tcp_nodelay=True)
        if connected:
            wait_until(lambda: comes_here(topic), f"a publisher of {topic}")

    def _keep(self, message):
        with self._came:
            self.messages.append(message)
            self._came.notify_all()

    def wait_for(self, condition, patience=PATIENCE):
        """The list of all messages, once it meets the condition."""
        with self._came:
            met = self._came.wait_for(lambda: condition(self.messages), patience)
            assert met, f"{self.topic}: waited in vain; {self._seen()}"
            return list(self.messages)

    def first(self, condition=lambda message: True, patience=PATIENCE):
        """The first message, of those that came or will come, that meets the condition."""
        record = self.wait_for(lambda messages: any(map(condition, messages)), patience)
        return next(filter(condition, record))

    def next(self, number, patience=PATIENCE):
        """That many messages from now on."""
        self.clear()
        return self.wait_for(lambda messages: len(messages) >= number, patience)[:number]

    def clear(self):
        with self._came:
            self.messages.clear()

    def connections(self):
        """How many publishers it hears."""
        return self._subscriber.get_num_connections()

    def close(self):
        self._subscriber.unregister()

    def _seen(self):
        return f"{len(self.messages)} messages came, the last: {self.messages[-1:]}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


@functools.cache
def _rosout():
    # One subscription for all tests: after one that has ended the world would seem to send already.
    log = Collector("/rosout", Log)
    wait_until(lambda: sends("/gazebo", rospy.get_name(), "/rosout"), "the world's log")
    return log


def world_log():
    """A Collector of what the world logs from now on; the other nodes' records are among them."""
    log = _rosout()
    log.clear()
    return log


class Commander:
    """Sends commands, each to be answered, and hears the events."""

    def __init__(self):
        self.events = Collector("/warehouse/events", Event)
        self._publishers = {
            topic: rospy.Publisher(topic, kind, queue_size=0, tcp_nodelay=True)
            for topic, kind in COMMANDS.items()
        }
        for topic, publisher in self._publishers.items():
            wait_until(publisher.get_num_connections, f"the world's ear at {topic}")

    def send(self, topic, **fields):
        self._publishers[topic].publish(COMMANDS[topic](**fields))

    def ask(self, topic, **fields):
        """The answer to one command: an Event, ACCEPTED or REFUSED."""
        self.events.clear()
        self.send(topic, **fields)
        model = f"kiva{fields['kiva_id']}"
        return self.events.first(lambda e: e.kind in ANSWERS and e.model == model)

    def do(self, topic, **fields):
        """Sends a command that will be accepted; returns its events, the last DONE or BLOCKED."""
        answer = self.ask(topic, **fields)
        assert answer.kind == Event.ACCEPTED, f"{topic} {fields}: {answer.text}"
        ends = (Event.DONE, Event.BLOCKED)
        mine = lambda messages: [e for e in messages if e.model == answer.model]  # noqa: E731
        return mine(self.events.wait_for(lambda m: any(e.kind in ends for e in mine(m))))

    def close(self):
        self.events.close()
        for publisher in self._publishers.values():
            publisher.unregister()


def step(steps):
    """Steps a paused world; returns the answer."""
    answer = call("/gazebo/step", Step, steps)
    assert answer.success, answer.message
    return answer


def step_until(time):
    """Steps a paused world to that simulated time [s], however crowded the machine is."""
    step(max(0, round((time - sim_time()) / STEP)))


def waiting_commands():
    """How many commands have arrived and wait for the next step of a paused world."""
    return int(re.search(r"(\d+) commands wait", step(0).message)[1])


def pose(x=0.0, y=0.0, z=0.0, yaw=None):
    """A pose; without a yaw its quaternion is zeros, which means identity to the world."""
    turn = Quaternion() if yaw is None else Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
    return Pose(Point(x, y, z), turn)


def model_file(name):
    """SDF text that includes a model of worlds/models, for spawn()."""
    include = f"<include><uri>model://{name}</uri></include>"
    return f'<sdf version="1.6"><world name="w">{include}</world></sdf>'


def spawn(name, xml=BOX, where=None, frame=""):
    fields = {"model_name": name, "model_xml": xml, "reference_frame": frame}
    return call("/gazebo/spawn_sdf_model", SpawnModel, initial_pose=where or pose(), **fields)


def delete(name):
    return call("/gazebo/delete_model", DeleteModel, name)


def state(name, frame=""):
    return call("/gazebo/get_model_state", GetModelState, name, frame)


def place(name, frame=""):
    """Where a model is, as (x, y, z)."""
    answer = state(name, frame)
    assert answer.success, f"{name} in {frame}: {answer.status_message}"
    return answer.pose.position.x, answer.pose.position.y, answer.pose.position.z


def world():
    return call("/gazebo/get_world_properties", GetWorldProperties)


def sim_time():
    return world().sim_time


def control(name):
    """One of pause_physics, unpause_physics, reset_simulation, reset_world."""
    call(f"/gazebo/{name}", Empty)


class Paused:
    """Physics stands still within."""

    def __enter__(self):
        control("pause_physics")

    def __exit__(self, *_):
        control("unpause_physics")
