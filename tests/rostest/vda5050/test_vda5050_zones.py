#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A zone of the floor that is closed is BLOCKED for a vehicle of 3.0.0, until it is opened."""

import rospy
import rostest
from rostest_support.behind_broker import PATIENCE
from rostest_support.node_test import call, latched, wait_until
from test_vda5050_master import VehicleCase

from warehouse_msgs.msg import CoordinatorState
from warehouse_msgs.srv import CloseZone, OpenZone
from warehouse_vda5050.zones.zone import ZoneType


class Zones(VehicleCase):
    VERSION = "3.0.0"

    def test_a_closed_zone_holds_for_the_vehicle_until_it_is_opened(self):
        wait_until(self.row, "the vehicle's shadow", PATIENCE)
        robot = self.behind.robot
        x, y = robot.grid.position(next(c for c in self.free_places() if c != robot.cell))
        answer = call("/warehouse/close_zone", CloseZone, x1=x, y1=y, x2=x, y2=y, reason="spill")
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: len(self.held()) == 1, "the zone at the vehicle", PATIENCE)
        (zone,) = self.held()
        self.assertEqual((zone.type, zone.id), (ZoneType.BLOCKED, f"closed{answer.zone_id}"))
        middle = [sum(axis) / len(axis) for axis in zip(*zone.vertices)]
        self.assertAlmostEqual(middle[0], x, 2)
        self.assertAlmostEqual(middle[1], y, 2)
        call("/warehouse/open_zone", OpenZone, zone_id=answer.zone_id)
        wait_until(lambda: not self.held(), "the vehicle without zones", PATIENCE)
        self.assertFalse(self.broken())

    def held(self):
        """The zones that hold for the vehicle."""
        enabled = self.behind.vehicle.zones.store.enabled
        return enabled.zones if enabled else ()


if __name__ == "__main__":
    rospy.init_node("zones_at_a_broker")
    latched("/warehouse/coordinator", CoordinatorState)
    rostest.rosrun("warehouse_tests", "zones_at_a_broker", Zones)
