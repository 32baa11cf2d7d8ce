#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A whole warehouse in one request: the same world as model by model, all of it or none."""

import subprocess
import sys
import unittest

import rospy
import rostest
import yaml
from rostest_support.node_test import call, latched, wait_until
from rostest_support.warehouse_test import BOX, Collector, control, delete, spawn, world
from std_msgs.msg import String

from warehouse_layout.file.request import PRESETS, Request
from warehouse_layout.generate.generated import plan
from warehouse_layout.models import models
from warehouse_msgs.msg import Command, WarehouseObjects
from warehouse_msgs.srv import Checkpoint, ReplaceModels, Step

SECOND = 1000  # steps
ITEM = models.include("item", 1, 0, 0).xml
UNIT = models.include("storage_unit", 1, 0, 0).xml
FALLEN = UNIT.replace("storage_unit1", "kiva1").replace("//storage_unit", "//kiva")
FALLEN = FALLEN.replace("0 0 0.0</pose>", "1 0 0</pose>")  # on its side, as no robot stands
LIGHT = '<light name="sun" type="directional"/>'
FULL = '<sdf version="1.9"><world name="w">{}</world></sdf>'
CLIENT = "--client"  # an argument with which this file is only a client that builds


def documents(request):
    parts = [part for part in models.of_layout(plan(request)) if part.name != models.FLOOR]
    return list(map(models.document, models.batches(parts, 500)))


def replace(texts, kinds=models.PLACED, names=()):
    return call("/gazebo/replace_models", ReplaceModels, list(kinds), list(names), list(texts))


def count(kind):
    return sum(models.kind_and_number(name)[0] == kind for name in world().model_names)


class Replacing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/gazebo/replace_models", 60)
        cls.hashes = Collector("/warehouse/state_hash", String)

    def setUp(self):
        control("pause_physics")
        self.assertTrue(call("/warehouse/checkpoint", Checkpoint, "beginning").success)

    def tearDown(self):
        self.assertTrue(call("/warehouse/restore", Checkpoint, "beginning").success)

    def digest(self):
        """The state after a second."""
        self.hashes.clear()
        self.assertTrue(call("/gazebo/step", Step, SECOND).success)
        return self.hashes.first().data

    def test_the_world_is_that_of_models_which_come_and_go_one_by_one(self):
        small, medium = documents(PRESETS["small"]), documents(PRESETS["medium"])
        self.build_by_hand(small)
        before = world().model_names
        for kind in models.PLACED:
            for name in world().model_names:
                if models.kind_and_number(name)[0] == kind:
                    delete(name)
        self.build_by_hand(medium)
        names, by_hand = world().model_names, self.digest()
        self.tearDown()
        self.assertTrue(replace(small).success)
        self.assertEqual(world().model_names, before)
        answer = replace(medium)
        self.assertTrue(answer.success and answer.changed)
        self.assertEqual(
            answer.message, f"{len(before) - 1} models taken away, {len(names) - 1} added"
        )
        self.assertEqual(world().model_names, names)
        self.assertEqual(self.digest(), by_hand)

    def test_a_call_is_published_with_its_caller_and_the_sizes_of_its_documents(self):
        names = [f"box{i}" for i in range(30)]
        text = FULL.format(UNIT)
        with Collector("/warehouse/service_calls", Command) as calls:
            self.assertTrue(replace([text], models.PLACED, names).success)
            (message,) = calls.wait_for(bool)
        self.assertEqual(
            (message.topic, message.sender), ("/gazebo/replace_models", rospy.get_name())
        )
        fields = yaml.safe_load(message.fields)
        self.assertEqual(fields["kinds"], list(models.PLACED))
        self.assertEqual(fields["names"], [*names[:20], "… and 10 more"])
        self.assertEqual(fields["documents"], [f"SDF of {len(text)} bytes"])

    def build_by_hand(self, texts):
        for text in texts:
            self.assertTrue(spawn("", text).success)

    def test_subscribers_get_the_world_before_and_after_and_nothing_between(self):
        large = documents(PRESETS["large"])
        with Collector("/warehouse/objects", WarehouseObjects) as objects:
            objects.first()
            self.assertTrue(replace(large).success)
            objects.wait_for(lambda messages: len(messages[-1].items) == 4000)
            self.assertTrue(replace([]).success)
            received = objects.wait_for(lambda messages: len(messages[-1].items) == 0)
        self.assertEqual({len(message.items) for message in received}, {0, 4000})
        latched("/warehouse/objects", WarehouseObjects, lambda m: not m.storage_units)

    def test_a_fault_that_can_be_seen_beforehand_changes_nothing(self):
        self.assertTrue(replace([FULL.format(UNIT)]).success)
        spawn("box1", BOX)
        before = world().model_names
        fine, box = FULL.format(ITEM), FULL.format(BOX.partition(">")[2].replace('"box"', '"box1"'))
        for texts, words in (
            ([fine, "<sdf"], "documents[1]"),
            ([fine, FULL.format(ITEM)], "documents[1]: model 'item1': documents[0] has one"),
            (
                [box.replace("</sdf></world>", "</world>")],
                "documents[0]: model 'box1': one of that",
            ),
            ([FULL.format(ITEM + LIGHT)], "documents[0] has the light 'sun'"),
            ([FULL.format(" " * 10_000_000)], "documents[0] has 10000"),
        ):
            answer = replace(texts)
            self.assertFalse(answer.success or answer.changed, answer.message)
            self.assertIn(words, answer.message)
            self.assertEqual(world().model_names, before)

    def test_a_world_in_motion_is_left_alone(self):
        control("unpause_physics")
        answer = replace([FULL.format(UNIT)])
        control("pause_physics")
        self.assertFalse(answer.success or answer.changed)
        self.assertIn("physics runs; pause it first", answer.message)
        self.assertEqual(count("storage_unit"), 0)

    def test_a_model_that_is_refused_later_leaves_nothing_half_built(self):
        self.assertTrue(replace(documents(PRESETS["small"])).success)
        spawn("box1", BOX)
        answer = replace([FULL.format(UNIT), FULL.format(FALLEN)])
        self.assertFalse(answer.success)
        self.assertTrue(answer.changed)
        self.assertIn("model 'kiva1': a robot must stand upright", answer.message)
        self.assertEqual([count(kind) for kind in models.PLACED], [0] * len(models.PLACED))
        self.assertIn("box1", world().model_names)

    def test_a_client_that_dies_leaves_nothing_half_built(self):
        client = subprocess.Popen([sys.executable, __file__, CLIENT])
        wait_until(lambda: count("storage_unit") > 0, "half a warehouse")
        client.kill()
        client.wait()
        wait_until(lambda: count("storage_unit") == 0, "the end of it")
        self.assertTrue(replace([FULL.format(UNIT)]).success)
        self.assertEqual((count("storage_unit"), count("item"), count("kiva")), (1, 0, 0))


if __name__ == "__main__":
    if CLIENT in sys.argv:
        sys.exit(replace(documents(Request(500, 20_000, 80_000))).message)
    rospy.init_node("test_replace_models")
    rostest.rosrun("warehouse_tests", "replace_models", __name__)
