#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Zones over services: a fleet at work keeps out of one for its whole time and comes back, and a
coordinator that is killed leaves it closed."""

import math
import os
import signal
import unittest

import numpy as np
import rospy
import rostest
from nav_msgs.srv import GetMap
from rostest_support.node_test import call, latched, pid
from rostest_support.warehouse_test import Collector

from warehouse_layout.floor import plan_reader
from warehouse_msgs.msg import ClosedZones, CoordinatorState, Event, FleetState, Scenery
from warehouse_msgs.srv import CloseZone, OpenZone

PATIENCE, LONG = 90.0, 240.0  # for an answer; for simulated minutes [s, wall]
LEAVES = 60.0  # in which the last robot has left a zone [s]
SPILL = "spill"


def is_over(message, text):
    """Whether no zone is closed, and that was the last event."""
    return not message.zones and message.event_text and text in message.event_text[-1]


class Zones(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.state = Collector("/warehouse/coordinator", CoordinatorState)
        cls.fleet = Collector("/warehouse/fleet", FleetState)
        cls.zones = Collector("/warehouse/zones", ClosedZones)
        cls.events = Collector("/warehouse/events", Event)
        cls.state.first(lambda state: state.automatic == 20 and state.delivered >= 2, PATIENCE)
        scenery = latched("/warehouse/scenery", Scenery)
        cls.plan = plan_reader.of_messages(call("/warehouse/map", GetMap).map, scenery)

    def tearDown(self):
        contacts = [e for e in list(self.events.messages) if e.kind == Event.COLLISION]
        self.assertEqual([f"{e.model} {e.text}" for e in contacts], [])

    def square(self):
        """Corners of five by five cells in the middle of the storage [m]."""
        rows, columns = np.divmod(np.flatnonzero(self.plan.storage), self.plan.width)
        row, column = int(np.median(rows)), int(np.median(columns))
        ends = [(row + by) * self.plan.width + column + by for by in (-2, 2)]
        x, y = self.plan.point_of(np.array(ends))
        return {"x1": float(x[0]), "y1": float(y[0]), "x2": float(x[1]), "y2": float(y[1])}

    def close(self, **fields):
        return call("/warehouse/close_zone", CloseZone, **self.square(), reason=SPILL, **fields)

    def inside(self, report):
        """Ids of robots in the square."""
        corners, half = self.square(), self.plan.spacing / 2
        x, y = np.asarray(report.x), np.asarray(report.y)
        is_in = (x > corners["x1"] - half) & (x < corners["x2"] + half)
        is_in &= (y > corners["y1"] - half) & (y < corners["y2"] + half)
        return np.asarray(report.kiva_id)[is_in].tolist()

    def at(self, time):
        """The first report of that time [s] or later."""
        return self.fleet.first(lambda report: report.stamp.to_sec() >= time, LONG)

    def keep_out(self, until):
        """Checks each report up to that time [s]."""
        times = []
        self.fleet.clear()
        self.at(until)
        for report in list(self.fleet.messages):
            if report.stamp.to_sec() < until:
                times.append(report.stamp.to_sec())
                self.assertEqual(self.inside(report), [], f"at {times[-1]:g} s")
        self.assertGreater(len(times), 50)

    def test_a_faults_are_told_in_a_sentence(self):
        for fields, text in (
            ({"x1": math.nan}, "(x1, y1) is (nan, 0); two numbers were expected"),
            ({"x2": 1e6}, "(x2, y2) is (1e+06, 0), which is off the floor"),
            ({"duration": -1.0}, "duration is -1; 0 (until it is opened) to 604800 s"),
            ({"reason": ""}, "reason is ''; 1 to 60 characters were expected"),
        ):
            answer = call("/warehouse/close_zone", CloseZone, **{"reason": SPILL} | fields)
            self.assertFalse(answer.success)
            self.assertIn(text, answer.message)
        answer = call("/warehouse/open_zone", OpenZone, zone_id=77)
        self.assertEqual((answer.success, answer.message), (False, "there is no closed zone 77"))

    def test_b_robots_keep_out_for_the_whole_time_and_come_back(self):
        checked = self.close(check=True)
        self.assertTrue(checked.success and not checked.zone_id)
        self.assertTrue(any("can't be fetched" in text for text in checked.waits), checked.waits)
        self.assertFalse(latched("/warehouse/zones", ClosedZones).zones)
        answer = self.close(duration=180.0, by="Ann")
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(list(answer.waits), list(checked.waits))
        zone = self.zones.first(lambda message: message.zones, PATIENCE).zones[0]
        self.assertEqual((zone.reason, zone.closed_by), (SPILL, "Ann"))
        self.assertAlmostEqual(zone.until - zone.since, 180.0, places=3)
        before = self.state.next(1)[0].delivered
        self.at(zone.since + LEAVES)
        self.keep_out(zone.until)
        self.assertGreater(self.state.next(1)[0].delivered, before, "work goes on around it")
        self.zones.first(lambda message: is_over(message, "its time is over"), PATIENCE)
        self.fleet.first(self.inside, PATIENCE)

    def test_c_a_zone_stays_closed_when_its_coordinator_dies(self):
        answer = self.close(by="Ben")
        self.assertTrue(answer.success, answer.message)
        is_bens = lambda message: any(zone.closed_by == "Ben" for zone in message.zones)  # noqa: E731
        closed = self.zones.first(is_bens, PATIENCE).zones[0]
        self.assertEqual(closed.until, 0)
        self.at(closed.since + LEAVES)
        self.zones.clear()
        os.kill(pid("/coordinator"), signal.SIGKILL)
        again = self.zones.first(is_bens, PATIENCE).zones[0]
        self.assertEqual(
            (again.zone_id, again.reason, again.closed_by), (answer.zone_id, SPILL, "Ben")
        )
        self.keep_out(self.fleet.next(1)[0].stamp.to_sec() + 60)
        opened = call("/warehouse/open_zone", OpenZone, zone_id=answer.zone_id, by="Ann")
        self.assertTrue(opened.success, opened.message)
        over = self.zones.first(lambda message: is_over(message, "is open again"), PATIENCE)
        self.assertEqual(over.event_by[-1], "Ann")
        self.fleet.first(self.inside, PATIENCE)


if __name__ == "__main__":
    rospy.init_node("closed_zones")
    rostest.rosrun("warehouse_tests", "closed_zones", Zones)
