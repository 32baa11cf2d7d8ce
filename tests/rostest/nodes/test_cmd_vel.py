#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A Kiva that is driven by cmd_vel: its frames and odometry, the map, what it refuses, and the
example that drives it through a warehouse."""

import math
import re
import subprocess
import unittest
from pathlib import Path

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from nav_msgs.srv import GetMap
from rostest_support.node_test import PATIENCE, Listener, call, latched, wait_until

from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import GetModelState, SetModelState
from warehouse_msgs.msg import CoordinatorState, Event, KivaStatus, MoveAlong
from warehouse_msgs.srv import SetCmdVel, SetRobotMode, SetRobotModeRequest

FOLLOW = Path(__file__).resolve().parents[3] / "examples" / "pure_pursuit" / "follow.py"
HALF_LENGTH = 0.38  # of a Kiva [m]


def follow(*args):
    """(exit code, what it says) of the example."""
    done = subprocess.run(
        ["/usr/bin/python3", FOLLOW, *map(str, args)],
        capture_output=True,
        text=True,
        timeout=3 * PATIENCE,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


def truth(model):
    """(x, y, yaw) of a model in the world."""
    pose = call("/gazebo/get_model_state", GetModelState, model, "").pose
    yaw = 2 * math.atan2(pose.orientation.z, pose.orientation.w)
    return pose.position.x, pose.position.y, yaw


def put(model, x, y, yaw=0.0):
    """Puts a model somewhere by hand."""
    state = ModelState(model_name=model)
    state.pose.position.x, state.pose.position.y = x, y
    state.pose.orientation.z, state.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    answer = call("/gazebo/set_model_state", SetModelState, state)
    assert answer.success, answer.status_message


def set_cmd_vel(kiva_id, enable):
    return call("/warehouse/set_cmd_vel", SetCmdVel, kiva_id, enable)


def steered(kiva_id=1):
    """Waits until it takes velocities and stands; hands it over if need be."""
    status = latched(f"/kiva{kiva_id}/status", KivaStatus)
    if status.status == KivaStatus.STATUS_IDLE:
        assert set_cmd_vel(kiva_id, True).success
    latched(f"/kiva{kiva_id}/status", KivaStatus, lambda m: m.state == KivaStatus.STATE_STEERED)


def cell(grid, x, y):
    column = math.floor((x - grid.info.origin.position.x) / grid.info.resolution)
    row = math.floor((y - grid.info.origin.position.y) / grid.info.resolution)
    return grid.data[row * grid.info.width + column]


class CmdVel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.events = Listener("/warehouse/events", Event)
        cls.frames = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.frames)
        cls.speeds = rospy.Publisher("/kiva1/cmd_vel", Twist, queue_size=1)
        latched("/warehouse/coordinator", CoordinatorState, lambda m: m.automatic + m.manual == 4)
        wait_until(cls.speeds.get_num_connections, "the robot hears cmd_vel")

    def setUp(self):
        steered()
        put("kiva1", 2, 0)

    def drive(self, speed, turn_rate, seconds):
        """Asks for that velocity for a simulated duration [s]."""
        twist = Twist()
        twist.linear.x, twist.angular.z = speed, turn_rate
        end = rospy.get_time() + seconds
        while rospy.get_time() < end:
            self.speeds.publish(twist)
            rospy.sleep(0.05)

    def heard(self, kind, text):
        """The first event of kiva1 of that kind with that text."""

        def first():
            events = [e for e in self.events.messages if (e.model, e.kind) == ("kiva1", kind)]
            return next((event for event in events if text in event.text), None)

        wait_until(first, f"an event with '{text}'")
        return first()

    # --- frames, odometry, map

    def test_its_frames_lead_from_the_map_over_its_own_odometry(self):
        odometry = Listener("/kiva1/odom", Odometry)
        self.drive(0.4, 0.3, 1.5)
        self.drive(0, 0, 1.5)
        at = self.frames.lookup_transform("map", "kiva1/base_link", rospy.Time(), rospy.Duration(5))
        x, y, yaw = truth("kiva1")
        self.assertAlmostEqual(at.transform.translation.x, x, 3)
        self.assertAlmostEqual(at.transform.translation.y, y, 3)
        local = self.frames.lookup_transform(
            "kiva1/odom", "kiva1/base_link", rospy.Time()
        ).transform
        message = odometry.until(lambda m: abs(m.twist.twist.linear.x) < 1e-6)
        self.assertEqual(message.header.frame_id, "kiva1/odom")
        self.assertEqual(message.child_frame_id, "kiva1/base_link")
        self.assertAlmostEqual(message.pose.pose.position.x, local.translation.x, 3)
        world = self.frames.lookup_transform("world", "map", rospy.Time()).transform
        self.assertEqual((world.translation.x, world.rotation.w), (0, 1))
        # Another robot has no odometry of its own: world -> kiva2/base_link, as ever.
        self.assertIn("kiva2/base_link", self.frames.all_frames_as_string())
        self.assertNotIn("kiva2/odom", self.frames.all_frames_as_string())

    def test_the_map_shows_belts_and_legs_where_lasers_see_them(self):
        grid = latched("/map", OccupancyGrid)
        self.assertEqual(grid.header.frame_id, "map")
        self.assertAlmostEqual(grid.info.resolution, 0.05, 6)
        x, y, _ = truth("storage_unit1")
        self.assertEqual(cell(grid, x + 0.38, y + 0.38), 100)  # a leg
        self.assertEqual(cell(grid, x, y), 0)  # between the legs
        x, y, _ = truth("conveyor_belt1")
        self.assertEqual(cell(grid, x, y), 100)
        self.assertEqual(cell(grid, *truth("kiva2")[:2]), 0)  # robots are no part of it
        self.assertEqual(cell(grid, grid.info.origin.position.x + 0.1, 0), -1)  # off the floor
        now = call("/static_map", GetMap).map
        self.assertEqual((now.info.width, now.data), (grid.info.width, grid.data))

    # --- what it refuses

    def test_commands_along_the_grid_are_refused_with_a_way_out(self):
        topic = rospy.Publisher("/movx", MoveAlong, queue_size=1)
        wait_until(topic.get_num_connections, "the world listens")
        topic.publish(1.0, 1)
        self.heard(Event.REFUSED, "it is driven by /kiva1/cmd_vel: give it back to the grid first")

    def test_the_coordinator_leaves_it_alone(self):
        latched("/warehouse/coordinator", CoordinatorState, lambda m: 1 in m.manual_kiva)
        answer = call("/warehouse/set_robot_mode", SetRobotMode, 1, SetRobotModeRequest.AUTOMATIC)
        self.assertFalse(answer.success)
        self.assertIn("kiva1 is driven by /kiva1/cmd_vel", answer.message)

    def test_a_velocity_that_is_not_finite_is_refused_and_does_not_move_it(self):
        before = truth("kiva1")
        self.drive(math.nan, 0, 0.5)
        self.heard(Event.REFUSED, "cmd_vel of kiva1: a velocity of nan m/s")
        self.assertLess(math.dist(before[:2], truth("kiva1")[:2]), 1e-3)

    def test_it_stops_when_nothing_is_heard_any_more(self):
        self.drive(0.5, 0, 1)
        rospy.sleep(1.5)
        before = truth("kiva1")
        rospy.sleep(0.5)
        self.assertLess(math.dist(before[:2], truth("kiva1")[:2]), 1e-6)

    def test_it_is_given_back_on_a_grid_point_and_drives_along_the_grid_then(self):
        put("kiva1", 2.3, 0, 0.4)
        answer = set_cmd_vel(1, False)
        self.assertFalse(answer.success)
        self.assertIn("0.30 m off the grid point (2, 0) and 23° off", answer.message)
        put("kiva1", 2.02, 0)
        answer = set_cmd_vel(1, False)
        self.assertTrue(answer.success, answer.message)
        topic = rospy.Publisher("/movx", MoveAlong, queue_size=1)
        wait_until(topic.get_num_connections, "the world listens")
        topic.publish(1.0, 1)
        latched("/kiva1/status", KivaStatus, lambda m: m.state == 0 and abs(m.pose.x - 3) < 1e-3)
        self.assertIn("there is no robot kiva77", set_cmd_vel(77, True).message)

    # --- the example

    def test_the_example_drives_it_to_its_aim_within_three_centimetres(self):
        code, said = follow("kiva1", 2, 2, 5, 2, 5, -1)
        self.assertEqual(code, 0, said)
        x, y, _ = truth("kiva1")
        self.assertLess(math.dist((x, y), (5, -1)), 0.03, said)
        self.assertRegex(said, r"kiva1 is at 5\.0\d\d|kiva1 is at 4\.9\d\d")

    def test_the_example_gives_it_back_to_the_grid(self):
        code, said = follow("kiva1", 4, 0, 4, 3, "--grid")
        self.assertEqual(code, 0, said)
        latched("/kiva1/status", KivaStatus, lambda m: m.status == KivaStatus.STATUS_IDLE)
        self.assertEqual(latched("/kiva1/status", KivaStatus).status, KivaStatus.STATUS_IDLE)

    def test_it_stops_before_another_robot_that_the_map_does_not_show(self):
        put("kiva2", 5, 0, math.pi / 2)
        self.addCleanup(put, "kiva2", -9, -4)
        code, said = follow("kiva1", 8, 0)
        self.assertEqual(code, 1)
        self.assertTrue(re.search(r"gets no farther, \d\.\d\d m before the end", said), said)
        event = self.heard(Event.BLOCKED, "kiva2 is in the way")
        self.assertEqual(event.other, "kiva2")
        gap = truth("kiva2")[0] - truth("kiva1")[0] - HALF_LENGTH - 0.32
        self.assertAlmostEqual(gap, 0.05, delta=0.01)
        hit = [e for e in self.events.messages if e.kind == Event.COLLISION]
        self.assertEqual(hit, [])

    def test_the_example_names_what_of_the_map_is_in_its_way(self):
        x, y, _ = truth("conveyor_belt1")
        code, said = follow("kiva1", x, y)
        self.assertEqual(code, 1)
        self.assertIn("the way is not free at", said)


if __name__ == "__main__":
    rospy.init_node("test_cmd_vel")
    rostest.rosrun("warehouse_tests", "cmd_vel", CmdVel)
