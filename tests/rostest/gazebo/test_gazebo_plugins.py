#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A robot that was written for Gazebo drives, measures and bumps into things."""

import math
import pathlib
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from rostest_support.node_test import call, wait_until
from rostest_support.warehouse_test import (
    BOX,
    Collector,
    Paused,
    control,
    delete,
    pose,
    sim_time,
    spawn,
    state,
    world_log,
)
from sensor_msgs.msg import Imu, JointState, LaserScan
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from gazebo_msgs.msg import ContactsState
from gazebo_msgs.srv import SpawnModel

URDF = (pathlib.Path(__file__).parents[2] / "worlds" / "rover.urdf").read_text()
WALL = BOX.replace("0.2 0.2 0.2", "0.2 4 2")


def spawn_rover(xml=URDF, namespace="/", where=None):
    answer = call(
        "/gazebo/spawn_urdf_model", SpawnModel, "rover", xml, namespace, where or pose(), ""
    )
    assert answer.success, answer.status_message


def yaw_of(message):
    q = message.pose.pose.orientation
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


class Rover(unittest.TestCase):
    def setUp(self):
        spawn_rover()
        self.driver = rospy.Publisher("/cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        wait_until(self.driver.get_num_connections, "the rover's ear")

    def tearDown(self):
        self.driver.unregister()
        delete("rover")
        delete("box1")

    def drive(self, speed, turn=0.0):
        self.driver.publish(Twist(Vector3(speed, 0, 0), Vector3(0, 0, turn)))

    def test_drives_straight_and_turns_left_for_a_positive_rate(self):
        with Collector("/odom", Odometry) as odom:
            self.drive(0.5)
            there = odom.first(lambda m: m.pose.pose.position.x > 1.0)
            self.assertAlmostEqual(there.twist.twist.linear.x, 0.5, delta=0.03)
            self.assertLess(abs(there.pose.pose.position.y), 0.03)
            self.assertEqual(
                (there.header.frame_id, there.child_frame_id), ("odom", "base_footprint")
            )
            self.drive(0.0, 1.0)
            turned = odom.first(lambda m: yaw_of(m) > 1.0)
            self.assertAlmostEqual(turned.twist.twist.angular.z, 1.0, delta=0.1)
            self.drive(0.0)
            odom.clear()
            still = odom.first(lambda m: abs(m.twist.twist.angular.z) < 0.01)
            self.assertAlmostEqual(
                still.pose.pose.position.x, state("rover").pose.position.x, delta=0.02
            )

    def test_odometry_comes_at_its_rate_with_its_transforms(self):
        with Collector("/odom", Odometry) as odom, Collector("/tf", TFMessage) as tf:
            stamps = [m.header.stamp.to_sec() for m in odom.next(20)]
            gaps = sorted(b - a for a, b in zip(stamps, stamps[1:]))
            self.assertAlmostEqual(gaps[len(gaps) // 2], 1 / 30, delta=0.002)
            tf.first(lambda m: m.transforms[0].child_frame_id == "base_footprint")
            tf.first(lambda m: m.transforms[0].child_frame_id == "wheel_left_link")

    def test_the_laser_sees_a_wall_and_not_its_own_robot(self):
        spawn("box1", WALL, pose(2.0))
        with Collector("/scan", LaserScan) as scans:
            scan = scans.next(3)[-1]
        self.assertEqual((len(scan.ranges), scan.header.frame_id), (181, "base_scan"))
        self.assertAlmostEqual(scan.ranges[90], 1.9, delta=0.02)
        self.assertEqual(scan.ranges[0], math.inf)
        self.assertAlmostEqual(scan.angle_min, -math.pi / 2, places=5)
        self.assertAlmostEqual(scan.angle_increment, math.pi / 180, places=6)
        self.assertAlmostEqual(scan.range_max, 3.5, places=5)

    def test_the_imu_feels_turns_and_starts(self):
        call("/imu_service", Empty)
        with Collector("/imu", Imu) as imu:
            rest = imu.next(50)[-1]
            # As in Gazebo: a fixed link without mass is merged, and its frames with it.
            self.assertEqual(rest.header.frame_id, "base_footprint")
            self.assertLess(abs(rest.linear_acceleration.z), 0.2)
            self.drive(0.5)
            imu.first(lambda m: m.linear_acceleration.x > 0.5)
            self.drive(0.0, 1.0)
            imu.first(lambda m: abs(m.angular_velocity.z - 1.0) < 0.1)
            imu.first(lambda m: m.orientation.z > 0.4)

    def test_the_bumper_feels_a_wall(self):
        spawn("box1", WALL, pose(0.6))
        with Collector("/bumper", ContactsState) as bumper:
            self.assertEqual(bumper.next(5)[-1].states, [])
            self.drive(0.3)
            touch = bumper.first(lambda m: m.states).states[0]
        self.assertIn("rover::", touch.collision1_name)
        self.assertEqual(touch.collision2_name, "box1::link::body")
        self.assertGreater(len(touch.depths), 0)
        self.assertAlmostEqual(touch.contact_normals[0].x, -1.0, places=2)
        self.assertAlmostEqual(touch.contact_positions[0].x, 0.5, delta=0.03)

    def test_joint_states(self):
        with Collector("/rover/joint_states", JointState) as joints:
            self.drive(0.25)
            message = joints.first(lambda m: m.position[0] > 5)
        self.assertEqual(message.name, ["wheel_left_joint", "wheel_right_joint"])
        self.assertAlmostEqual(message.velocity[0], 5.0, delta=0.5)
        self.assertAlmostEqual(message.position[1], message.position[0], delta=0.3)

    def test_everything_goes_on_after_a_reset(self):
        self.drive(0.5)
        wait_until(lambda: state("rover").pose.position.x > 0.3, "the rover on its way")
        topics = {"/odom": Odometry, "/scan": LaserScan, "/imu": Imu}
        collectors = {topic: Collector(topic, kind) for topic, kind in topics.items()}
        wait_until(lambda: sim_time() > 2, "time going on")
        with Paused():
            control("reset_simulation")
            self.assertEqual(sim_time(), 0.0)
            for collector in collectors.values():
                collector.clear()
        for collector in collectors.values():
            collector.first(lambda m: m.header.stamp.to_sec() < 1.5)
            collector.close()
        self.assertLess(abs(state("rover").pose.position.x), 0.05)
        self.drive(0.5)
        wait_until(lambda: state("rover").pose.position.x > 0.3, "the rover on its way again")


class Spawning(unittest.TestCase):
    def tearDown(self):
        delete("rover")

    def test_a_plugin_that_nobody_knows_is_one_warning_that_names_it(self):
        log = world_log()
        # The world warns of each unknown plugin once: this test uses one that no other does.
        spawn_rover(URDF.replace("teapot", "kettle"))
        warning = log.first(lambda m: "libgazebo_ros_kettle.so" in m.msg)
        self.assertEqual(warning.level, Log.WARN)
        self.assertTrue(state("rover").success)

    def test_a_namespace_holds_for_every_plugin_without_one(self):
        spawn_rover(namespace="/mine")
        with Collector("/mine/odom", Odometry) as odom, Collector("/mine/scan", LaserScan) as scan:
            odom.first()
            self.assertEqual(scan.first().header.frame_id, "mine/base_scan")
        with Collector("/rover/joint_states", JointState) as joints:
            joints.first()

    def test_a_second_robot_of_one_description_has_frames_of_its_own(self):
        spawn_rover()
        self.addCleanup(delete, "rover2")
        answer = call(
            "/gazebo/spawn_urdf_model", SpawnModel, "rover2", URDF, "/second", pose(y=5.0), ""
        )
        self.assertTrue(answer.success, answer.status_message)
        with Collector("/second/odom", Odometry) as odom, Collector("/tf", TFMessage) as tf:
            second = odom.first()
            names = (second.header.frame_id, second.child_frame_id)
            self.assertEqual(names, ("rover2/odom", "rover2/base_footprint"))
            places = {
                (t.header.frame_id, t.child_frame_id): t.transform.translation.y
                for message in tf.next(200)
                for t in message.transforms
            }
        self.assertAlmostEqual(places["odom", "base_footprint"], 0, 1)
        self.assertAlmostEqual(places["rover2/odom", "rover2/base_footprint"], 5, 1)

    def test_without_a_namespace_each_plugin_has_that_of_gazebo_ros(self):
        spawn_rover(namespace="")
        topics = {"/rover/odom": Odometry, "/rover/joint_states": JointState}
        topics |= {"/scan": LaserScan, "/imu": Imu, "/bumper": ContactsState}
        for topic, kind in topics.items():
            with Collector(topic, kind) as collector:
                collector.first()
        driver = rospy.Publisher("/rover/cmd_vel", Twist, queue_size=1)
        wait_until(driver.get_num_connections, "the rover's ear")
        driver.unregister()

    def test_faulty_parameters_cost_the_plugin_and_not_the_model(self):
        faults = {
            "<leftJoint>wheel_left_joint": "<leftJoint>nothing",
            "<wheelTorque>10": "<wheelTorque>x",
        }
        for good, bad in faults.items():
            log = world_log()
            spawn_rover(URDF.replace(good, bad))
            log.first(lambda m: "plugin 'drive': the plugin is left out" in m.msg)
            self.assertTrue(state("rover").success)
            delete("rover")


if __name__ == "__main__":
    rospy.init_node("test_gazebo_plugins")
    rostest.rosrun("warehouse_tests", "gazebo_plugins", __name__)
