#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle behind a broker drives straight stretches without a stop: what is ahead is released in
time, although its states come once a cell."""

import math

import rospy
import rostest
from rostest_support.behind_broker import NUMBER, OUT_OF_SERVICE, BrokerCase, set_modes
from rostest_support.node_test import call, latched

from warehouse_msgs.msg import CoordinatorState, TransportEvent
from warehouse_msgs.srv import Transport
from warehouse_vda5050.formula_driver import FormulaRobot

TOP, ACCELERATION = 1.5, 1.0  # of the vehicle [m/s, m/s2]
RAMP = TOP**2 / (2 * ACCELERATION)  # in which it reaches that, and brakes from it [m]
SLOWEST = 0.6 * TOP  # of a drive without a stop; messages of a busy machine are late [m/s]
LONG = 6.0  # least length of a stretch that is judged [m]
PATIENCE = 120.0  # [s, wall]


class Cart(FormulaRobot):
    """Accelerates and brakes: it stops at the end of what is released to it, and at corners.
    `drive`: its place, heading and speed after each step."""

    def __init__(self, x, y):
        super().__init__(x, y, 0.0, TOP)
        self._speed, self.drive = 0.0, []

    def step(self, seconds):
        if self.is_moving:
            faster = self._speed + ACCELERATION * seconds
            least = ACCELERATION * seconds  # else it would never be there
            brakes = math.sqrt(2 * ACCELERATION * self.way_ahead())
            self._speed = max(least, min(TOP, faster, brakes))
        super().step(seconds)
        if not self.is_moving:
            self._speed = 0.0
        self.drive.append((self.x, self.y, self._speed))

    def way_ahead(self):
        """The distance to its next stop [m]."""
        at, way, heading = (self.x, self.y), 0.0, None
        for point in self._path[self._reached :]:
            length = math.dist(at, point)
            if length > 1e-9:
                turned = math.atan2(point[1] - at[1], point[0] - at[0])
                if heading is not None and abs(math.remainder(turned - heading, math.tau)) > 0.01:
                    break
                heading, way = turned, way + length
            at = point
        return way


def stretches(drive):
    """Straight stretches of a drive, as [(way from the begin [m], speed [m/s])]."""
    runs, run, axis = [], [], None
    for (x0, y0, _), (x1, y1, speed) in zip(drive, drive[1:]):
        way = math.dist((x0, y0), (x1, y1))
        if way > 1e-6:
            along = (abs(x1 - x0) > abs(y1 - y0), x1 - x0 + y1 - y0 > 0)
            if along != axis:
                runs, run, axis = [*runs, run], [(0.0, 0.0)], along
            run.append((run[-1][0] + way, speed))
        elif run:
            run.append((run[-1][0], speed))
    return [*runs, run]


class Fluent(BrokerCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        set_modes(OUT_OF_SERVICE)  # the way is free
        cls.behind = cls.add_vehicle(Cart(*cls.free_points()[0]))
        cls.start_master()

    def speeds(self):
        """The speeds that the fleet has told of the vehicle [m/s]."""
        rows = [
            (m, list(m.kiva_id).index(NUMBER)) for m in self.fleet.messages if NUMBER in m.kiva_id
        ]
        return [math.hypot(m.vx[i], m.vy[i]) for m, i in rows]

    def test_it_never_stops_on_a_straight_way(self):
        self.state.first(lambda s: (s.automatic, s.out_of_service) == (1, 4), PATIENCE)
        answer = call("/warehouse/transport", Transport, shelf_id=7, station="pick1", then=0)
        self.assertTrue(answer.accepted, answer.message)
        self.transports.first(lambda e: e.kind == TransportEvent.ARRIVED, PATIENCE)
        runs = [run for run in stretches(self.behind.robot.drive) if run and run[-1][0] > LONG]
        self.assertTrue(runs, "no stretch was long")
        for run in runs:
            inner = [(w, v) for w, v in run if RAMP + 0.2 < w < run[-1][0] - RAMP - 0.2]
            slowest = min(inner, key=lambda place: place[1])
            print(f"{run[-1][0]:.1f} m, {slowest[1]:.3f} m/s or more", flush=True)
            self.assertGreater(slowest[1], SLOWEST, f"at {slowest[0]:.2f} of {run[-1][0]:.1f} m")
        self.assertGreater(max(self.speeds()), SLOWEST)


if __name__ == "__main__":
    rospy.init_node("fluent")
    latched("/warehouse/coordinator", CoordinatorState)
    rostest.rosrun("warehouse_tests", "fluent", Fluent)
