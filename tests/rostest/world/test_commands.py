#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Every command is answered, however fast they come."""

import math
import unittest

import rospy
import rostest
import yaml
from rostest_support.node_test import call
from rostest_support.slow_subscriber import SlowSubscriber
from rostest_support.warehouse_test import (
    ANSWERS,
    Collector,
    Commander,
    Paused,
    control,
    delete,
    place,
    world,
)

from gazebo_msgs.srv import DeleteModel, GetWorldProperties, SpawnModel
from warehouse_msgs.msg import Command, Event, FleetState, Lift, People, Rotate
from warehouse_msgs.srv import Fail, FailRequest, LightCurtain, Person

BURST = 10000
FLOOD = 60000  # of answers, more than sockets hold
MODEL = 'a: "name"'
SDF = f"""<sdf version="1.6"><model name="far"><pose>40 40 0 0 0 0</pose><static>1</static>
<link name="a"><collision name="b"><geometry><box><size>1 1 1</size></box></geometry></collision>
</link></model><!-- {"long " * 100} --></sdf>"""


class Commands(unittest.TestCase):
    def setUp(self):
        control("reset_simulation")
        self.commander = Commander()

    def tearDown(self):
        self.commander.close()

    def refused(self, text, topic, **fields):
        answer = self.commander.ask(topic, **fields)
        self.assertEqual(answer.kind, Event.REFUSED, answer)
        self.assertIn(text, answer.text)

    def test_a_call_of_a_service_is_told_with_its_caller_and_fields(self):
        calls = Collector("/warehouse/service_calls", Command)
        call("/warehouse/fail", Fail, 1, FailRequest.MOTOR, 0.0)
        call("/gazebo/spawn_sdf_model", SpawnModel, model_name=MODEL, model_xml=SDF)
        self.addCleanup(call, "/gazebo/delete_model", DeleteModel, MODEL)
        call("/gazebo/get_world_properties", GetWorldProperties)
        call("/warehouse/fail", Fail, 1, FailRequest.REPAIRED, 0.0)
        got = calls.wait_for(lambda messages: len(messages) > 2)
        topics = ["/warehouse/fail", "/gazebo/spawn_sdf_model", "/warehouse/fail"]
        self.assertEqual([each.topic for each in got], topics)
        self.assertEqual({each.sender for each in got}, {rospy.get_name()})
        fail, spawn, _ = (yaml.safe_load(each.fields) for each in got)
        self.assertEqual((fail["kiva_id"], fail["kind"]), (1, FailRequest.MOTOR))
        self.assertEqual(spawn["model_name"], MODEL)
        self.assertEqual(spawn["model_xml"][:4], SDF[:4])
        self.assertLess(len(spawn["model_xml"]), 300)
        self.assertEqual(spawn["initial_pose"]["position"], {"x": 0, "y": 0, "z": 0})

    def stands_at(self, x, y):
        for here, there in zip(place("kiva1"), (x, y)):
            self.assertAlmostEqual(here, there, places=3)

    def test_each_of_the_five_reaches_its_robot(self):
        do = self.commander.do
        kinds = [e.kind for e in do("/mov", kiva_id=1, x=-4.0, y=-3.0)]
        self.assertEqual((kinds[0], kinds[-1]), (Event.ACCEPTED, Event.DONE))
        self.stands_at(-4, -3)
        do("/movx", kiva_id=1, distance=4.0)
        do("/movy", kiva_id=1, distance=-1.0)
        self.stands_at(0, -4)
        do("/rot", kiva_id=1, direction=Rotate.CLOCKWISE)
        events = do("/lift", kiva_id=1, shelf_id=1, status=Lift.CARRY)
        self.assertEqual(
            [(e.kind, e.other) for e in events if e.kind == Event.LIFTED],
            [(Event.LIFTED, "storage_unit1")],
        )
        events = do("/lift", kiva_id=1, shelf_id=1, status=Lift.DROP)
        self.assertIn(Event.DROPPED, [e.kind for e in events])

    def test_a_refusal_says_why(self):
        self.refused("no robot kiva99", "/mov", kiva_id=99, x=0.0, y=0.0)
        self.refused("no robot", "/rot", kiva_id=-1, direction=1)
        self.refused("finite", "/mov", kiva_id=1, x=math.nan, y=0.0)
        self.refused("off the grid", "/mov", kiva_id=1, x=0.3, y=0.0)
        self.refused("outside the floor", "/mov", kiva_id=1, x=1000.0, y=0.0)
        self.refused("whole number", "/movx", kiva_id=1, distance=0.5)
        self.refused("finite", "/movy", kiva_id=1, distance=math.inf)
        self.refused("direction 2", "/rot", kiva_id=1, direction=2)
        self.refused("storage_unit77", "/lift", kiva_id=1, shelf_id=77, status=Lift.CARRY)
        self.refused("away", "/lift", kiva_id=1, shelf_id=1, status=Lift.CARRY)
        self.refused("does not carry", "/lift", kiva_id=1, shelf_id=1, status=Lift.DROP)
        self.refused("status 7", "/lift", kiva_id=1, shelf_id=1, status=7)

    def test_a_busy_robot_refuses(self):
        self.commander.ask("/movx", kiva_id=1, distance=2.0)
        self.refused("not idle", "/movx", kiva_id=1, distance=1.0)

    def test_none_of_a_burst_is_lost(self):
        commands = (
            ("/mov", {"kiva_id": 901, "x": 0.0, "y": 0.0}),
            ("/movx", {"kiva_id": 902, "distance": 1.0}),
            ("/movy", {"kiva_id": 903, "distance": 1.0}),
            ("/rot", {"kiva_id": 904, "direction": 1}),
            ("/lift", {"kiva_id": 905, "shelf_id": 1, "status": 1}),
        )
        for i in range(BURST):
            topic, fields = commands[i % len(commands)]
            self.commander.send(topic, **fields)
        events = self.commander.events.wait_for(
            lambda messages: sum(e.kind in ANSWERS for e in messages) >= BURST
        )
        for i in range(5):
            mine = [e for e in events if e.model == f"kiva{901 + i}"]
            self.assertEqual(len(mine), BURST // 5, f"kiva{901 + i}")

    def test_what_a_subscriber_has_no_room_for_comes_later_in_order(self):
        slow = SlowSubscriber("/gazebo", "/warehouse/events", Event)
        self.addCleanup(slow.close)
        rows = dict.fromkeys(("path_id", "first", "points", "released"), [1] * FLOOD)
        nowhere = {"x": [0.0] * FLOOD, "y": [0.0] * FLOOD}
        self.commander.send("/warehouse/follow", kiva_id=[901] * FLOOD, **rows, **nowhere)
        self.commander.events.wait_for(lambda messages: len(messages) >= FLOOD)
        late = slow.messages(FLOOD)
        first = late[0]
        self.assertEqual((first.kind, first.model), (Event.REFUSED, "kiva901"))
        for i, event in enumerate(late):  # every byte: the last ones are the command's number
            self.assertEqual(event.header.seq, first.header.seq + i)
            self.assertEqual(event.command, first.command + i)
            self.assertEqual((event.model, event.text), (first.model, first.text))

    def test_a_command_waits_while_time_stands_still(self):
        with Paused():
            self.commander.send("/rot", kiva_id=1, direction=1)
            self.commander.send("/rot", kiva_id=99, direction=1)
            place("kiva1")  # an answer, so that time stood still in fact
            self.assertEqual([e for e in self.commander.events.messages if e.kind in ANSWERS], [])
        self.commander.events.first(lambda e: e.kind == Event.ACCEPTED and e.model == "kiva1")
        self.commander.events.first(lambda e: e.kind == Event.REFUSED and e.model == "kiva99")

    def test_what_is_broken_is_told_until_it_is_repaired(self):
        fleet = Collector("/warehouse/fleet", FleetState)
        self.addCleanup(fleet.close)
        self.assertTrue(call("/warehouse/fail", Fail, 1, FailRequest.RADIO_LOST, 0.0).success)
        self.commander.events.first(lambda e: e.kind == Event.FAILED and e.model == "kiva1")
        self.refused("it hears nothing", "/rot", kiva_id=1, direction=1)
        fleet.first(lambda m: m.failures[0] == 1 << FailRequest.RADIO_LOST)
        self.assertTrue(call("/warehouse/fail", Fail, 1, FailRequest.REPAIRED, 0.0).success)
        self.commander.events.first(lambda e: e.kind == Event.REPAIRED and e.model == "kiva1")
        self.commander.do("/rot", kiva_id=1, direction=1)
        self.assertEqual(fleet.first(lambda m: not m.failures[0]).charge[0], 1)
        refused = call("/warehouse/fail", Fail, 99, FailRequest.MOTOR, 0.0)
        self.assertEqual((refused.success, refused.message), (False, "there is no robot kiva99"))

    def test_people_come_and_walk_and_stop_robots(self):
        people = Collector("/warehouse/people", People)
        self.addCleanup(people.close)
        self.walk("person1", [5, 5], [8, 4])
        self.addCleanup(delete, "person1")
        self.assertEqual(people.first(lambda m: m.name == ["person1"] and m.vy[0] < 0).stopped, ())
        people.first(lambda m: m.name == ["person1"] and m.y[0] == 4)
        self.assertAlmostEqual(place("person1")[1], 4)
        self.assertTrue(call("/warehouse/light_curtain", LightCurtain, "c", -9, -9, 9, 9).success)
        people.first(lambda m: 1 in m.stopped)
        self.assertTrue(call("/warehouse/light_curtain", LightCurtain, "c", 0, 0, 0, 0).success)
        people.first(lambda m: m.name and not m.stopped)
        for name, x, y, why in (
            ("person1", [400], [0], "waypoint 0 at (400, 0) is not on the floor"),
            ("person1", [1, 2], [0], "2 x and 1 y"),
            ("person2", [], [], "there is no 'person2', and no place to come to"),
            ("person2", [float("nan")], [0], "person2"),
            ("kiva1", [1], [1], "kiva1: it is not a person"),
        ):
            refused = call("/warehouse/person", Person, name, x, y, 0, False)
            self.assertFalse(refused.success)
            self.assertIn(why, refused.message)
        self.assertNotIn("person2", world().model_names)
        self.assertFalse(call("/warehouse/light_curtain", LightCurtain, "c", 0, 0, 0, 0).success)

    def walk(self, name, x, y):
        answer = call("/warehouse/person", Person, name, x, y, 0, False)
        self.assertTrue(answer.success, answer.message)


if __name__ == "__main__":
    rospy.init_node("test_commands")
    rostest.rosrun("warehouse_tests", "commands", __name__)
