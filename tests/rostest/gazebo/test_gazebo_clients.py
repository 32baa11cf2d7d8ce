#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Programs as they were written for Gazebo, in their own order of calls: the script spawn_model,
learning environments that pause, reset, set states and unpause, programs that teleport by topic."""

import math
import pathlib
import unittest
from xml.etree import ElementTree

import rospy
import rostest
from geometry_msgs.msg import Pose, Quaternion, Twist, Vector3
from rostest_support.node_test import wait_until
from rostest_support.warehouse_test import BOX, Collector, sim_time, world
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty

from gazebo_msgs.msg import ModelState, ModelStates, ODEPhysics
from gazebo_msgs.srv import (
    DeleteModel,
    GetJointProperties,
    GetModelState,
    SetModelConfiguration,
    SetModelState,
    SetPhysicsProperties,
    SetPhysicsPropertiesRequest,
    SpawnModel,
)

ROVER = (pathlib.Path(__file__).parents[2] / "worlds" / "rover.urdf").read_text()


def quaternion(roll, pitch, yaw):
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return Quaternion(
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def proxy(name, kind):
    rospy.wait_for_service(f"/gazebo/{name}", 30)
    return rospy.ServiceProxy(f"/gazebo/{name}", kind)


def spawn_model(xml, model, urdf=False, xyz=(0, 0, 0), rpy=(0, 0, 0), joints=(), **options):
    """What the script does between its start and its end; returns its exit code."""
    if options.get("wait"):
        with Collector("/gazebo/model_states", ModelStates) as models:
            models.first(lambda m: options["wait"] in m.name)
    parsed = ElementTree.fromstring(xml)
    if options.get("package_to_model"):
        for mesh in parsed.iterfind(".//mesh"):
            mesh.set("filename", mesh.get("filename").replace("package://", "model://"))
    xml = ElementTree.tostring(parsed).decode(encoding="ascii")
    where = Pose()
    where.position.x, where.position.y, where.position.z = xyz
    where.orientation = quaternion(*rpy)
    call = proxy("spawn_urdf_model" if urdf else "spawn_sdf_model", SpawnModel)
    namespace, frame = options.get("robot_namespace", "/"), options.get("reference_frame", "")
    if not call(model, xml, namespace, where, frame).success:
        return 1
    if joints:
        names, positions = zip(*joints)
        configure = proxy("set_model_configuration", SetModelConfiguration)
        if not configure(model, "", names, positions).success:
            return 1
    if options.get("unpause"):
        proxy("unpause_physics", Empty)()
    return 0


class SpawnModelScript(unittest.TestCase):
    def setUp(self):
        proxy("reset_simulation", Empty)()

    def tearDown(self):
        proxy("unpause_physics", Empty)()
        for name in world().model_names:
            if name.startswith("my_"):
                proxy("delete_model", DeleteModel)(name)

    def state(self, name, frame="world"):
        answer = proxy("get_model_state", GetModelState)(name, frame)
        self.assertTrue(answer.success, answer.status_message)
        return answer

    def test_sdf_with_a_pose(self):
        xyz, rpy = (1.0, 2.0, 3.0), (0.1, 0.2, 0.3)
        self.assertEqual(spawn_model(BOX, "my_box", xyz=xyz, rpy=rpy), 0)
        pose = self.state("my_box").pose
        self.assertEqual((pose.position.x, pose.position.y, pose.position.z), xyz)
        orientation = quaternion(*rpy)
        for axis in "xyzw":
            self.assertAlmostEqual(
                getattr(pose.orientation, axis), getattr(orientation, axis), places=6
            )

    def test_database(self):
        xml = """<sdf version="1.4">
    <world name="default">
        <include>
            <uri>model://wall</uri>
        </include>
    </world>
</sdf>"""
        self.assertEqual(spawn_model(xml, "my_wall", xyz=(3, 0, 0)), 0)
        self.assertEqual(self.state("my_wall").pose.position.x, 3)

    def test_reference_frame(self):
        spawn_model(BOX, "my_first", xyz=(5, 0, 0), rpy=(0, 0, math.pi / 2))
        spawn_model(BOX, "my_second", xyz=(1, 0, 0), reference_frame="my_first")
        spawn_model(BOX, "my_third", xyz=(2, 0, 0), reference_frame="my_first::link")
        self.assertAlmostEqual(self.state("my_second").pose.position.y, 1.0)
        self.assertAlmostEqual(self.state("my_third", "my_second").pose.position.x, 1.0)
        self.assertEqual(spawn_model(BOX, "my_fourth", reference_frame="my_nothing"), 1)

    def test_urdf_with_joints_paused_and_then_unpaused(self):
        proxy("pause_physics", Empty)()
        before = sim_time()
        joints = [("wheel_left_joint", 1.0), ("wheel_right_joint", -0.5)]
        code = spawn_model(ROVER, "my_rover", True, (0, 0, 0.01), joints=joints, unpause=False)
        self.assertEqual(code, 0)
        self.assertEqual(sim_time(), before)
        position = proxy("get_joint_properties", GetJointProperties)("my_rover::wheel_left_joint")
        self.assertAlmostEqual(position.position[0], 1.0)
        self.assertEqual(spawn_model(BOX, "my_box", xyz=(9, 9, 0), unpause=True), 0)
        wait_until(lambda: sim_time() > before, "time going on")

    def test_wait_for_a_model(self):
        spawn_model(BOX, "my_first")
        self.assertEqual(spawn_model(BOX, "my_second", wait="my_first", xyz=(3, 0, 0)), 0)

    def test_package_to_model(self):
        code = spawn_model(ROVER, "my_rover", True, package_to_model=True)
        self.assertEqual(code, 0)

    def test_the_end_of_a_bond(self):
        spawn_model(BOX, "my_box")
        answer = proxy("delete_model", DeleteModel)(model_name="my_box")
        self.assertEqual(answer.status_message, "DeleteModel: successfully deleted model")

    def test_a_name_that_is_taken_is_exit_code_1(self):
        self.assertEqual(spawn_model(BOX, "my_box"), 0)
        self.assertEqual(spawn_model(BOX, "my_box"), 1)


class LearningEnvironment(unittest.TestCase):
    """Episodes of a robot that is to drive towards a goal."""

    @classmethod
    def setUpClass(cls):
        cls.pause, cls.unpause = proxy("pause_physics", Empty), proxy("unpause_physics", Empty)
        cls.reset_simulation = proxy("reset_simulation", Empty)
        cls.reset_world = proxy("reset_world", Empty)
        cls.set_state = proxy("set_model_state", SetModelState)
        cls.get_state = proxy("get_model_state", GetModelState)
        spawn_model(ROVER, "my_rover", True, (0, 0, 0.01))
        goal = BOX.replace("0.2 0.2 0.2", "0.4 0.4 1")
        spawn_model(goal, "my_goal", xyz=(2, 0, 0.5))
        cls.driver = rospy.Publisher("/cmd_vel", Twist, queue_size=5)
        wait_until(cls.driver.get_num_connections, "the rover's ear")

    @classmethod
    def tearDownClass(cls):
        cls.unpause()
        for name in ("my_rover", "my_goal"):
            proxy("delete_model", DeleteModel)(name)

    def scan(self):
        return rospy.wait_for_message("/scan", LaserScan, timeout=20)

    def step(self, speed, turn=0.0):
        self.unpause()
        self.driver.publish(Twist(Vector3(speed, 0, 0), Vector3(0, 0, turn)))
        scan = self.scan()
        self.pause()
        return scan

    def reset(self, x=0.0):
        self.reset_simulation()
        self.set_state(
            ModelState("my_goal", Pose(Vector3(2 + x, 0, 0.5), Quaternion(w=1)), Twist(), "")
        )
        self.unpause()
        scan = self.scan()
        self.pause()
        return scan

    def test_episodes_begin_alike(self):
        for episode in range(3):
            before = self.reset(x=0.2 * episode)
            self.assertAlmostEqual(before.ranges[90], 1.8 + 0.2 * episode, delta=0.05)
            self.assertLess(before.header.stamp.to_sec(), 5.0)
            self.assertLess(abs(self.get_state("my_rover", "world").pose.position.x), 0.05)
            for _ in range(10):
                after = self.step(0.5)
            self.assertLess(after.ranges[90], before.ranges[90] - 0.2)

    def test_states_set_while_paused_hold(self):
        self.reset()
        self.pause()
        where = Pose(Vector3(-1, 0.5, 0.01), quaternion(0, 0, 0.0))
        answer = self.set_state(ModelState("my_rover", where, Twist(), "world"))
        self.assertEqual(answer.status_message, "SetModelState: set model state done")
        self.assertAlmostEqual(self.get_state("my_rover", "world").pose.position.x, -1.0)
        time = sim_time()
        self.assertEqual(sim_time(), time)
        self.step(0.0)
        self.assertAlmostEqual(
            self.get_state("my_rover", "world").pose.position.x, -1.0, delta=0.02
        )
        self.assertGreater(sim_time(), time)

    def test_the_world_is_reset_without_its_time(self):
        self.reset()
        for _ in range(5):
            self.step(0.5)
        before = sim_time()
        self.reset_world()
        self.assertGreaterEqual(sim_time(), before)
        self.assertLess(abs(self.get_state("my_rover", "world").pose.position.x), 0.05)
        self.step(0.0)

    def test_physics_is_set_up_as_by_openai_ros(self):
        self.pause()
        request = SetPhysicsPropertiesRequest(time_step=0.001, max_update_rate=1000.0)
        request.gravity.z = -9.81
        request.ode_config = ODEPhysics(
            sor_pgs_iters=50,
            sor_pgs_w=1.3,
            contact_max_correcting_vel=100.0,
            erp=0.2,
            max_contacts=20,
        )
        self.assertTrue(proxy("set_physics_properties", SetPhysicsProperties)(request).success)
        self.unpause()
        self.scan()


class Teleporter(unittest.TestCase):
    def test_moves_a_model_by_topic_at_its_own_rate(self):
        spawn_model(BOX, "my_box")
        publisher = rospy.Publisher("/gazebo/set_model_state", ModelState, queue_size=10)
        wait_until(publisher.get_num_connections, "the world's ear")
        with Collector("/gazebo/model_states", ModelStates) as models:
            for i in range(50):
                place = Pose(Vector3(0.1 * i, 1, 0), Quaternion())
                publisher.publish(ModelState("my_box", place, Twist(), "world"))
                rospy.sleep(0.01)
            last = lambda m: m.pose[m.name.index("my_box")].position.x > 4.89  # noqa: E731
            models.first(lambda m: "my_box" in m.name and last(m))
        proxy("delete_model", DeleteModel)("my_box")


if __name__ == "__main__":
    rospy.init_node("test_gazebo_clients")
    rostest.rosrun("warehouse_tests", "gazebo_clients", __name__)
