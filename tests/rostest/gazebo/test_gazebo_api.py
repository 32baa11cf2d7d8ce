#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Every service and topic of Gazebo, beyond those of gazebo_services.test."""

import math
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from dynamic_reconfigure.msg import Config
from geometry_msgs.msg import Point, Twist, Vector3, Wrench
from rostest_support.node_test import call, latched, wait_until
from rostest_support.warehouse_test import (
    BOX,
    Collector,
    Commander,
    Paused,
    control,
    delete,
    pose,
    sim_time,
    spawn,
    state,
    step_until,
    world,
)
from std_msgs.msg import ColorRGBA

from gazebo_msgs.msg import LinkState, LinkStates, ModelStates, ODEJointProperties, ODEPhysics
from gazebo_msgs.srv import (
    ApplyBodyWrench,
    ApplyJointEffort,
    BodyRequest,
    DeleteLight,
    GetJointProperties,
    GetLightProperties,
    GetLinkProperties,
    GetLinkState,
    GetPhysicsProperties,
    JointRequest,
    SetJointProperties,
    SetLightProperties,
    SetLinkProperties,
    SetLinkState,
    SetModelConfiguration,
    SetPhysicsProperties,
    SpawnModel,
)
from warehouse_msgs.msg import Collision, Event

CUBE = """<sdf version="1.6"><model name="cube"><link name="body"><gravity>false</gravity>
  <inertial><mass>10</mass>
    <inertia><ixx>0.4</ixx><iyy>0.4</iyy><izz>0.4</izz></inertia></inertial>
  <collision name="skin"><geometry><box><size>0.5 0.5 0.5</size></box></geometry></collision>
</link></model></sdf>"""

# A door: it turns about z, a metre wide, and nothing slows it down.
DOOR = """<sdf version="1.6"><model name="door">
  <link name="leaf"><pose>0.5 0 1 0 0 0</pose><gravity>false</gravity>
    <inertial><mass>3</mass>
      <inertia><ixx>0.3</ixx><iyy>0.3</iyy><izz>0.25</izz></inertia></inertial></link>
  <joint name="hinge" type="revolute"><pose>-0.5 0 0 0 0 0</pose>
    <parent>world</parent><child>leaf</child><axis><xyz>0 0 1</xyz>
    <limit><lower>-2</lower><upper>2</upper></limit></axis></joint>
</model></sdf>"""

URDF = """<?xml version="1.0"?><robot name="arm">
  <link name="base"><inertial><mass value="5"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
    <collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
  <link name="upper"><inertial><mass value="1"/><origin xyz="0 0 0.3"/>
    <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.001"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.2"/><axis xyz="0 1 0"/><dynamics damping="0.5"/>
    <limit lower="-1.5" upper="1.5" effort="50" velocity="5"/></joint>
</robot>"""


def at(name):
    point = state(name).pose.position
    return point.x, point.y, point.z


class World(unittest.TestCase):
    def setUp(self):
        control("reset_simulation")

    def tearDown(self):
        for name in world().model_names:
            if name not in ("ground_plane",):
                delete(name)

    def assert_close(self, first, other, delta=1e-6):
        for a, b in zip(first, other):
            self.assertAlmostEqual(a, b, delta=delta)


class Links(World):
    def setUp(self):
        super().setUp()
        spawn("cube", CUBE, pose(0, 0, 2))

    def link(self, name="cube::body", frame=""):
        return call("/gazebo/get_link_state", GetLinkState, name, frame)

    def put(self, name, where, frame="", twist=None):
        return call(
            "/gazebo/set_link_state", SetLinkState, LinkState(name, where, twist or Twist(), frame)
        )

    def test_set_and_get_link_state(self):
        spawn("mark", BOX, pose(5, 0, 0, yaw=math.pi / 2))
        with Paused():
            twist = Twist(Vector3(0.1, 0, 0), Vector3(0, 0, 0.2))
            answer = self.put("cube::body", pose(1, 0, 1), "mark::link", twist)
            self.assertEqual(answer.status_message, "SetLinkState: success")
            moved = self.link()
            self.assertEqual(moved.status_message, "GetLinkState: got state")
            p, v = moved.link_state.pose.position, moved.link_state.twist
            self.assert_close((p.x, p.y, p.z), (5, 1, 1))
            self.assert_close((v.linear.x, v.linear.y, v.angular.z), (0, 0.1, 0.2))
            back = self.link(frame="mark::link").link_state
            self.assert_close((back.pose.position.x, back.twist.linear.x), (1, 0.1))

    def test_what_is_not_there(self):
        missing = self.put("cube::nothing", pose())
        self.assertEqual(missing.status_message, "SetLinkState: link does not exist")
        self.assertIn("SetLinkState: failed", self.put("cube::body", pose(), "no").status_message)
        self.assertIn("link not found", self.link("nothing").status_message)

    def test_set_link_state_by_topic(self):
        publisher = rospy.Publisher("/gazebo/set_link_state", LinkState, queue_size=1)
        wait_until(publisher.get_num_connections, "the world's ear")
        publisher.publish(LinkState("cube::body", pose(7, 0, 3), Twist(), "world"))
        wait_until(lambda: abs(at("cube")[0] - 7) < 1e-6, "the cube elsewhere")

    def test_link_states(self):
        spawn("kiva1", self.kiva(), pose(3, 3))
        with Collector("/gazebo/link_states", LinkStates) as links:
            message = links.first(lambda m: "kiva1::tower" in m.name)
        place = dict(zip(message.name, message.pose))
        self.assert_close((place["cube::body"].position.z,), (2,), 1e-3)
        self.assert_close((place["kiva1::chassis"].position.x,), (3,), 1e-3)
        self.assertEqual(len(message.twist), len(message.name))

    @staticmethod
    def kiva():
        return (
            '<sdf version="1.6"><world name="w"><include><uri>model://kiva</uri></include>'
            "</world></sdf>"
        )

    def test_link_properties(self):
        before = call("/gazebo/get_link_properties", GetLinkProperties, "cube::body")
        self.assertTrue(before.success)
        self.assert_close((before.mass, before.ixx, before.izz), (10, 0.4, 0.4))
        self.assertFalse(before.gravity_mode)
        changed = call(
            "/gazebo/set_link_properties",
            SetLinkProperties,
            link_name="cube::body",
            com=pose(0.01, 0, 0),
            gravity_mode=True,
            mass=20,
            ixx=0.9,
            iyy=0.8,
            izz=0.7,
            ixy=0.05,
        )
        self.assertEqual(changed.status_message, "SetLinkProperties: properties set")
        after = call("/gazebo/get_link_properties", GetLinkProperties, "cube::body")
        self.assert_close(
            (after.mass, after.ixx, after.iyy, after.izz, after.ixy, after.com.position.x),
            (20, 0.9, 0.8, 0.7, 0.05, 0.01),
        )
        self.assertTrue(after.gravity_mode)
        wait_until(lambda: at("cube")[2] < 1.9, "the cube falling")
        bad = call("/gazebo/set_link_properties", SetLinkProperties, link_name="cube::body")
        self.assertFalse(bad.success)


class Wrenches(World):
    def setUp(self):
        super().setUp()
        control("pause_physics")
        spawn("cube", CUBE, pose(0, 0, 5))

    def tearDown(self):
        control("unpause_physics")
        super().tearDown()

    def push(self, force=(0, 0, 0), torque=(0, 0, 0), frame="", point=(0, 0, 0), **times):
        wrench = Wrench(Vector3(*force), Vector3(*torque))
        times.setdefault("duration", rospy.Duration(0.5))
        answer = call(
            "/gazebo/apply_body_wrench",
            ApplyBodyWrench,
            body_name="cube::body",
            reference_frame=frame,
            reference_point=Point(*point),
            wrench=wrench,
            **times,
        )
        self.assertTrue(answer.success, answer.status_message)

    def run_until(self, time):
        step_until(time)
        return state("cube").twist

    def test_for_a_while(self):
        self.push((10, 0, 0))
        twist = self.run_until(0.7)
        self.assert_close((twist.linear.x, twist.linear.y), (0.5, 0), 1e-3)

    def test_from_a_later_time_on(self):
        self.push((10, 0, 0), start_time=rospy.Time(0.5))
        self.assert_close((self.run_until(0.2).linear.x,), (0,))
        self.assert_close((self.run_until(1.2).linear.x,), (0.5,), 1e-3)

    def test_until_it_is_cleared(self):
        self.push((10, 0, 0), duration=rospy.Duration(-1))
        self.assertGreater(self.run_until(1.0).linear.x, 0.9)
        call("/gazebo/clear_body_wrenches", BodyRequest, "cube::body")
        before = self.run_until(1.2).linear.x
        self.assert_close((self.run_until(1.6).linear.x,), (before,), 0.02)

    def test_at_a_point_and_in_a_frame(self):
        self.push((4, 0, 0), point=(0, 0.1, 0))  # beside the centre: -0.4 Nm about z
        twist = self.run_until(0.7)
        self.assert_close((twist.linear.x, twist.angular.z), (0.2, -0.5), 2e-3)
        delete("cube")
        spawn("cube", CUBE, pose(0, 0, 5, yaw=math.pi / 2))
        self.push((10, 0, 0), frame="cube::body")
        twist = self.run_until(sim_time() + 0.7)
        self.assert_close((twist.linear.x, twist.linear.y, twist.angular.z), (0, 0.5, 0), 2e-3)

    def test_failures(self):
        for body, frame, text in (
            ("nothing::body", "", "body does not exist"),
            ("cube", "", "body does not exist"),
            ("cube::body", "no", "reference_frame not found"),
            ("ground_plane::floor", "", "static"),
        ):
            answer = call(
                "/gazebo/apply_body_wrench", ApplyBodyWrench, body_name=body, reference_frame=frame
            )
            self.assertFalse(answer.success)
            self.assertIn(text, answer.status_message)


class Joints(World):
    def setUp(self):
        super().setUp()
        control("pause_physics")
        spawn("door", DOOR)

    def tearDown(self):
        control("unpause_physics")
        super().tearDown()

    def hinge(self, name="hinge"):
        return call("/gazebo/get_joint_properties", GetJointProperties, name)

    def run_until(self, time):
        step_until(time)
        return self.hinge()

    def effort(self, effort, **times):
        times.setdefault("duration", rospy.Duration(0.5))
        service = "/gazebo/apply_joint_effort"
        return call(service, ApplyJointEffort, joint_name="hinge", effort=effort, **times)

    def test_an_effort_turns_it(self):
        answer = self.effort(0.4)  # 1 kg m² about the hinge
        self.assertEqual(answer.status_message, "ApplyJointEffort: effort set")
        hinge = self.run_until(0.8)
        self.assertEqual(hinge.status_message, "GetJointProperties: got properties")
        self.assert_close((hinge.rate[0],), (0.2,), 5e-3)
        self.assert_close((hinge.position[0],), (0.05 + 0.2 * (sim_time() - 0.5),), 0.01)
        self.assertEqual(hinge.type, hinge.REVOLUTE)
        self.assertEqual(self.hinge("door::hinge").position, hinge.position)

    def test_efforts_can_be_cleared(self):
        self.effort(0.4, duration=rospy.Duration(-1))
        self.assertGreater(self.run_until(0.3).rate[0], 0.1)
        call("/gazebo/clear_joint_forces", JointRequest, "hinge")
        before = self.run_until(0.4).rate[0]
        self.assert_close((self.run_until(0.8).rate[0],), (before,), 0.01)

    def test_its_properties_are_set(self):
        config = ODEJointProperties(damping=[2.0], hiStop=[0.1], fudge_factor=[1.0])
        answer = call("/gazebo/set_joint_properties", SetJointProperties, "hinge", config)
        self.assertTrue(answer.success)
        self.assertIn("fudge_factor", answer.status_message)
        self.assertEqual(self.hinge().damping, (2.0,))
        self.effort(5.0, duration=rospy.Duration(-1))
        self.assert_close((self.run_until(1.5).position[0],), (0.1,), 0.01)

    def test_a_motor_by_fmax_and_vel(self):
        config = ODEJointProperties(fmax=[100.0], vel=[0.5])
        call("/gazebo/set_joint_properties", SetJointProperties, "hinge", config)
        self.assert_close((self.run_until(1.0).rate[0],), (0.5,), 0.01)

    def test_a_model_takes_a_configuration(self):
        configure = ("/gazebo/set_model_configuration", SetModelConfiguration)
        answer = call(*configure, "door", "", ["hinge"], [1.2])
        self.assertEqual(answer.status_message, "SetModelConfiguration: success")
        self.assert_close(self.hinge().position, (1.2,))
        p = call("/gazebo/get_link_state", GetLinkState, "door::leaf", "").link_state.pose.position
        self.assert_close((p.x, p.y), (0.5 * math.cos(1.2), 0.5 * math.sin(1.2)))
        for model, names, text in (
            ("nothing", ["hinge"], "model does not exist"),
            ("door", [], "different lengths"),
            ("door", ["handle"], "'handle'"),
        ):
            answer = call(*configure, model, "", names, [1.0])
            self.assertFalse(answer.success)
            self.assertIn(text, answer.status_message)

    def test_what_is_not_there(self):
        self.assertEqual(self.hinge("no").status_message, "GetJointProperties: joint not found")
        answer = call("/gazebo/apply_joint_effort", ApplyJointEffort, joint_name="no")
        self.assertEqual(answer.status_message, "ApplyJointEffort: joint not found")
        answer = call("/gazebo/set_joint_properties", SetJointProperties, joint_name="no")
        self.assertEqual(answer.status_message, "SetJointProperties: joint not found")


class Lights(World):
    LAMP = (
        '<sdf version="1.6"><light name="x" type="point"><diffuse>1 0.5 0 1</diffuse>'
        "<attenuation><range>9</range><linear>0.25</linear></attenuation></light></sdf>"
    )

    def lamp(self, name="lamp"):
        return call("/gazebo/get_light_properties", GetLightProperties, name)

    def test_lights_come_are_set_and_go(self):
        self.assertTrue(self.lamp("sun").success)  # every world has one
        self.assertTrue(spawn("lamp", self.LAMP).success)
        self.assert_close((self.lamp().diffuse.g, self.lamp().attenuation_linear), (0.5, 0.25))
        answer = call(
            "/gazebo/set_light_properties",
            SetLightProperties,
            light_name="lamp",
            cast_shadows=True,
            diffuse=ColorRGBA(0, 0, 1, 1),
            attenuation_quadratic=0.5,
        )
        self.assertTrue(answer.success)
        self.assert_close((self.lamp().diffuse.b, self.lamp().attenuation_quadratic), (1, 0.5))
        self.assertTrue(call("/gazebo/delete_light", DeleteLight, "lamp").success)
        for name, kind in (
            ("delete_light", DeleteLight),
            ("set_light_properties", SetLightProperties),
        ):
            answer = call(f"/gazebo/{name}", kind, light_name="lamp")
            self.assertFalse(answer.success)
            self.assertIn("lamp not found", answer.status_message)
        self.assertFalse(self.lamp().success)


class Physics(World):
    def get(self):
        return call("/gazebo/get_physics_properties", GetPhysicsProperties)

    def set(self, time_step=0.001, rate=1000.0, gravity=(0, 0, -9.81), ode=None):
        return call(
            "/gazebo/set_physics_properties",
            SetPhysicsProperties,
            time_step,
            rate,
            Vector3(*gravity),
            ode or ODEPhysics(),
        )

    def tearDown(self):
        self.set()
        super().tearDown()

    def test_what_is_set_is_told(self):
        ode = ODEPhysics(True, 1, 77, 1.1, 0.5, 0.002, 50.0, 0.1, 0.3, 33)
        before = sim_time()
        answer = self.set(0.002, 250.0, (0.5, 0, -1), ode)
        self.assertTrue(answer.success)
        self.assertIn("physics engine updated", answer.status_message)
        self.assertIn("no counterpart", answer.status_message)
        now = self.get()
        self.assertEqual((now.time_step, now.gravity), (0.002, Vector3(0.5, 0, -1)))
        self.assertAlmostEqual(now.max_update_rate, 250.0)
        self.assertEqual(now.ode_config, ode)
        self.assertLess(sim_time() - before, 5)

    def test_gravity_acts(self):
        spawn("cube", CUBE.replace("<gravity>false</gravity>", ""), pose(0, 0, 0.3))
        self.set(gravity=(0, 0, 2))
        wait_until(lambda: at("cube")[2] > 1, "the cube rising")

    def test_the_pace_is_as_asked_for(self):
        self.set(rate=3000.0)
        begin, clock = sim_time(), rospy.get_rostime
        self.assertIsNotNone(clock())
        wait_until(lambda: sim_time() > begin + 1, "time going on")
        self.assertAlmostEqual(self.get().max_update_rate, 3000.0)
        self.set(rate=0.0)  # as fast as it goes
        self.assertEqual(self.get().max_update_rate, 0.0)
        begin = sim_time()
        wait_until(lambda: sim_time() > begin + 20, "time flying")

    def test_what_can_not_be_is_refused_and_changes_nothing(self):
        for bad in (
            {"time_step": 0.0},
            {"time_step": math.nan},
            {"gravity": (0, math.inf, 0), "time_step": 0.002},
            {"time_step": -1.0, "gravity": (1, 1, 1)},
        ):
            self.assertFalse(self.set(**bad).success)
        now = self.get()
        self.assertEqual((now.time_step, now.gravity), (0.001, Vector3(0, 0, -9.81)))

    def test_dynamic_reconfigure(self):
        client = Client("/gazebo", timeout=20)
        names = {p["name"] for p in client.get_parameter_descriptions()}
        self.assertTrue({"time_step", "gravity_z", "sor_pgs_iters"} <= names)
        self.assertAlmostEqual(client.get_configuration()["gravity_z"], -9.81)
        client.update_configuration({"gravity_z": -1.5, "sor_pgs_iters": 12})
        self.assertAlmostEqual(self.get().gravity.z, -1.5)
        self.assertEqual(self.get().ode_config.sor_pgs_iters, 12)
        self.set(gravity=(0, 0, -3.0))  # and the other way round
        parameters = latched(
            "/gazebo/parameter_updates",
            Config,
            lambda m: any(d.name == "gravity_z" and d.value == -3.0 for d in m.doubles),
        )
        self.assertTrue(parameters)
        client.update_configuration({"time_step": 0.0})  # in its range, and yet impossible
        self.assertEqual(self.get().time_step, 0.001)
        client.close()


class Urdf(World):
    def spawn(self, xml=URDF, where=None):
        return call(
            "/gazebo/spawn_urdf_model", SpawnModel, "arm", xml, "", where or pose(0, 0, 0.1), ""
        )

    def test_is_converted(self):
        with Paused():
            self.assertEqual(
                self.spawn(where=pose(1, 2, 0.1)).status_message,
                "SpawnModel: Successfully spawned entity",
            )
            self.assert_close(at("arm"), (1, 2, 0.1))
            shoulder = call("/gazebo/get_joint_properties", GetJointProperties, "shoulder")
            self.assertEqual((shoulder.type, shoulder.damping), (shoulder.REVOLUTE, (0.5,)))
            link = call("/gazebo/get_link_properties", GetLinkProperties, "arm::upper")
            self.assert_close((link.mass, link.com.position.z, link.ixx), (1, 0.3, 0.03))

    def test_what_is_not_urdf_is_refused(self):
        for xml in (BOX, "", "<robot", "<robot name='r'/>"):
            answer = self.spawn(xml)
            self.assertFalse(answer.success)
        self.assertEqual(
            self.spawn(BOX).status_message, "SpawnModel: Failure - model format is not URDF."
        )


class Collisions(World):
    def test_say_where_and_how_hard(self):
        spawn("kiva1", Links.kiva(), pose(0, 0))
        wall = BOX.replace("0.2 0.2 0.2", "0.2 2 1")
        commander = Commander()
        with Collector("/warehouse/collisions", Collision) as collisions:
            commander.ask("/movx", kiva_id=1, distance=5.0)
            wait_until(lambda: state("kiva1").twist.linear.x > 1.0, "kiva1 driving")
            with Paused():
                x = state("kiva1").pose.position.x
                spawn("box1", wall, pose(x + 0.6, 0, 0.5))
            hit = collisions.first()
        self.assertEqual((hit.model, hit.other), ("kiva1", "box1"))
        self.assertAlmostEqual(hit.normal.x, -1.0, delta=0.01)
        self.assertGreater(hit.speed, 0.5)
        self.assertGreater(hit.impulse, 0)
        self.assertAlmostEqual(hit.point.x, x + 0.5, delta=0.03)
        event = commander.events.first(lambda e: e.kind == Event.COLLISION)
        self.assertEqual(event.header.stamp, hit.header.stamp)
        commander.close()


class Names(World):
    def test_a_respawned_name_takes_the_new_pose(self):
        for x in (1.0, 4.0):
            spawn("box1", BOX, pose(x))
            self.assert_close(at("box1"), (x, 0, 0))
            delete("box1")

    def test_static_models_are_among_the_model_states(self):
        spawn("box1", BOX, pose(1))
        with Collector("/gazebo/model_states", ModelStates) as models:
            models.first(lambda m: {"box1", "ground_plane"} <= set(m.name))


if __name__ == "__main__":
    rospy.init_node("test_gazebo_api")
    rostest.rosrun("warehouse_tests", "gazebo_api", __name__)
