#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Gazebo's services: models come and go, are asked and moved; time stands still and restarts."""

import math
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Twist, Vector3
from rostest_support.node_test import call, wait_until
from rostest_support.warehouse_test import (
    BOX,
    Commander,
    Paused,
    control,
    delete,
    model_file,
    place,
    pose,
    sim_time,
    spawn,
    state,
    world,
)

from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import (
    ApplyBodyWrench,
    GetLinkProperties,
    GetLinkState,
    GetModelProperties,
    GetModelState,
    GetPhysicsProperties,
    SetModelState,
)
from warehouse_msgs.msg import Event

HERE = (3.0, 8.0)  # nothing stands there
PAIR = """<sdf version="1.6"><world name="w">
  <include>
    <uri>model://storage_unit</uri><name>storage_unit21</name><pose>1 0 0 0 0 0</pose>
  </include>
  <include><uri>model://kiva</uri><name>{}</name></include>
</world></sdf>"""

TOWER = """<sdf version="1.6"><model name="box"><link name="foot"/>
  <model name="inner"><pose>0 0 1 0 0 0</pose><static>true</static><link name="mast">
    <inertial><mass>3</mass></inertial>
  </link></model>
  <static>true</static>
</model></sdf>"""


def topics():
    return {topic for topic, _ in rosgraph.Master("/test").getPublishedTopics("")}


def put(name, where, frame="", twist=None):
    request = ModelState(name, where, twist or Twist(), frame)
    return call("/gazebo/set_model_state", SetModelState, request)


class Spawning(unittest.TestCase):
    def tearDown(self):
        for name in world().model_names:
            if name.startswith("box") or name.endswith(("7", "21")):
                delete(name)

    def refused(self, answer, text):
        self.assertFalse(answer.success)
        self.assertIn(text, answer.status_message)
        self.assertNotIn("box1", world().model_names)

    def test_stands_where_and_as_it_was_asked_for(self):
        answer = spawn("box1", where=pose(*HERE))
        self.assertTrue(answer.success)
        self.assertEqual(answer.status_message, "SpawnModel: Successfully spawned entity")
        self.assertEqual(place("box1"), (*HERE, 0.0))
        self.assertEqual(state("box1").pose.orientation.w, 1.0)
        self.assertIn("box1", world().model_names)

    def test_the_models_own_pose_composes_with_the_initial_pose(self):
        own = BOX.replace("<static>", "<pose>1 0 0 0 0 0</pose><static>")
        spawn("box1", own, pose(*HERE, yaw=math.pi / 2))
        x, y, _ = place("box1")
        self.assertAlmostEqual(x, HERE[0])
        self.assertAlmostEqual(y, HERE[1] + 1)

    def test_a_pose_may_refer_to_a_model_or_a_link(self):
        spawn("box1", where=pose(*HERE, yaw=math.pi / 2))
        self.assertTrue(spawn("box2", where=pose(x=2.0), frame="box1").success)
        self.assertTrue(spawn("box3", where=pose(z=1.0), frame="kiva1::tower").success)
        self.assertAlmostEqual(place("box2")[1], HERE[1] + 2)
        self.assertAlmostEqual(place("box3", "kiva1")[2], 1.38)
        for frame in ("world", "map", "/map"):
            self.assertTrue(spawn("box4", where=pose(*HERE), frame=frame).success)
            self.assertEqual(place("box4"), (*HERE, 0.0))
            delete("box4")

    def test_a_taken_name_is_refused(self):
        answer = spawn("kiva1")
        self.assertFalse(answer.success)
        self.assertEqual(answer.status_message, "SpawnModel: Failure - entity already exists.")
        self.assertEqual(delete("kiva99").status_message, "DeleteModel: model does not exist")

    def test_a_refusal_names_its_cause(self):
        self.refused(spawn("box1", where=pose(math.nan)), "not finite")
        self.refused(spawn("box1", frame="nothing"), "reference_frame not found")
        self.refused(spawn("box1", BOX.replace("</link>", "")), "model_xml:")
        self.refused(spawn("box1", BOX.replace("link", "knot")), "expected a <link>")
        self.refused(spawn("box1", model_file("nothing")), "model://nothing")
        self.refused(spawn("", BOX), "name")

    def test_topics_of_a_robot_come_and_go_with_it(self):
        theirs = {"/kiva7/status", "/kiva7/odom", "/kiva7/chassis/laser/scan"}
        self.assertTrue(spawn("kiva7", model_file("kiva"), pose(*HERE)).success)
        wait_until(lambda: theirs <= topics(), "the topics of kiva7")
        self.assertEqual(delete("kiva7").status_message, "DeleteModel: successfully deleted model")
        wait_until(lambda: not theirs & topics(), "an end of the topics of kiva7")
        self.assertFalse(state("kiva7").success)

    def test_a_world_is_inserted_as_a_whole_or_not_at_all(self):
        before = world().model_names
        answer = spawn("any", PAIR.format("kiva1"), pose(*HERE))
        self.assertFalse(answer.success)
        self.assertIn("entity already exists. (kiva1)", answer.status_message)
        self.assertEqual(world().model_names, before)
        self.assertTrue(spawn("any", PAIR.format("kiva7"), pose(*HERE)).success)
        self.assertEqual(place("kiva7"), (*HERE, 0.0))
        self.assertEqual(place("storage_unit21", "kiva7"), (1.0, 0.0, 0.0))


class Asking(unittest.TestCase):
    def setUp(self):
        spawn("box1", where=pose(*HERE, yaw=math.pi / 2))

    def tearDown(self):
        delete("box1")

    def test_model_state_is_offered_under_both_names(self):
        for service in ("/get_model_state", "/gazebo/get_model_state"):
            answer = call(service, GetModelState, "kiva2", "")
            self.assertTrue(answer.success)
            self.assertEqual(answer.status_message, "GetModelState: got properties")
            self.assertEqual((answer.pose.position.x, answer.pose.position.y), (-6.0, 2.0))

    def test_the_header_counts_and_tells_the_time(self):
        first, second = state("kiva1", "box1"), state("kiva1", "box1")
        self.assertEqual(second.header.seq, first.header.seq + 1)
        self.assertEqual(second.header.frame_id, "box1")
        self.assertGreaterEqual(second.header.stamp.to_sec(), first.header.stamp.to_sec())
        self.assertLess(abs(second.header.stamp.to_sec() - sim_time()), 1.0)

    def test_what_does_not_exist_is_a_failure(self):
        self.assertEqual(state("kiva99").status_message, "GetModelState: model does not exist")
        self.assertIn("relative_entity_name not found", state("kiva1", "no").status_message)

    def test_positions_and_velocities_are_seen_from_the_frame(self):
        commander = Commander()
        commander.ask("/movx", kiva_id=2, distance=3.0)
        wait_until(lambda: state("kiva2").twist.linear.x > 0.5, "kiva2 driving")
        with Paused():
            plain, relative = state("kiva2"), state("kiva2", "box1")
        self.assertAlmostEqual(relative.twist.linear.y, -plain.twist.linear.x)
        self.assertAlmostEqual(relative.pose.position.x, plain.pose.position.y - HERE[1])
        self.assertAlmostEqual(relative.pose.position.y, HERE[0] - plain.pose.position.x)
        commander.events.first(lambda e: e.kind == Event.DONE)
        commander.ask("/movx", kiva_id=2, distance=-3.0)
        commander.events.first(lambda e: e.kind == Event.DONE)
        commander.close()

    def test_links(self):
        answer = call("/gazebo/get_link_state", GetLinkState, "kiva1::tower", "kiva1")
        self.assertEqual(answer.status_message, "GetLinkState: got state")
        self.assertAlmostEqual(answer.link_state.pose.position.z, 0.38)
        for link in ("nothing", "kiva1::nothing", "kiva1"):
            answer = call("/gazebo/get_link_state", GetLinkState, link, "")
            self.assertIn("link not found", answer.status_message)

    def test_a_plain_name_is_the_first_model_or_link_called_so(self):
        spawn("box2", TOWER, pose(*HERE))
        spawn("tower", BOX, pose(0.0, 1.0))
        above = call("/gazebo/get_link_state", GetLinkState, "tower", "chassis").link_state
        self.assertEqual((above.link_name, above.reference_frame), ("tower", "chassis"))
        within = call("/gazebo/get_link_state", GetLinkState, "kiva1::tower", "kiva1::chassis")
        self.assertEqual(above.pose, within.link_state.pose)
        self.assertEqual(state("box1", "tower").pose, state("box1", "kiva1::tower").pose)
        self.assertEqual(state("box1", "mast").pose, state("box1", "box2::inner::mast").pose)
        self.assertTrue(put("tower", pose(z=5.0), "mast").success)
        self.assertEqual(place("tower"), (*HERE, 6.0))
        self.assertTrue(spawn("box3", where=pose(z=1.0), frame="mast").success)
        self.assertEqual(place("box3"), (*HERE, 2.0))
        mast = call("/gazebo/get_link_properties", GetLinkProperties, "mast")
        self.assertEqual((mast.success, mast.mass), (True, 3.0))
        push = call("/gazebo/apply_body_wrench", ApplyBodyWrench, body_name="tower")
        self.assertTrue(push.success, push.status_message)  # kiva1's, not the static model
        for name in ("box2", "box3", "tower"):
            delete(name)

    def test_properties(self):
        answer = call("/gazebo/get_model_properties", GetModelProperties, "kiva1")
        self.assertEqual(set(answer.body_names), {"chassis", "left_wheel", "right_wheel", "tower"})
        self.assertIn("tower_joint", answer.joint_names)
        self.assertFalse(answer.is_static)
        self.assertFalse(call("/gazebo/get_model_properties", GetModelProperties, "no").success)
        physics = call("/gazebo/get_physics_properties", GetPhysicsProperties)
        self.assertEqual((physics.time_step, physics.pause), (0.001, False))
        self.assertAlmostEqual(physics.max_update_rate, 1000)
        self.assertEqual(physics.gravity, Vector3(0, 0, -9.81))


class Moving(unittest.TestCase):
    def tearDown(self):
        control("reset_world")

    def test_by_service(self):
        answer = put("kiva1", pose(4.0, 0.0, yaw=math.pi / 2))
        self.assertEqual(answer.status_message, "SetModelState: set model state done")
        self.assertAlmostEqual(place("kiva1")[0], 4.0)
        self.assertTrue(put("kiva2", pose(1.0), "kiva1").success)
        self.assertAlmostEqual(place("kiva2")[0], 4.0, places=3)
        self.assertAlmostEqual(place("kiva2")[1], 1.0, places=3)

    def test_what_can_not_be_is_a_failure(self):
        self.assertEqual(put("no", pose()).status_message, "SetModelState: model does not exist")
        self.assertIn("frame entity does not exist", put("kiva1", pose(), "no").status_message)
        self.assertIn("not finite", put("kiva1", pose(math.inf)).status_message)
        self.assertEqual(place("kiva1"), (-6.0, -2.0, 0.0))

    def test_by_topic(self):
        publisher = rospy.Publisher("/gazebo/set_model_state", ModelState, queue_size=1)
        wait_until(publisher.get_num_connections, "the world's ear")
        publisher.publish(ModelState("kiva1", pose(5.0), Twist(), ""))
        wait_until(lambda: place("kiva1") == (5.0, 0.0, 0.0), "kiva1 elsewhere")


class Time(unittest.TestCase):
    def test_stands_still_while_everything_else_is_served(self):
        with Paused():
            before = sim_time()
            self.assertTrue(spawn("box9", where=pose(*HERE)).success)
            self.assertEqual(place("box9"), (*HERE, 0.0))
            self.assertTrue(delete("box9").success)
            self.assertTrue(call("/gazebo/get_physics_properties", GetPhysicsProperties).pause)
            self.assertEqual(sim_time(), before)
        wait_until(lambda: sim_time() > before, "time going on")

    def test_reset_of_the_world_leaves_time_alone(self):
        put("kiva1", pose(4.0))
        before = sim_time()
        control("reset_world")
        self.assertEqual(place("kiva1"), (-6.0, -2.0, 0.0))
        self.assertGreaterEqual(sim_time(), before)

    def test_reset_of_the_simulation_begins_anew(self):
        put("kiva1", pose(4.0))
        wait_until(lambda: sim_time() > 0.1, "time going on")
        with Paused():
            control("reset_simulation")
            self.assertEqual(sim_time(), 0.0)
            self.assertEqual(place("kiva1"), (-6.0, -2.0, 0.0))


if __name__ == "__main__":
    rospy.init_node("test_gazebo_services")
    rostest.rosrun("warehouse_tests", "gazebo_services", __name__)
