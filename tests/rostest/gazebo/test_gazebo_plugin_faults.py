#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Gazebo's plugins in models of one link; a faulty one costs itself and a warning that helps."""

import math
import pathlib
import unittest

import rospy
import rostest
from geometry_msgs.msg import Vector3, Wrench
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from rostest_support.node_test import call, wait_until
from rostest_support.warehouse_test import Collector, delete, pose, state, world_log
from sensor_msgs.msg import LaserScan

from gazebo_msgs.srv import SpawnModel

ROBOTS = pathlib.Path(__file__).parents[2] / "worlds" / "robots"
GRAVITY = 9.81  # [m/s²]

WEIGHT = """<sdf version="1.6"><model name="weight"><link name="link">
  <inertial><mass>2</mass></inertial>
  <collision name="body"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
</link>%s</model></sdf>"""
PLUGIN = '<plugin name="%s" filename="libgazebo_ros_%s.so">%s</plugin>'
P3D = "<bodyName>link</bodyName><topicName>truth</topicName>"


class Plugins(unittest.TestCase):
    def tearDown(self):
        delete("weight")

    def spawn(self, *plugins, sensors=""):
        xml = (WEIGHT % "".join(PLUGIN % plugin for plugin in plugins)).replace(
            "</link>", sensors + "</link>"
        )
        answer = call("/gazebo/spawn_sdf_model", SpawnModel, "weight", xml, "", pose(z=0.1), "")
        self.assertTrue(answer.success, answer.status_message)

    def test_a_tilted_laser_meets_the_floor(self):
        sensor = (
            '<sensor name="s" type="ray"><pose>0 0 0 0 0.785398 0</pose><ray><scan><horizontal>'
            "<samples>3</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal>"
            "</scan><range><min>0.01</min><max>5</max></range></ray>%s</sensor>"
        )
        laser = PLUGIN % ("laser", "gpu_laser", "<topicName>tilted</topicName>")
        self.spawn(sensors=sensor % laser)
        with Collector("/tilted", LaserScan) as scans:
            ranges = scans.next(3)[-1].ranges
        self.assertAlmostEqual(ranges[1], 0.1 * math.sqrt(2), delta=0.01)

    def test_a_force_lasts_until_the_next(self):
        force = ("push", "force", "<bodyName>link</bodyName><topicName>push</topicName>")
        self.spawn(force, ("truth", "p3d", P3D))
        pusher = rospy.Publisher("/push", Wrench, queue_size=1, tcp_nodelay=True)
        wait_until(pusher.get_num_connections, "the weight's ear")
        with Collector("/truth", Odometry) as truth:
            pusher.publish(Wrench(force=Vector3(0, 0, 4 * GRAVITY)))
            truth.first(lambda m: m.pose.pose.position.z > 2)
            pusher.publish(Wrench())
            truth.first(lambda m: m.twist.twist.linear.z < -1)
        pusher.unregister()

    def warning_of(self, log, name, text):
        """The warning about the plugin of that name that has that text."""
        record = log.first(lambda m: f"'{name}'" in m.msg and text in m.msg)
        self.assertEqual(record.level, Log.WARN)
        return record.msg

    def test_what_is_lacking_is_told_with_what_to_do(self):
        xml = (ROBOTS / "controllers.urdf").read_text()
        log = world_log()
        call("/gazebo/spawn_urdf_model", SpawnModel, "weight", xml, "", pose(), "")
        control = self.warning_of(log, "gazebo_ros_control", "libgazebo_ros_diff_drive.so")
        self.assertIn("'weight'", control)
        self.warning_of(log, "camera_controller", "nothing is rendered here")
        self.assertTrue(state("weight").success)

    def test_a_faulty_parameter_costs_its_plugin_and_is_told(self):
        topic = "<topicName>t</topicName>"
        body = "<bodyName>link</bodyName>"
        faults = {
            ("p3d", body): "<topicName>",
            ("p3d", topic): "<bodyName>",
            ("p3d", topic + "<bodyName>leg</bodyName>"): "'leg'",
            ("p3d", topic + body + "<updateRate>nan</updateRate>"): "updateRate",
            ("p3d", topic + body + "<updateRate>-5</updateRate>"): "updateRate",
            ("p3d", topic + body + "<xyzOffset>0 0</xyzOffset>"): "xyzOffset",
            ("p3d", "<topicName>a b</topicName>" + body): "a b",
            ("p3d", "<topicName>/clock</topicName>" + body): "another type",
            ("force", topic): "<bodyName>",
            ("ft_sensor", topic + "<jointName>hip</jointName>"): "'hip'",
            ("planar_move", "<odometryRate>x</odometryRate>"): "odometryRate",
            ("skid_steer_drive", "<torque>5</torque>"): "<leftFrontJoint>",
            ("imu_sensor", "<frameName>f</frameName>"): "<sensor>",
            ("range", topic): "<sensor>",
            ("block_laser", topic): "<sensor>",
            ("openni_kinect", topic): "<sensor>",
        }
        for number, ((plugin, parameters), text) in enumerate(faults.items()):
            name = f"p{number}"
            log = world_log()
            self.spawn((name, plugin, parameters))
            message = self.warning_of(log, name, text)
            self.assertIn("the plugin is left out", message)
            self.assertTrue(state("weight").success)
            delete("weight")

    def test_a_huge_image_costs_its_camera(self):
        camera = (
            '<sensor name="eye" type="depth"><camera><image><width>20000</width>'
            "<height>20000</height></image></camera>%s</sensor>"
        )
        sensor = camera % (PLUGIN % ("eye_plugin", "depth_camera", ""))
        log = world_log()
        self.spawn(sensors=sensor)
        message = self.warning_of(log, "eye_plugin", "everyNthPixel")
        self.assertIn("20000 x 20000", message)


if __name__ == "__main__":
    rospy.init_node("test_gazebo_plugin_faults")
    rostest.rosrun("warehouse_tests", "gazebo_plugin_faults", __name__)
