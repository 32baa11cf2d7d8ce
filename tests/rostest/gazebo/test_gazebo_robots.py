#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Robots of the kinds that people bring drive and measure by the plugins that they name."""

import math
import pathlib
import struct
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist, Vector3, WrenchStamped
from nav_msgs.msg import Odometry
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
    step_until,
)
from sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan, PointCloud, PointCloud2, Range
from sensor_msgs.point_cloud2 import read_points
from tf2_msgs.msg import TFMessage

from gazebo_msgs.srv import SpawnModel
from warehouse_msgs.srv import Checkpoint

ROBOTS = pathlib.Path(__file__).parents[2] / "worlds" / "robots"
WALL = BOX.replace("0.2 0.2 0.2", "0.2 6 4")
GRAVITY = 9.81  # [m/s²]


def yaw_of(message):
    q = message.pose.pose.orientation
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


class Robot(unittest.TestCase):
    """Spawned into the namespace /bot."""

    file = None

    def setUp(self):
        if self.file is None:
            self.skipTest("a base class")
        xml = (ROBOTS / self.file).read_text()
        kind = "sdf" if self.file.endswith(".sdf") else "urdf"
        service = f"/gazebo/spawn_{kind}_model"
        answer = call(service, SpawnModel, "bot", xml, "/bot", pose(), "")
        self.assertTrue(answer.success, answer.status_message)
        self.driver = rospy.Publisher("/bot/cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        wait_until(self.driver.get_num_connections, "the robot's ear")

    def tearDown(self):
        self.driver.unregister()
        delete("bot")
        delete("wall")

    def drive(self, ahead, turn=0.0, aside=0.0):
        self.driver.publish(Twist(Vector3(ahead, aside, 0), Vector3(0, 0, turn)))

    def truth(self):
        return Collector("/bot/ground_truth/state", Odometry)

    def check_odometry(self, tolerance):
        """Odometry and truth of the same moment agree."""
        with self.truth() as truth, Collector("/bot/odom", Odometry) as odom:
            odometry = {}

            def is_paired(message):
                odometry[message.header.stamp] = message
                return any(m.header.stamp in odometry for m in truth.messages)

            pose = odom.first(is_paired)
            true = truth.first(lambda m: m.header.stamp in odometry)
            pose = odometry[true.header.stamp]
        self.assertEqual((pose.header.frame_id, pose.child_frame_id), ("odom", "base_footprint"))
        for axis in "xy":
            at, is_at = (getattr(m.pose.pose.position, axis) for m in (pose, true))
            self.assertAlmostEqual(at, is_at, delta=tolerance)
        self.assertAlmostEqual(math.remainder(yaw_of(pose) - yaw_of(true), math.tau), 0, delta=0.1)

    def check_transform(self):
        with Collector("/tf", TFMessage) as tf:
            transform = tf.first(lambda m: m.transforms[0].child_frame_id == "base_footprint")
        self.assertEqual(transform.transforms[0].header.frame_id, "odom")

    def check_checkpoint(self, *command):
        """A robot restored to a checkpoint on its way drives on as it did, bit by bit."""
        self.drive(*command)
        wait_until(lambda: state("bot").pose.position.x > 0.2, "the robot on its way")
        with Paused():
            self.assertTrue(call("/warehouse/checkpoint", Checkpoint, "bot").success)
            ends = []
            for _ in range(2):
                self.assertTrue(call("/warehouse/restore", Checkpoint, "bot").success)
                step_until(sim_time() + 1.0)
                ends.append(state("bot"))
        self.assertEqual((ends[0].pose, ends[0].twist), (ends[1].pose, ends[1].twist))
        self.assertGreater(abs(ends[0].twist.linear.x), 0.2)

    def check_reset(self):
        """A reset ends its command, and sensors go on."""
        self.drive(0.5)
        wait_until(lambda: state("bot").pose.position.x > 0.5, "the robot on its way")
        with self.truth() as truth:
            control("reset_simulation")
            truth.first(lambda m: m.header.stamp.to_sec() < 0.5)
            still = truth.first(lambda m: 0.5 < m.header.stamp.to_sec() < 2)
            self.assertLess(abs(still.pose.pose.position.x), 0.05)
            self.drive(0.5)
            truth.first(lambda m: m.pose.pose.position.x > 0.3)

    def check_imu(self, topic):
        with Collector(topic, Imu) as imu:
            message = imu.next(20)[-1]
        self.assertEqual(message.header.frame_id, "imu_link")
        self.assertAlmostEqual(message.linear_acceleration.z, GRAVITY, delta=0.5)
        self.assertAlmostEqual(message.orientation.w, 1.0, delta=0.01)


class FourWheels(Robot):
    file = "four_wheels.urdf"

    def test_drives_some_metres_and_turns_by_skidding(self):
        with self.truth() as truth:
            self.drive(1.0)
            there = truth.first(lambda m: m.pose.pose.position.x > 3)
            self.assertEqual((there.header.frame_id, there.child_frame_id[:4]), ("world", "base"))
            self.assertAlmostEqual(there.twist.twist.linear.x, 1.0, delta=0.05)
            self.assertLess(abs(there.pose.pose.position.y), 0.05)
            self.check_odometry(0.01)
            self.check_transform()
            self.drive(0.0, 1.0)
            truth.first(lambda m: yaw_of(m) > 1.0)
            turning = truth.messages[-1].twist.twist.angular.z
            self.assertTrue(0.3 < turning < 1.1, f"turns by {turning} rad/s")
            self.drive(0.0)

    def test_measures(self):
        spawn("wall", WALL, pose(3.0))
        self.check_imu("/bot/imu/data")
        with Collector("/bot/scan", LaserScan) as scan:
            self.assertAlmostEqual(scan.first().ranges[90], 2.6, delta=0.02)

    def test_goes_on_the_same_from_a_checkpoint(self):
        self.check_checkpoint(0.8, 0.5)

    def test_stands_after_a_reset_and_drives_again(self):
        self.check_reset()


class Platform(Robot):
    file = "platform.urdf"

    def test_drives_some_metres_and_turns_by_its_encoders(self):
        with self.truth() as truth:
            self.drive(0.8)
            truth.first(lambda m: m.pose.pose.position.x > 2.5)
            self.check_odometry(0.05)
            self.drive(0.0, 0.8)
            truth.first(lambda m: yaw_of(m) > 1.5)
            self.drive(0.5)
            truth.first(lambda m: m.pose.pose.position.y > 1.0)
            self.check_odometry(0.15)
            self.check_transform()

    def test_measures(self):
        spawn("wall", WALL, pose(3.0))
        self.check_imu("/bot/imu_data")
        # The first laser looks 45 degrees to the left, the second away from it.
        with Collector("/bot/f_scan", LaserScan) as front:
            scan = front.first()
        self.assertEqual(scan.header.frame_id, "bot/front_laser_link")
        self.assertAlmostEqual(scan.ranges[135 - 45], 2.48, delta=0.03)
        with Collector("/bot/b_scan", LaserScan) as back:
            self.assertEqual(back.first().ranges[135], math.inf)


class Slider(Robot):
    file = "slider.urdf"

    def test_slides_in_any_direction(self):
        with self.truth() as truth:
            self.drive(0.3, aside=0.6)
            there = truth.first(lambda m: m.pose.pose.position.y > 2)
            self.assertAlmostEqual(there.pose.pose.position.x, 1.0, delta=0.1)
            self.assertAlmostEqual(there.twist.twist.linear.y, 0.6, delta=0.03)
            self.check_odometry(0.01)
            self.check_transform()
            self.drive(0.0, 1.0)
            truth.first(lambda m: yaw_of(m) > 1.0)
            self.assertAlmostEqual(truth.messages[-1].twist.twist.angular.z, 1.0, delta=0.05)
            self.drive(0.0)
            with Collector("/bot/odom", Odometry) as odom:
                odom.first(lambda m: abs(m.twist.twist.angular.z) < 0.01)

    def test_goes_on_the_same_from_a_checkpoint(self):
        self.check_checkpoint(0.5, 0.3, 0.2)

    def test_stands_after_a_reset_and_drives_again(self):
        self.check_reset()

    def test_the_sonar_tells_the_nearest_of_its_rays(self):
        with Collector("/bot/sonar", Range) as sonar:
            # Its lowest rays meet the floor.
            floor = 0.15 / math.sin(0.05)
            self.assertAlmostEqual(sonar.first().range, floor, delta=0.1)
            spawn("wall", WALL, pose(2.0))
            message = sonar.first(lambda m: m.range < 2)
        self.assertAlmostEqual(message.range, 1.59, delta=0.02)
        self.assertEqual(message.radiation_type, Range.INFRARED)
        self.assertEqual(message.header.frame_id, "sonar_link")
        self.assertAlmostEqual(message.field_of_view, 0.2, places=5)
        self.assertAlmostEqual(message.min_range, 0.02, places=5)

    def test_lidars_of_several_layers_see_wall_and_floor(self):
        spawn("wall", WALL, pose(3.0))
        with Collector("/bot/cloud", PointCloud) as clouds:
            cloud = clouds.next(2)[-1]
        self.assertEqual((len(cloud.points), cloud.header.frame_id), (4 * 91, "lidar_link"))
        level = cloud.points[3 * 91 + 45]
        self.assertAlmostEqual(level.x, 2.9, delta=0.02)
        self.assertAlmostEqual(level.z, 0.0, delta=0.02)
        lowest = cloud.points[45]
        self.assertAlmostEqual(lowest.z, -0.45, delta=0.02)
        with Collector("/bot/velodyne_points", PointCloud2) as clouds:
            points = list(read_points(clouds.next(2)[-1], ("x", "y", "z", "ring")))
        ahead = [p for p in points if p[0] > 2.86 and abs(p[1]) < 0.03]
        self.assertEqual(sorted({p[3] for p in ahead}), list(range(4, 16)))
        for x, _, z, ring in ahead:
            self.assertAlmostEqual(x, 2.9, delta=0.02)
            self.assertAlmostEqual(z, x * math.tan(math.radians(2 * ring - 15)), delta=0.06)
        self.assertTrue(all(math.hypot(*p[:3]) >= 0.9 for p in points))

    def test_the_mast_leans_on_its_foot(self):
        with Collector("/bot/foot", WrenchStamped) as foot:
            message = foot.next(50)[-1]
        self.assertEqual(message.header.frame_id, "mast")
        # As Gazebo tells it: what the child does to its parent.
        self.assertAlmostEqual(message.wrench.force.z, -2 * GRAVITY, delta=0.5)
        self.assertAlmostEqual(message.wrench.torque.y, 0.1 * 2 * GRAVITY, delta=0.2)


class Waffle(Robot):
    file = "waffle.sdf"
    near = 0.836  # [m] from the camera to the wall

    def test_drives(self):
        with self.truth() as truth:
            self.drive(0.4)
            truth.first(lambda m: m.pose.pose.position.x > 1.0)
            self.check_odometry(0.01)
            self.drive(0.0, 1.0)
            truth.first(lambda m: yaw_of(m) > 1.0)

    def test_the_depth_camera_sees_wall_and_floor(self):
        spawn("wall", WALL, pose(1.0))
        with Collector("/bot/camera/depth/image_raw", Image) as images:
            image = images.next(2)[-1]
        self.assertEqual((image.width, image.height, image.encoding), (160, 120, "32FC1"))
        self.assertEqual(image.header.frame_id, "bot/camera_depth_optical_frame")
        depth = struct.unpack(f"<{160 * 120}f", image.data)
        # The wall is flat: as deep at the edge as in the middle. Below it there is floor.
        for column in (0, 80, 159):
            self.assertAlmostEqual(depth[60 * 160 + column], self.near, delta=0.03)
        floor = 0.107 * 80 / math.tan(math.radians(30)) / 40.5
        self.assertAlmostEqual(depth[100 * 160 + 80], floor, delta=0.02)

    def test_the_cloud_is_in_the_optical_frame(self):
        spawn("wall", WALL, pose(1.0))
        with Collector("/bot/camera/depth/points", PointCloud2) as clouds:
            cloud = clouds.next(2)[-1]
        self.assertEqual((cloud.width, cloud.height, cloud.point_step), (160, 120, 32))
        points = list(read_points(cloud, ("x", "y", "z")))
        left, right = points[60 * 160], points[60 * 160 + 159]
        self.assertAlmostEqual(left[0], -self.near * math.tan(math.radians(30)), delta=0.03)
        self.assertAlmostEqual(right[0], -left[0], delta=0.03)
        self.assertAlmostEqual(left[2], self.near, delta=0.03)
        self.assertAlmostEqual(points[100 * 160 + 80][1], 0.107, delta=0.01)
        with Collector("/bot/camera/depth/camera_info", CameraInfo) as infos:
            info = infos.first()
        self.assertAlmostEqual(info.K[0], 80 / math.tan(math.radians(30)), places=2)
        self.assertEqual((info.width, info.height), (160, 120))

    def test_nothing_nearer_or_farther_than_its_cutoffs_has_a_depth(self):
        spawn("wall", WALL, pose(0.4))
        with Collector("/bot/camera/depth/image_raw", Image) as images:
            image = images.next(2)[-1]
        depth = struct.unpack(f"<{160 * 120}f", image.data)
        self.assertTrue(math.isnan(depth[60 * 160 + 80]))


if __name__ == "__main__":
    rospy.init_node("test_gazebo_robots")
    rostest.rosrun("warehouse_tests", "gazebo_robots", __name__)
