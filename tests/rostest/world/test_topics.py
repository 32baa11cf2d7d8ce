#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What the world publishes: rates, frames, latching."""

import math
import unittest

import rospy
import rostest
import tf2_ros
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from rostest_support.node_test import call, latched, wait_until
from rostest_support.warehouse_test import (
    Collector,
    Commander,
    Paused,
    control,
    delete,
    model_file,
    place,
    pose,
    sim_time,
    spawn,
    step_until,
    world,
)
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from gazebo_msgs.msg import ModelState, ModelStates, PerformanceMetrics
from gazebo_msgs.srv import SetModelState
from warehouse_msgs.msg import (
    Event,
    FleetState,
    KivaStatus,
    Lift,
    UnitStates,
    WarehouseObjects,
)


def seconds(stamps):
    """Time between neighbours, rounded to the step."""
    times = [stamp.to_sec() for stamp in stamps]
    return [round(b - a, 3) for a, b in zip(times, times[1:])]


def usual(values):
    """The median: under load the world may leave one out."""
    return sorted(values)[len(values) // 2]


def put(name, where):
    call("/gazebo/set_model_state", SetModelState, ModelState(name, where, None, ""))


class Rates(unittest.TestCase):
    def usual_gap(self, topic, kind, stamp, number):
        with Collector(topic, kind) as collector:
            gaps = seconds(map(stamp, collector.next(number)))
        self.assertGreater(min(gaps), 0)
        return usual(gaps)

    def test_clock(self):
        gap = self.usual_gap("/clock", Clock, lambda m: m.clock, 100)
        self.assertEqual(gap, 0.01)

    def test_the_pace_is_told(self):
        """Checks the rate that the world measured: a busy machine is late, never early for long."""
        with Collector("/gazebo/performance_metrics", PerformanceMetrics) as metrics:
            pace = metrics.first(lambda m: m.real_time_factor > 0).real_time_factor
        self.assertLess(pace, 1.15)

    def test_of_one_robot(self):
        def stamp(message):
            return message.header.stamp

        self.assertEqual(self.usual_gap("/kiva1/odom", Odometry, stamp, 20), 0.05)
        scan = "/kiva1/chassis/laser/scan"
        self.assertEqual(self.usual_gap(scan, LaserScan, stamp, 10), 0.1)
        self.assertLessEqual(self.usual_gap("/kiva1/status", KivaStatus, stamp, 3), 1.0)

    def test_of_all_robots(self):
        self.assertEqual(self.usual_gap("/warehouse/fleet", FleetState, lambda m: m.stamp, 10), 0.1)
        moving = self.usual_gap("/tf", TFMessage, lambda m: m.transforms[0].header.stamp, 20)
        self.assertEqual(moving, 0.05)

    def test_model_states_under_both_names(self):
        for topic in ("/model_states", "/gazebo/model_states"):
            with Paused(), Collector(topic, ModelStates) as models:
                step_until(sim_time() + 1.0)
                models.wait_for(lambda messages: len(messages) >= 50)
                step_until(sim_time() + 0.1)
                self.assertEqual(len(models.wait_for(lambda messages: len(messages) >= 55)), 55)


class OneRobot(unittest.TestCase):
    def setUp(self):
        control("reset_simulation")

    def test_scan(self):
        put("kiva2", pose(-4.0, -2.0))  # two metres before kiva1's centre
        with Collector("/kiva1/chassis/laser/scan", LaserScan) as scans:
            scan = scans.next(2)[-1]
        self.assertEqual(scan.header.frame_id, "kiva1/laser")
        rays = 1 + (scan.angle_max - scan.angle_min) / scan.angle_increment
        self.assertEqual(len(scan.ranges), round(rays))
        self.assertAlmostEqual(scan.angle_min, -scan.angle_max, places=5)
        ahead = scan.ranges[len(scan.ranges) // 2]
        self.assertTrue(0.8 < ahead < 1.4, f"{ahead} m ahead")
        self.assertIn(math.inf, scan.ranges)
        self.assertAlmostEqual(scan.scan_time, 0.1)

    def test_odometry_turns_with_the_robot(self):
        put("kiva1", pose(-4.0, -2.0, yaw=math.pi / 2))
        commander = Commander()
        with Collector("/kiva1/odom", Odometry) as odometry:
            commander.ask("/movy", kiva_id=1, distance=2.0)
            fast = odometry.first(lambda m: m.twist.twist.linear.x > 0.5)
        self.assertEqual((fast.header.frame_id, fast.child_frame_id), ("world", "kiva1/base_link"))
        self.assertAlmostEqual(fast.twist.twist.linear.y, 0, places=3)
        self.assertAlmostEqual(fast.pose.pose.position.x, -4.0, places=2)
        self.assertAlmostEqual(fast.pose.pose.orientation.z, math.sqrt(0.5), places=3)
        commander.close()

    def test_status_is_latched_and_follows_a_command(self):
        self.assertEqual(latched("/kiva1/status", KivaStatus).status, KivaStatus.STATUS_IDLE)
        commander = Commander()
        with Collector("/kiva1/status", KivaStatus) as statuses:
            commander.ask("/movx", kiva_id=1, distance=1.0)
            busy = statuses.first(lambda m: m.status == KivaStatus.STATUS_BUSY)
            self.assertEqual(busy.state, KivaStatus.STATE_MOVING_X)
            commander.events.first(lambda e: e.kind == Event.DONE)
        there = latched("/kiva1/status", KivaStatus, lambda m: m.status == KivaStatus.STATUS_IDLE)
        self.assertEqual((there.kiva_id, there.header.frame_id), (1, "world"))
        self.assertAlmostEqual(there.pose.x, -5.0, places=3)
        commander.close()

    def test_frames(self):
        buffer = tf2_ros.Buffer()
        self.addCleanup(tf2_ros.TransformListener(buffer).unregister)

        def frame(child):
            newest = (
                rospy.Time()
            )  # and no timeout of lookup_transform's: the reset makes it stumble
            wait_until(lambda: buffer.can_transform("world", child, newest), child)
            position = buffer.lookup_transform("world", child, newest).transform.translation
            return position.x, position.y, position.z

        def assert_at(child, x, y, z):
            for number, expected in zip(frame(child), (x, y, z)):
                self.assertAlmostEqual(number, expected, places=3, msg=child)

        assert_at("kiva1/base_link", -6, -2, 0)
        assert_at("kiva1/left_wheel", -6, -1.74, 0.1)
        assert_at("kiva1/right_wheel", -6, -2.26, 0.1)
        assert_at("kiva1/tower", -6, -2, 0.38)
        x, y, z = frame("kiva2/laser")
        self.assertTrue(-5.7 < x < -5.5 and y == 2 and z == 0.2, (x, y, z))


class Warehouse(unittest.TestCase):
    def setUp(self):
        control("reset_simulation")
        self.addCleanup(delete, "storage_unit31")
        self.addCleanup(delete, "kiva31")

    def test_events_tell_who_came_and_went(self):
        with Collector("/warehouse/events", Event) as events:
            spawn("kiva31", model_file("kiva"), pose(3.0, 8.0))
            events.first(lambda e: (e.kind, e.model) == (Event.SPAWNED, "kiva31"))
            delete("kiva31")
            events.first(lambda e: (e.kind, e.model) == (Event.DELETED, "kiva31"))

    def test_fleet_has_one_entry_a_robot(self):
        spawn("kiva31", model_file("kiva"), pose(3.0, 8.0))
        with Collector("/warehouse/fleet", FleetState) as fleets:
            fleet = fleets.first(lambda m: 31 in m.kiva_id)
        self.assertEqual(sorted(fleet.kiva_id), [1, 2, 31])
        i = fleet.kiva_id.index(31)
        self.assertEqual((fleet.x[i], fleet.y[i], fleet.shelf_id[i]), (3.0, 8.0, 0))
        arrays = (fleet.yaw, fleet.vx, fleet.vy, fleet.yaw_rate, fleet.status, fleet.state)
        self.assertEqual({len(array) for array in arrays}, {3})

    def test_objects_and_their_places_are_latched_even_while_time_stands_still(self):
        with Paused():
            spawn("storage_unit31", model_file("storage_unit"), pose(3.0, 8.0))
            objects = latched(
                "/warehouse/objects",
                WarehouseObjects,
                lambda m: "storage_unit31" in m.storage_units,
            )
            units = latched(
                "/warehouse/unit_states", UnitStates, lambda m: m.revision == objects.revision
            )
        self.assertEqual(sorted(objects.kiva_id), [1, 2])
        self.assertEqual(objects.belts, ["conveyor_belt1", "conveyor_belt2"])
        self.assertEqual(len(objects.item_pose), 7 * len(objects.items))
        last = objects.storage_units.index("storage_unit31")
        self.assertEqual(units.pose[7 * last : 7 * last + 3], (3.0, 8.0, 0.0))
        unit_of_item3 = objects.item_unit[objects.items.index("item3")]
        self.assertEqual(objects.storage_units[unit_of_item3], "storage_unit2")

    def test_a_carried_unit_names_its_carrier(self):
        put("kiva1", pose(0.0, 0.0))
        commander = Commander()
        with Collector("/warehouse/unit_states", UnitStates) as units:
            commander.do("/lift", kiva_id=1, shelf_id=2, status=Lift.CARRY)
            units.first(lambda m: list(m.carrier) == [0, 1, 0])
        with Collector("/kiva1/status", KivaStatus) as statuses:
            statuses.first(lambda m: m.shelf_id == 2 and m.status == KivaStatus.STATUS_IDLE)
        commander.close()

    def test_model_states_holds_what_stands_there(self):
        states = latched("/model_states", ModelStates)
        self.assertEqual(states.name, world().model_names)
        at = states.name.index("conveyor_belt1")
        self.assertEqual((states.pose[at].position.x, states.pose[at].position.y), (7.0, -3.0))
        self.assertEqual(len(states.twist), len(states.name))


class StandingStill(unittest.TestCase):
    def test_nothing_moves_and_newcomers_learn_the_time_and_the_fleet(self):
        with Collector("/model_states", ModelStates) as models, Paused():
            now = sim_time()
            self.assertAlmostEqual(latched("/clock", Clock).clock.to_sec(), now)
            models.clear()
            self.assertAlmostEqual(latched("/warehouse/fleet", FleetState).stamp.to_sec(), now)
            self.assertEqual(models.messages, [])

    def test_a_reset_is_seen_at_once(self):
        wait_until(lambda: sim_time() > 0.2, "time going on")
        with Paused():
            put("kiva1", pose(4.0))
            moved = latched("/kiva1/status", KivaStatus, lambda m: m.pose.x == 4.0)
            self.assertEqual(moved.pose.y, 0.0)
            control("reset_simulation")
            self.assertEqual(latched("/clock", Clock, lambda m: not m.clock).clock.to_sec(), 0)
            back = latched("/kiva1/status", KivaStatus, lambda m: m.pose.x == -6.0)
            self.assertEqual(back.header.stamp.to_sec(), 0)
            self.assertEqual(place("kiva1"), (-6.0, -2.0, 0.0))


if __name__ == "__main__":
    rospy.init_node("test_topics")
    rostest.rosrun("warehouse_tests", "topics", __name__)
