#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Two warehouses at one master, each in its namespace: neither sees the other."""

import os
import subprocess
import unittest

import rosgraph
import rospy
import rostest
from rosgraph_msgs.msg import Clock
from rostest_support.node_test import PATIENCE, Listener, call, latched, sends, wait_until
from std_srvs.srv import Empty

from gazebo_msgs.srv import GetWorldProperties
from warehouse_msgs.msg import (
    CoordinatorState,
    Event,
    KivaStatus,
    Rotate,
    TrackedObjects,
    TransportEvent,
    WarehouseState,
)
from warehouse_msgs.srv import Transport

BOTH = ("/sim1", "/sim2")
# What the master, roslaunch and rospy bring along.
SHARED = ("/rosout", "/roslaunch", "/run_id", "/rosdistro", "/rosversion", "/use_sim_time")


def ready(namespace):
    """Waits until a warehouse stands there whose coordinator has its robots."""
    latched(f"{namespace}/warehouse/state", WarehouseState, lambda m: len(m.kivas) == 4)
    latched(f"{namespace}/warehouse/coordinator", CoordinatorState, lambda m: m.automatic == 4)


def strangers(names):
    """The names that lie in neither namespace."""
    known = ("/sim1/", "/sim2/", *SHARED, rospy.get_name())
    return [name for name in names if not name.startswith(known)]


def launch(*args):
    """(exit code, what it says) of a launch at the same master."""
    done = subprocess.run(
        ["roslaunch", "warehouse_sim", "warehouse.launch", "viewer:=false", *args],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


class Namespaces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for namespace in BOTH:
            ready(namespace)

    def test_nothing_lies_outside(self):
        published, subscribed, services = rosgraph.Master("/test").getSystemState()
        heard = [name for name, nodes in subscribed if set(nodes) != {rospy.get_name()}]
        self.assertEqual(strangers(heard), [])
        self.assertEqual(strangers(name for name, _ in published), [])
        self.assertEqual(strangers(name for name, _ in services), [])
        self.assertEqual(strangers(rosgraph.Master("/test").getParamNames()), [])

    def test_a_robot_that_is_driven_in_one_stays_in_the_other(self):
        here, there = (Listener(f"{n}/kiva1/status", KivaStatus) for n in BOTH)
        before = [listener.until().pose.theta for listener in (here, there)]
        listeners = [Listener(f"{namespace}/warehouse/events", Event) for namespace in BOTH]
        topic = rospy.Publisher("/sim1/rot", Rotate, queue_size=1)
        wait_until(lambda: topic.get_num_connections() == 1, "the world of /sim1 listens alone")
        wait_until(
            lambda: all(listener.connections() for listener in listeners), "both worlds tell events"
        )
        topic.publish(Rotate.COUNTERCLOCKWISE, 1)
        listeners[0].until(lambda event: (event.kind, event.model) == (Event.DONE, "kiva1"))
        turned = here.until(lambda m: m.state == KivaStatus.IDLE and m.pose.theta != before[0])
        self.assertNotAlmostEqual(turned.pose.theta, before[0], 1)
        later = turned.header.stamp
        still = there.until(lambda m: m.header.stamp > later)
        self.assertEqual(still.pose.theta, before[1])
        self.assertNotIn("kiva1", {event.model for event in listeners[1].messages})

    def test_each_is_tracked_and_at_work_while_the_other_stands_still(self):
        for here, there in (BOTH, reversed(BOTH)):
            call(f"{there}/gazebo/pause_physics", Empty)
            at = call(f"{there}/gazebo/get_world_properties", GetWorldProperties).sim_time
            transports = Listener(f"{here}/warehouse/transports", TransportEvent)
            units = Listener(f"{here}/storage_units", TrackedObjects)
            wait_until(transports.connections, "the coordinator tells of transports")
            answer = call(f"{here}/warehouse/transport", Transport, shelf_id=1, station="pick1")
            self.assertTrue(answer.accepted, answer.message)
            transports.until(lambda event: event.kind == TransportEvent.LIFTED)
            units.until(lambda m: any(unit.carrier for unit in m.objects))
            self.assertEqual(len(latched(f"{here}/items", TrackedObjects).objects), 96)
            clock = latched(f"{here}/clock", Clock)
            self.assertGreater(clock.clock.to_sec(), 0)
            after = call(f"{there}/gazebo/get_world_properties", GetWorldProperties).sim_time
            self.assertEqual(after, at)
            call(f"{there}/gazebo/unpause_physics", Empty)

    def test_programs_follow_the_namespace(self):
        command = ["rosrun", "warehouse_sim", "events", "kiva2"]
        process = subprocess.Popen(
            command, env=os.environ | {"ROS_NAMESPACE": "/sim2"}, stdout=subprocess.PIPE, text=True
        )
        topics = [rospy.Publisher(f"{n}/rot", Rotate, queue_size=1) for n in BOTH]

        def hears():
            topic = "/sim2/warehouse/events"
            subscribers = dict(rosgraph.Master("/test").getSystemState()[1]).get(topic, [])
            programs = [node for node in subscribers if node.startswith("/sim2/events")]
            return any(sends("/sim2/gazebo", program, topic) for program in programs)

        wait_until(hears, "the program hears the events of /sim2")
        wait_until(lambda: all(t.get_num_connections() for t in topics), "both worlds listen")
        topics[1].publish(Rotate.COUNTERCLOCKWISE, 2)
        line = process.stdout.readline()
        process.terminate()
        process.wait(PATIENCE)
        self.assertRegex(line, "kiva2 +(ACCEPTED|REFUSED)")

    def test_a_second_one_in_a_namespace_is_refused(self):
        code, said = launch("__ns:=sim1")
        self.assertNotEqual(code, 0, said)
        self.assertIn("in /sim1 already; nothing was started", said)
        self.assertIn("rostopic echo /sim1/warehouse/events", said)


if __name__ == "__main__":
    rospy.init_node("test_namespaces")
    rostest.rosrun("warehouse_tests", "namespaces", Namespaces)
