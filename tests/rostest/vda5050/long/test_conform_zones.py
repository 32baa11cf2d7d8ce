#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Our master of 3.0.0 conforms while a person closes and opens zones of the floor."""

import itertools
import threading

import rospy
import rostest
from rostest_support.node_test import call, latched
from test_conform_master import ConformMaster, Operator

from warehouse_msgs.msg import CoordinatorState, FleetState
from warehouse_msgs.srv import CloseZone, OpenZone

CLOSED = 25.0  # time that a zone stays so [s]


class Guard(threading.Thread):
    """Closes the place of one robot of the master's after another: it needs a release to leave, and
    the zone is BLOCKED for the other."""

    def __init__(self):
        super().__init__(daemon=True)
        self.ended = threading.Event()

    def run(self):
        for number in itertools.cycle((21, 22)):
            if self.ended.wait(CLOSED / 5):
                return
            fleet = latched("/warehouse/fleet", FleetState)
            if number not in fleet.kiva_id:
                continue
            k = list(fleet.kiva_id).index(number)
            x, y = fleet.x[k], fleet.y[k]
            answer = call("/warehouse/close_zone", CloseZone, x1=x, y1=y, x2=x, y2=y, reason="try")
            self.ended.wait(CLOSED)
            if answer.success:
                call("/warehouse/open_zone", OpenZone, zone_id=answer.zone_id)


class ConformZones(ConformMaster):
    VERSION, TRIED = "3.0.0", ("zones", "paths", "order", "update", "messages")
    NOT_SEEN = frozenset()

    def operators(self):
        return [Operator(), Guard()]


if __name__ == "__main__":
    rospy.init_node("test_conform_zones")
    latched("/warehouse/coordinator", CoordinatorState)
    rostest.rosrun("warehouse_tests", "conform_zones", ConformZones)
