#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The world's node starts, refuses what is wrong, and ends when it is told to."""

import signal
import threading
import time
import unittest
from pathlib import Path

import rosnode
import rospy
import rostest
from rostest_support.node_test import call, wait_until
from rostest_support.warehouse_test import (
    Commander,
    Paused,
    model_file,
    pose,
    sim_time,
    spawn,
    world,
)
from rostest_support.world_node import Node

from warehouse_layout.file.request import Request
from warehouse_layout.generate.generated import plan
from warehouse_layout.models import models
from warehouse_msgs.srv import ReplaceModels

WORLDS = Path(__file__).resolve().parents[2] / "worlds"
SIGINT_TIMEOUT = 3.0  # [s] until roslaunch would kill it


class Refusing(unittest.TestCase):
    def refused(self, *texts, **parameters):
        with Node(**parameters) as node:
            code, said = node.end()
        self.assertEqual(code, 1, said)
        self.assertEqual(said.count("FATAL"), 1, said)
        for text in texts:
            self.assertIn(text, said)

    def test_parameters(self):
        self.refused("/gazebo/rtf is -1", "above 0, or 0", rtf=-1)
        self.refused("/gazebo/rtf is -0.5", rtf=-0.5)
        self.refused("/gazebo/rtf is nan", rtf=float("nan"))
        self.refused("/gazebo/rtf is fast", rtf="fast")
        self.refused("/gazebo/seed is -1", seed=-1)
        self.refused("/gazebo/drive is hover", "traction, jointed", drive="hover")
        self.refused("/gazebo/lockstep is yes", "true or false", lockstep="yes")
        self.refused("/gazebo/autosave is -1", "whole number", autosave=-1)
        self.refused("/gazebo/autosave is 1.5", "whole number", autosave=1.5)
        self.refused("/gazebo/checkpoint_limit is -1", "megabytes", checkpoint_limit=-1)
        self.refused("/gazebo/pub_clock_frequency", pub_clock_frequency=-1.0)
        self.refused("/gazebo/model_states_frequency", model_states_frequency="often")

    def test_worlds(self):
        self.refused("there is no world 'nowhere'", "worlds/nowhere.sdf", world="nowhere")
        broken = str(WORLDS / "invalid_no_world.sdf")
        self.refused(f"{broken}:", "expected a <world>", world=broken)
        self.refused("invalid_xml.sdf:", world=str(WORLDS / "invalid_xml.sdf"))


class Running(unittest.TestCase):
    def stops_in_time(self, node, number):
        begin = time.monotonic()
        node.send(number)
        code, said = node.end()
        self.assertLess(time.monotonic() - begin, SIGINT_TIMEOUT)
        self.assertEqual(code, 0, said)
        self.assertNotIn("terminate", said)
        self.assertNotIn("/gazebo", rosnode.get_node_names())

    def test_without_a_word_it_is_an_empty_floor(self):
        with Node():
            self.assertEqual(world().model_names, ["ground_plane"])
            self.assertTrue(rospy.get_param("/use_sim_time"))

    def test_a_world_is_found_by_name_or_path(self):
        for name in ("paper", "paper.sdf", str(WORLDS.parent.parent / "worlds" / "paper.sdf")):
            with Node(world=name) as node:
                self.assertIn("kiva2", world().model_names)
                node.send(signal.SIGINT)
                node.end()

    def test_ends_when_it_is_told_to(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            for rtf in (1, 0):
                with Node(world="paper", rtf=rtf) as node:
                    wait_until(lambda: sim_time() > 0.2, "time going on")
                    self.stops_in_time(node, number)

    def test_ends_while_time_stands_still_and_commands_wait(self):
        with Node(world="paper") as node:
            commander = Commander()
            Paused().__enter__()
            for _ in range(100):
                commander.send("/rot", kiva_id=1, direction=1)
            self.stops_in_time(node, signal.SIGINT)
            commander.close()

    def test_a_hundred_robots_do_not_hold_it_up(self):
        with Node() as node:
            kiva = model_file("kiva")
            for i in range(100):
                spawn(f"kiva{i + 1}", kiva, pose(i % 10 * 2.0, i // 10 * 2.0))
            self.stops_in_time(node, signal.SIGTERM)

    def test_a_large_warehouse_under_way_does_not_hold_it_up(self):
        parts = models.of_layout(plan(Request(500, 20_000, 80_000)))
        texts = list(map(models.document, models.batches(parts, 500)))
        with Node() as node:
            Paused().__enter__()
            answers = []
            asked = [[], [models.FLOOR], texts]
            builder = threading.Thread(target=lambda: answers.append(self.replace(*asked)))
            builder.start()
            wait_until(lambda: "storage_unit100" in world().model_names, "half a warehouse")
            self.stops_in_time(node, signal.SIGINT)
            builder.join()
        self.assertEqual(answers, [False])

    def replace(self, *asked):
        """Whether the world did it."""
        try:
            return call("/gazebo/replace_models", ReplaceModels, *asked).success
        except rospy.ServiceException:
            return False


if __name__ == "__main__":
    rospy.init_node("test_starting", disable_signals=True)
    rostest.rosrun("warehouse_tests", "starting", __name__)
