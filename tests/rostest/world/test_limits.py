#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What one client asks for keeps the world from no other client, and never for good."""

import os
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import rospy
import rostest
from geometry_msgs.msg import Pose
from rosgraph_msgs.msg import Clock
from rostest_support.node_test import PATIENCE, call, wait_until
from rostest_support.warehouse_test import (
    ANSWERS,
    BOX,
    Collector,
    Commander,
    Paused,
    control,
    spawn,
    state,
    world,
)
from rostest_support.world_node import Node

from gazebo_msgs.srv import SetLinkProperties, SpawnModel
from warehouse_msgs.msg import Event, MoveAlong
from warehouse_msgs.srv import Checkpoint, Step, Undo

FOR_EVER = 100_000_000  # steps
SIGINT_TIMEOUT = 3.0  # [s] until roslaunch would kill it


def ask_for_steps(number):
    """Clients of their own that each wait for FOR_EVER steps, as processes. The client gives up
    where the master still names the service of a world before this one."""
    rospy.wait_for_service("/gazebo/step", PATIENCE)
    client = ["rosservice", "call", "/gazebo/step", str(FOR_EVER)]
    return [subprocess.Popen(client, stdout=subprocess.DEVNULL) for _ in range(number)]


def save(name):
    return call("/warehouse/checkpoint", Checkpoint, name)


def restore(name):
    return call("/warehouse/restore", Checkpoint, name)


class LongCalls(unittest.TestCase):
    """A client asks for more steps than there is time for."""

    def stepping(self, clients):
        wait_until(lambda: world().sim_time > 0, "the first steps")
        self.addCleanup(lambda: [(client.kill(), client.wait()) for client in clients])

    def test_all_others_are_answered_meanwhile(self):
        with Node(world="paper", lockstep=True) as node:
            self.stepping(ask_for_steps(6))
            commander = Commander()
            self.assertEqual(commander.ask("/rot", kiva_id=1, direction=1).kind, Event.ACCEPTED)
            self.assertTrue(spawn("box").success)
            self.assertTrue(save("here").success)
            self.assertIn("box", world().model_names)
            commander.close()
            begin = time.monotonic()
            node.send(signal.SIGINT)
            code, said = node.end()
            self.assertLess(time.monotonic() - begin, SIGINT_TIMEOUT)
            self.assertEqual(code, 0, said)

    def test_steps_end_when_nobody_waits_for_them(self):
        with Node(world="paper", lockstep=True):
            clients = ask_for_steps(3)
            self.stepping(clients)
            for client in clients:
                client.kill()
                client.wait()
            answer = call("/gazebo/step", Step, 0)  # once all others have ended
            self.assertTrue(answer.success)
            self.assertAlmostEqual(world().sim_time, answer.stamp.to_sec())

    def test_a_connection_that_stays_open_takes_several_calls(self):
        with Node(world="paper", lockstep=True):
            rospy.wait_for_service("/gazebo/step", PATIENCE)
            step = rospy.ServiceProxy("/gazebo/step", Step, persistent=True)
            for _ in range(5):
                self.assertTrue(step(10).success)
            self.assertAlmostEqual(world().sim_time, 0.05)

    def test_each_clock_is_sent_once(self):
        with Node(world="paper", lockstep=True), Collector("/clock", Clock) as clocks:
            for _ in range(3):
                call("/gazebo/step", Step, 100)
            call("/gazebo/step", Step, 5)
            last = lambda messages: messages and messages[-1].clock.to_sec() == 0.305  # noqa: E731
            times = [m.clock.to_nsec() // 1_000_000 for m in clocks.wait_for(last)]
        self.assertEqual([t for t in times if t > 0], [*range(10, 301, 10), 305])


class Floods(unittest.TestCase):
    def test_every_command_is_answered_however_many_wait(self):
        number = 50_000
        with Node(world="paper"):
            answers, lock = [0], threading.Lock()

            def count(event):
                with lock:
                    answers[0] += event.kind in ANSWERS

            hears = rospy.Subscriber("/warehouse/events", Event, count)
            sender = rospy.Publisher("/movx", MoveAlong, queue_size=0)
            wait_until(sender.get_num_connections, "the world's ear")
            wait_until(hears.get_num_connections, "the world's events")
            with Paused():
                command = MoveAlong(kiva_id=77, distance=1.0)
                for _ in range(number):
                    sender.publish(command)
            wait_until(lambda: answers[0] >= number, "an answer to each", 3 * PATIENCE)
            self.assertEqual(answers[0], number)
            hears.unregister()
            sender.unregister()


class Documents(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.node = Node(world="paper")

    @classmethod
    def tearDownClass(cls):
        cls.node.__exit__()

    def test_a_document_of_many_megabytes_is_not_even_parsed(self):
        huge = BOX + "<!--" + "x" * 11_000_000 + "-->"
        for service in ("spawn_sdf_model", "spawn_urdf_model"):
            answer = call(f"/gazebo/{service}", SpawnModel, "box", huge, "", Pose(), "")
            self.assertFalse(answer.success)
            self.assertIn("at most 10000000", answer.status_message)

    def test_a_mass_with_which_nothing_can_be_computed_is_refused(self):
        falling = BOX.replace("<static>true</static>", "")
        self.assertTrue(spawn("heavy", falling).success)
        fields = {"link_name": "heavy::link", "ixx": 1, "iyy": 1, "izz": 1, "gravity_mode": True}
        for wrong in ({"mass": 1e308}, {"mass": 1, "ixx": 1e308}, {"mass": float("nan")}):
            answer = call("/gazebo/set_link_properties", SetLinkProperties, **{**fields, **wrong})
            self.assertFalse(answer.success)
            self.assertIn("at most", answer.status_message)
        self.assertTrue(state("heavy").success)


class Checkpoints(unittest.TestCase):
    """Files in a folder of their own, with little room."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.outside = Path(folder.name)
        self.folder = self.outside / "checkpoints"
        self.start(checkpoint_folder=str(self.folder))

    def start(self, **parameters):
        node = Node(world="paper", **parameters)
        self.addCleanup(node.__exit__)
        rospy.wait_for_service("/warehouse/undo", PATIENCE)

    def refused(self, answer, text):
        self.assertFalse(answer.success)
        self.assertIn(text, answer.message)

    def test_only_names_in_the_folder_are_written_and_read(self):
        for name in ("/etc/passwd", "../up.checkpoint", "a/b.checkpoint", ".hidden.checkpoint", "",
                     "x" * 101, "a\nb"):  # fmt: skip
            self.refused(save(name), "is not a name")
            self.refused(restore(name), "is not a name")
        self.assertEqual([p.name for p in self.outside.rglob("*") if p.is_file()], [])
        self.assertTrue(save("mine.checkpoint").success)
        self.assertTrue(restore("mine.checkpoint").success)
        self.assertEqual([p.name for p in self.outside.rglob("*") if p.is_file()],
                         ["mine.checkpoint"])  # fmt: skip

    def test_only_regular_files_are_read(self):
        self.folder.mkdir()
        os.mkfifo(self.folder / "fifo.checkpoint")
        (self.folder / "link.checkpoint").symlink_to("/dev/zero")
        (self.folder / "folder.checkpoint").mkdir()
        for name in ("fifo", "link", "folder", "none"):
            self.refused(restore(f"{name}.checkpoint"), "there is no checkpoint")
        with open(self.folder / "huge.checkpoint", "wb") as file:
            file.truncate(10**12)
        self.refused(restore("huge.checkpoint"), "no room for 1000000000000 bytes")
        (self.folder / "text.checkpoint").write_text("no checkpoint")
        self.refused(restore("text.checkpoint"), "not a checkpoint")


class LittleRoom(Checkpoints):
    def start(self, **parameters):
        super().start(checkpoint_limit=0.1, autosave=1000, lockstep=True, **parameters)

    def test_checkpoints_are_weighed(self):
        size = int(save("one").message.split()[1])
        fitting = 100_000 // size
        self.assertGreater(fitting, 1)
        for i in range(fitting):
            self.assertTrue(save("one").success, "another of the same name takes its place")
            self.assertTrue(save(f"{i}.checkpoint").success)
        for i in range(fitting - 1):
            self.assertTrue(save(f"more{i}").success)
        self.refused(save("one too many"), f"no room for {size} bytes")
        self.refused(save("too_many.checkpoint"), f"no room for {size} bytes")
        for _ in range(fitting + 3):
            call("/gazebo/step", Step, 1000)
        self.refused(call("/warehouse/undo", Undo, 1e6), "the oldest of ")


class FullDisk(unittest.TestCase):
    def test_a_checkpoint_that_fails_leaves_nothing(self):
        with (
            tempfile.TemporaryDirectory() as folder,
            Node(world="paper", most_bytes=1000, checkpoint_folder=folder),
        ):
            answer = save("mine.checkpoint")
            self.assertFalse(answer.success)
            self.assertIn("can't write", answer.message)
            self.assertEqual(list(Path(folder).iterdir()), [])


class Resets(unittest.TestCase):
    def test_a_reset_can_be_undone(self):
        with Node(world="paper", lockstep=True):
            self.assertFalse(call("/warehouse/undo", Undo, 0).success)
            commander = Commander()
            commander.send("/rot", kiva_id=1, direction=1)
            wait_until(lambda: " 1 commands" in call("/gazebo/step", Step, 0).message, "a command")
            call("/gazebo/step", Step, 2000)
            before = state("kiva1").pose
            for kind in ("reset_simulation", "reset_world"):
                control(kind)
                self.assertNotEqual(state("kiva1").pose, before)
                answer = call("/warehouse/undo", Undo, 0)
                self.assertTrue(answer.success, answer.message)
                self.assertAlmostEqual(answer.stamp.to_sec(), 2.0)
                self.assertEqual(state("kiva1").pose, before)
            commander.close()

    def test_a_command_that_no_step_came_for_is_refused(self):
        with Node(world="paper"), Paused():
            commander = Commander()
            self.assertTrue(save("here").success)
            ways = {
                "was reset": lambda: control("reset_world"),
                "went back": lambda: restore("here"),
            }
            for reason, act in ways.items():
                commander.events.clear()
                commander.send("/rot", kiva_id=1, direction=1)
                wait_until(lambda: " 1 commands" in call("/gazebo/step", Step, 0).message, "it")
                act()
                event = commander.events.first(lambda e: e.kind in ANSWERS)
                self.assertEqual((event.kind, event.model), (Event.REFUSED, "kiva1"))
                self.assertIn(reason, event.text)
            commander.close()


if __name__ == "__main__":
    rospy.init_node("test_limits", disable_signals=True)
    rostest.rosrun("warehouse_tests", "limits", __name__)
