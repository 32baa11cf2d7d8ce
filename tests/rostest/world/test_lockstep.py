#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Time by the step, back and again; every run the same, and the same as without ROS."""

import unittest
from pathlib import Path

import rospy
import rostest
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from rospkg import get_ros_home
from rostest_support.node_test import call, latched, wait_until
from rostest_support.warehouse_test import (
    Collector,
    Commander,
    Paused,
    delete,
    place,
    sim_time,
    spawn,
    step,
    waiting_commands,
    world,
)
from std_msgs.msg import String

from kiva_plugin_cpp import World
from warehouse_msgs.msg import Event, KivaStatus, TrackedObjects
from warehouse_msgs.srv import Checkpoint, Undo

SECOND = 1000  # steps

# Topic and fields by the second in which they are sent.
COMMANDS = {
    0: [("/mov", {"kiva_id": 1, "x": 0, "y": 2}), ("/movy", {"kiva_id": 2, "distance": -2})],
    1: [("/rot", {"kiva_id": 3, "direction": 1}), ("/mov", {"kiva_id": 4, "x": 3, "y": -4})],
    4: [("/movx", {"kiva_id": 2, "distance": 3}), ("/movy", {"kiva_id": 3, "distance": 1})],
}


def save(name):
    return call("/warehouse/checkpoint", Checkpoint, name)


def restore(name):
    return call("/warehouse/restore", Checkpoint, name)


class Lockstep(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/warehouse/create_warehouse_models", 60)
        cls.commander = Commander()
        cls.hashes = Collector("/warehouse/state_hash", String)
        assert save("beginning").success

    def setUp(self):
        self.assertTrue(restore("beginning").success)

    def send(self, commands):
        for topic, fields in commands:
            self.commander.send(topic, **fields)
        wait_until(lambda: waiting_commands() == len(commands), "commands on their way")

    def play(self, seconds, begin=0):
        """The hashes of those seconds."""
        self.hashes.clear()
        for second in range(begin, begin + seconds):
            self.send(COMMANDS.get(second, []))
            step(SECOND)
        return [m.data for m in self.hashes.wait_for(lambda messages: len(messages) >= seconds)]

    def test_time_stands_still_between_steps(self):
        begin = sim_time()
        answer = step(500)
        self.assertAlmostEqual(answer.stamp.to_sec(), begin + 0.5)
        latched("/clock", Clock, lambda m: abs(m.clock.to_sec() - begin - 0.5) < 1e-6)
        self.assertAlmostEqual(sim_time(), begin + 0.5)

    def test_all_that_steps_publish_comes_without_another_step(self):
        begin = sim_time()
        # Not the clock: rospy itself listens to it, and lets all listeners of its process miss
        # what comes in one go but for the last.
        with Collector("/kiva1/odom", Odometry) as odometry:
            odometry.first()  # as newcomers get it
            odometry.clear()
            step(10 * SECOND)
            messages = odometry.wait_for(lambda messages: len(messages) >= 200)
        due = [begin + 0.05 * (i + 1) for i in range(200)]
        for message, time in zip(messages, due, strict=True):
            self.assertAlmostEqual(message.header.stamp.to_sec(), time)

    def test_a_world_that_is_paused_steps_too(self):
        with Paused():
            begin = sim_time()
            step(3)
            self.assertAlmostEqual(sim_time(), begin + 0.003)

    def test_commands_sent_before_a_step_are_answered_by_it(self):
        self.commander.events.clear()
        self.send([("/movx", {"kiva_id": 1, "distance": 1})])
        step(1)
        event = self.commander.events.first(lambda e: e.kind in (Event.ACCEPTED, Event.REFUSED))
        self.assertEqual((event.kind, event.model), (Event.ACCEPTED, "kiva1"))

    def test_every_run_is_the_same_and_the_same_as_without_ros(self):
        first = self.play(8)
        restore("beginning")
        self.assertEqual(self.play(8), first)
        self.assertEqual(self.without_ros(8), first)

    def without_ros(self, seconds):
        world = World.preset("small")
        world.checkpoint()  # as setUpClass does
        hashes = []
        for second in range(seconds):
            for topic, fields in sorted(COMMANDS.get(second, []), key=lambda c: c[1]["kiva_id"]):
                getattr(world, topic[1:])(**fields)
            world.step(SECOND)
            world.checkpoint()  # as autosave does
            hashes.append(f"{world.steps} {world.state_hash():016x}")
        return hashes

    def test_back_to_the_middle_of_a_move(self):
        self.play(2)
        moving = latched("/kiva4/status", KivaStatus)
        self.assertEqual(moving.status, KivaStatus.STATUS_BUSY)
        there = place("kiva4")
        self.assertTrue(save("moving").success)
        first = self.play(6, begin=2)
        self.assertTrue(restore("moving").success)
        self.assertAlmostEqual(sim_time(), 2.0)
        latched("/clock", Clock, lambda m: m.clock.to_sec() == 2.0)
        self.assertEqual(place("kiva4"), there)
        latched("/kiva4/status", KivaStatus, lambda m: m.status == KivaStatus.STATUS_BUSY)
        self.assertEqual(self.play(6, begin=2), first)

    def test_files_go_to_python_and_back(self):
        name = "lockstep_test.checkpoint"
        path = Path(get_ros_home()) / "warehouse" / "checkpoints" / name
        self.play(1)
        self.assertTrue(save(name).success)
        self.addCleanup(path.unlink)
        expected = self.play(1, begin=1)
        other = World()
        other.restore(path.read_bytes())
        for topic, fields in sorted(COMMANDS[1], key=lambda c: c[1]["kiva_id"]):
            getattr(other, topic[1:])(**fields)
        other.step(SECOND)
        self.assertEqual([f"{other.steps} {other.state_hash():016x}"], expected)
        path.write_bytes(other.checkpoint())
        self.assertTrue(restore(name).success)
        self.assertAlmostEqual(sim_time(), 2.0)

    def test_models_that_came_and_went_are_undone(self):
        names = world().model_names
        self.commander.events.clear()
        self.assertTrue(spawn("box").success)
        self.assertTrue(delete("kiva3").success)
        self.assertTrue(delete("storage_unit5").success)
        latched("/storage_units", TrackedObjects, lambda m: len(m.objects) == 23)
        self.assertTrue(restore("beginning").success)
        self.assertEqual(world().model_names, names)
        gone = self.commander.events.first(lambda e: e.kind == Event.DELETED and e.model == "box")
        self.assertIn("checkpoint", gone.text)
        self.commander.events.first(lambda e: e.kind == Event.SPAWNED and e.model == "kiva3")
        latched("/storage_units", TrackedObjects, lambda m: len(m.objects) == 24)
        latched("/items", TrackedObjects, lambda m: len(m.objects) == 96)
        latched("/kiva3/status", KivaStatus)
        self.send([("/rot", {"kiva_id": 3, "direction": 1})])
        step(SECOND)
        self.commander.events.first(lambda e: e.kind == Event.DONE and e.model == "kiva3")

    def test_undo(self):
        self.play(5)
        expected = self.play(1, begin=5)
        answer = call("/warehouse/undo", Undo, 2.5)
        self.assertTrue(answer.success, answer.message)
        self.assertAlmostEqual(answer.stamp.to_sec(), 3.0)
        self.assertAlmostEqual(sim_time(), 3.0)
        self.assertEqual(self.play(3, begin=3)[-1:], expected)

    def refused(self, answer, *texts):
        self.assertFalse(answer.success)
        for text in texts:
            self.assertIn(text, answer.message)

    def test_what_cannot_be_is_refused_with_its_reason(self):
        begin = sim_time()
        self.refused(restore("nothing"), "no checkpoint 'nothing'", "beginning")
        self.refused(restore(""), "name")
        self.refused(save(""), "name")
        self.refused(save("/nowhere/at/all"), "'/nowhere/at/all' is not a name")
        self.refused(restore("/proc/self/status"), "is not a name")
        self.refused(restore("none.checkpoint"), "warehouse/checkpoints/none.checkpoint")
        self.refused(call("/warehouse/undo", Undo, 1e6), "oldest")
        self.refused(call("/warehouse/undo", Undo, -1.0), "0 or more")
        self.refused(call("/warehouse/undo", Undo, float("nan")), "0 or more")
        self.assertEqual(sim_time(), begin)


if __name__ == "__main__":
    rospy.init_node("test_lockstep")
    rostest.rosrun("warehouse_tests", "lockstep", __name__)
