#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What is recorded runs again, step by step the same; what was changed is found."""

import random
import re
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import rosbag
import rospy
import rostest
from geometry_msgs.msg import Twist, Vector3
from rostest_support.node_test import PATIENCE, call, wait_until
from rostest_support.warehouse_test import (
    Collector,
    Commander,
    delete,
    model_file,
    pose,
    sim_time,
    spawn,
)
from rostest_support.world_node import Node

from gazebo_msgs.srv import SpawnModel
from warehouse_msgs.msg import FleetState
from warehouse_msgs.srv import Checkpoint

ROVER = (Path(__file__).parents[2] / "worlds" / "rover.urdf").read_text()


class Recording(unittest.TestCase):
    """One recording for all: two robots that meet, one that comes later and is then the shadow of
    one elsewhere, a box, a checkpoint."""

    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.bag = str(Path(cls._folder.name) / "run.bag")
        with Node(world="paper", rtf=0, record=cls.bag, autosave=3) as node:
            commander = Commander()
            # A command before the first step is part of the first keyframe, and no message.
            wait_until(lambda: sim_time() > 0, "the first step")
            commander.do("/movx", kiva_id=1, distance=1)
            spawn("box", where=pose(0.0, 8.0))
            spawn("kiva9", model_file("kiva"), pose(-3.0, 9.0))
            commander.do("/rot", kiva_id=9, direction=1)
            commander.do("/movx", kiva_id=1, distance=-1)
            delete("box")
            cls.show_elsewhere(9, [(-2.75, 9.05), (-2.5, 9.1), (-2.0, 9.2)])
            call("/warehouse/checkpoint", Checkpoint, "here")
            commander.do("/rot", kiva_id=2, direction=-1)
            call("/warehouse/restore", Checkpoint, "here")
            commander.do("/rot", kiva_id=2, direction=1)
            end = sim_time() + 2
            wait_until(lambda: sim_time() > end, "time going on")
            commander.close()
            node.send(signal.SIGINT)
            code, said = node.end()
            assert code == 0, said

    @classmethod
    def show_elsewhere(cls, kiva, places):
        """Tells where a robot is of which the world has the shadow, place after place. It must
        not stand at the first one yet: of messages within a step the world takes the newest."""
        publisher = rospy.Publisher("/warehouse/shadows", FleetState, queue_size=1)
        wait_until(publisher.get_num_connections, "the world to take shadows")
        fleet = Collector("/warehouse/fleet", FleetState)
        for x, y in places:
            publisher.publish(FleetState(kiva_id=[kiva], x=[x], y=[y], yaw=[0.0]))
            fleet.first(lambda m: (m.x[2], m.y[2]) == (x, y), PATIENCE)  # noqa: B023

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def replay(self, bag):
        """Its return code and what it said, once it has come to its end."""
        with Node(rtf=0, replay=bag) as node:
            node.says("replayed ", "FATAL")
            node.send(signal.SIGINT)
            return node.end()

    def changed(self, change):
        """The recording, each message as change(topic, message) returns it; None leaves it out."""
        path = str(Path(self._folder.name) / "changed.bag")
        with rosbag.Bag(self.bag) as old, rosbag.Bag(path, "w") as new:
            for topic, message, time in old.read_messages():
                if (changed := change(topic, message)) is not None:
                    new.write(topic, changed, time)
        return path

    def test_it_is_an_ordinary_bag(self):
        with rosbag.Bag(self.bag) as bag:
            topics = bag.get_type_and_topic_info().topics
            self.assertEqual(topics["/movx"].message_count, 2)
            self.assertEqual(topics["/warehouse/shadows"].message_count, 3)
            self.assertEqual(topics["/rot"].msg_type, "warehouse_msgs/Rotate")
            self.assertEqual(topics["/warehouse/state_hash"].msg_type, "std_msgs/String")
            (_, last, _) = list(bag.read_messages(["/tf"]))[-1]
            self.assertEqual(
                [t.child_frame_id for t in last.transforms],
                ["kiva1/base_link", "kiva2/base_link", "kiva9/base_link"],
            )
            hashes = [m.data for _, m, _ in bag.read_messages(["/warehouse/state_hash"])]
        for line in hashes:
            self.assertRegex(line, r"^\d+ [0-9a-f]{16}$")

    def test_it_runs_again_the_same(self):
        code, said = self.replay(self.bag)
        self.assertEqual(code, 0, said)
        steps, hashes = re.search(r"replayed (\d+) steps, and all (\d+) hashes", said).groups()
        self.assertGreater(int(steps), 5000)
        self.assertGreater(int(hashes), 5)

    def test_it_ends_by_itself_where_nothing_shows_it(self):
        with Node(rtf=0, replay=self.bag, replay_stays=False) as node:
            code, said = node.end()
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"replayed \d+ steps, and all \d+ hashes are equal")
        self.assertIn("The recording was reproduced; it ends", said)

    def test_else_it_says_what_goes_on(self):
        with Node(rtf=0, replay=self.bag) as node:
            node.says("The recording was reproduced; what stands there now may be looked at")
            node.send(signal.SIGINT)
            self.assertEqual(node.end()[0], 0)

    def test_another_command_is_found_with_its_step(self):
        def other(topic, message):
            if topic == "/movx" and message.distance == -1:
                message.distance = -2
            return message

        code, said = self.replay(self.changed(other))
        self.assertEqual(code, 1, said)
        self.assertRegex(said, r"differs at step \d+ and was equal at step \d+")

    def test_another_hash_is_found_with_its_step(self):
        def other(topic, message):
            if topic == "/warehouse/state_hash" and message.data.startswith("3000 "):
                message.data = "3000 0123456789abcdef"
            return message

        code, said = self.replay(self.changed(other))
        self.assertEqual(code, 1, said)
        self.assertIn("differs at step 3000 and was equal at step 2000", said)

    def test_what_is_no_recording_is_refused(self):
        empty = self.changed(lambda topic, message: message if topic == "/rot" else None)
        text = Path(self._folder.name) / "text.bag"
        text.write_text("no bag")
        for bag in (empty, str(text), "/nowhere.bag"):
            code, said = self.replay(bag)
            self.assertEqual(code, 1, said)
            self.assertIn(f"can't replay {bag}", said)

    def test_what_is_damaged_is_named_with_its_remedy(self):
        whole = Path(self.bag).read_bytes()
        damaged = Path(self._folder.name) / "damaged.bag"
        for seed in range(6):
            chance = random.Random(seed)
            changed = bytearray(whole)
            for _ in range(20):
                changed[chance.randrange(len(changed))] = chance.randrange(256)
            damaged.write_bytes(changed)
            code, said = self.replay(str(damaged))
            self.assertEqual(code, 1, said)
            self.assertIn(f"can't replay {damaged}", said)
            self.assertIn(f"rosbag reindex {damaged}", said)

    def test_a_full_disk_ends_the_recording_and_not_the_world(self):
        bag = str(Path(self._folder.name) / "full.bag")
        with Node(world="paper", rtf=0, record=bag, most_bytes=20_000) as node:
            node.says(f"the recording to {bag} ended at step")
            wait_until(lambda: sim_time() > 100, "time going on")
            node.send(signal.SIGINT)
            code, said = node.end()
        self.assertEqual(code, 0, said)
        self.assertEqual(said.count("ended at step"), 1, said)

    def test_where_nothing_can_be_written_is_refused(self):
        with Node(record="/nowhere/run.bag") as node:
            code, said = node.end()
        self.assertEqual(code, 1, said)
        self.assertIn("can't record to /nowhere/run.bag", said)


class Crash(unittest.TestCase):
    def test_all_but_the_last_second_is_saved(self):
        with tempfile.TemporaryDirectory() as folder:
            bag = f"{folder}/run.bag"
            with Node(world="paper", record=bag) as node:
                commander = Commander()
                commander.ask("/movx", kiva_id=1, distance=3)
                wait_until(lambda: sim_time() > 4, "time going on")
                commander.close()
                killed = sim_time()
                node.send(signal.SIGKILL)
                node.end()
            with Node(replay=bag) as node:
                code, said = node.end()
            self.assertEqual(code, 1, said)
            self.assertIn(f"rosbag reindex {bag}", said)
            subprocess.run(["rosbag", "reindex", "-q", bag], check=True, stdout=subprocess.DEVNULL)
            with Node(rtf=0, replay=bag) as node:
                node.says("replayed ", "FATAL")
                node.send(signal.SIGINT)
                code, said = node.end()
            self.assertEqual(code, 0, said)
            steps, hashes = re.search(r"replayed (\d+) steps, and all (\d+) hashes", said).groups()
            # The hash that closes a chunk comes with the next step after a second.
            self.assertGreater(int(steps) / 1000, killed - 1.1)
            self.assertGreater(int(hashes), 2)

    def test_steps_that_somebody_waits_for_do_not_cost_the_recording(self):
        with tempfile.TemporaryDirectory() as folder:
            bag = f"{folder}/run.bag"
            with Node(world="paper", lockstep=True, record=bag) as node:
                rospy.wait_for_service("/gazebo/step", PATIENCE)
                client = subprocess.Popen(["rosservice", "call", "/gazebo/step", "100000000"])
                self.addCleanup(lambda: (client.kill(), client.wait()))
                wait_until(lambda: sim_time() > 1, "steps")
                node.send(signal.SIGINT)
                self.assertEqual(node.end()[0], 0)
            with rosbag.Bag(bag) as whole:
                self.assertGreater(whole.get_message_count("/warehouse/state_hash"), 0)


class Inputs(unittest.TestCase):
    """What plugins hear is recorded too."""

    def test_velocities_take_effect_at_the_same_steps_again(self):
        with tempfile.TemporaryDirectory() as folder:
            bag = f"{folder}/run.bag"
            with Node(world="empty", rtf=2, record=bag) as node:
                fields = {"model_xml": ROVER, "robot_namespace": "/", "initial_pose": pose()}
                for i in range(2):  # both hear the same topic
                    fields["initial_pose"] = pose(0, 3.0 * i)
                    spawned = call(
                        "/gazebo/spawn_urdf_model", SpawnModel, model_name=f"rover{i}", **fields
                    )
                    self.assertTrue(spawned.success, spawned.status_message)
                    end = sim_time() + 0.3  # the first is on its wheels when the second comes
                    wait_until(lambda end=end: sim_time() > end, "time going on")
                driver = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
                wait_until(driver.get_num_connections, "the rovers' ear")
                for turn in range(8):
                    driver.publish(Twist(Vector3(0.3, 0, 0), Vector3(0, 0, 0.2 * turn)))
                    end = sim_time() + 0.31
                    wait_until(lambda end=end: sim_time() > end, "time going on")
                driver.unregister()
                node.send(signal.SIGINT)
                self.assertEqual(node.end()[0], 0)
            with rosbag.Bag(bag) as recorded:
                self.assertEqual(recorded.get_message_count("/cmd_vel"), 8)
            with Node(rtf=0, replay=bag) as node:
                node.says("replayed ", "FATAL")
                node.send(signal.SIGINT)
                code, said = node.end()
        self.assertEqual(code, 0, said)


if __name__ == "__main__":
    rospy.init_node("test_recording", disable_signals=True)
    rostest.rosrun("warehouse_tests", "recording", __name__)
