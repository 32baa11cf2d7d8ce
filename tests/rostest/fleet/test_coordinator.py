#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A fleet at work under ROS: transports and modes by service, and a coordinator that is killed.

All stations are kept busy by random transports all the while. No robot touches another.
"""

import math
import os
import signal
import unittest

import numpy as np
import rospy
import rostest
from nav_msgs.srv import GetMap
from rostest_support.node_test import call, latched, pid, wait_until
from rostest_support.warehouse_test import Collector, Commander

from warehouse_layout.floor import plan_reader
from warehouse_msgs.msg import (
    CoordinatorState,
    Event,
    FleetState,
    Scenery,
    TransportEvent,
    UnitStates,
    WarehouseObjects,
)
from warehouse_msgs.srv import ReleaseTransport, SetRobotMode, Transport

PATIENCE = 90.0  # [s, wall] of a transport
NODE = "/coordinator"
KINDS = ("RECEIVED", "ASSIGNED", "LIFTED", "ARRIVED", "RELEASED", "STORED")
AT_ONCE = 255  # priority


class Fleet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.state = Collector("/warehouse/coordinator", CoordinatorState)
        cls.transports = Collector("/warehouse/transports", TransportEvent)
        cls.fleet = Collector("/warehouse/fleet", FleetState)
        cls.events = Collector("/warehouse/events", Event)
        cls.units = Collector("/warehouse/unit_states", UnitStates)
        cls.state.first(lambda state: state.automatic == 20 and state.delivered >= 2, PATIENCE)
        scenery = latched("/warehouse/scenery", Scenery)
        cls.plan = plan_reader.of_messages(call("/warehouse/map", GetMap).map, scenery)

    def tearDown(self):
        contacts = [e for e in list(self.events.messages) if e.kind == Event.COLLISION]
        self.assertEqual([f"{e.model} {e.text}" for e in contacts], [])

    # What tests ask for.

    def idle_units(self):
        """{number: cell} of units that stand on storage places."""
        objects = latched("/warehouse/objects", WarehouseObjects)
        states = latched(
            "/warehouse/unit_states", UnitStates, lambda s: s.revision == objects.revision
        )
        poses = np.reshape(states.pose, (-1, 7))
        cells = self.plan.cell_of(poses[:, 0], poses[:, 1])
        return {
            int(name.removeprefix("storage_unit")): int(cell)
            for name, cell, carrier in zip(objects.storage_units, cells, states.carrier)
            if carrier == 0 and self.plan.storage.flat[cell]
        }

    def transport(self, units, **fields):
        """(unit, transport_id) of the first of the units that has no transport yet."""
        for unit in units:
            answer = call(
                "/warehouse/transport", Transport, shelf_id=unit, priority=AT_ONCE, **fields
            )
            if answer.accepted:
                return unit, answer.transport_id
            self.assertIn("has transport", answer.message)
        raise AssertionError("all units are under way")

    def wait_for(self, number, *kinds):
        """Until all that happened to a transport is that, in this order."""
        expected_kinds = [getattr(TransportEvent, kind) for kind in kinds]
        mine = lambda messages: [e.kind for e in messages if e.transport_id == number]  # noqa: E731
        events = self.transports.wait_for(lambda m: len(mine(m)) >= len(expected_kinds), PATIENCE)
        self.assertEqual(mine(events), expected_kinds)

    def refused(self, *args):
        answer = call("/warehouse/transport", Transport, *args)
        self.assertFalse(answer.accepted)
        self.assertEqual(answer.transport_id, 0)
        return answer.message

    def now(self):
        """The next report of the fleet."""
        return self.fleet.next(1)[0]

    def goes_on(self, deliveries=3):
        """Until so many more units have come to stations."""
        before = self.state.next(1)[0].delivered
        self.state.first(lambda state: state.delivered >= before + deliveries, PATIENCE)

    # Tests, in the order of their names.

    def test_a_unit_is_brought_to_a_station_and_stored_again(self):
        station = self.plan.stations[0].name
        self.transports.clear()
        _, number = self.transport(sorted(self.idle_units()), station=station)
        early = call("/warehouse/release_transport", ReleaseTransport, number)
        self.assertFalse(early.success)
        self.assertIn("not arrived", early.message)
        self.wait_for(number, *KINDS[:4])
        self.assertTrue(call("/warehouse/release_transport", ReleaseTransport, number).success)
        self.wait_for(number, *KINDS)
        late = call("/warehouse/release_transport", ReleaseTransport, number)
        self.assertFalse(late.success)
        self.assertIn(f"no transport {number}", late.message)

    def test_b_a_unit_stays_where_it_is_brought_and_is_fetched_there(self):
        units = self.idle_units()
        taken = set(units.values())
        free = [c for c in np.flatnonzero(self.plan.storage).tolist() if c not in taken]
        self.transports.clear()
        x, y = self.plan.point_of(free[0])
        near = sorted(units, key=lambda u: math.dist(self.plan.point_of(units[u]), (x, y)))
        unit, number = self.transport(near, x=x, y=y, then=1)
        self.wait_for(number, *KINDS)
        self.assertEqual(self.cell_of(unit), free[0])
        x, y = self.plan.point_of(units[unit])
        _, number = self.transport([unit], x=x, y=y, then=1)
        self.wait_for(number, *KINDS)
        self.assertEqual(self.cell_of(unit), units[unit])

    def cell_of(self, unit):
        """Where a unit stands, once that is told."""
        wait_until(lambda: unit in self.idle_units(), f"storage_unit{unit} on the floor")
        return self.idle_units()[unit]

    def test_c_what_can_t_be_done_is_refused_with_the_reason(self):
        unit = min(self.idle_units())
        self.assertIn("no storage unit 9999", self.refused(9999, "", 0, 0, 0, 0))
        self.assertIn("no station 'nowhere'", self.refused(unit, "nowhere", 0, 0, 0, 0))
        self.assertIn("neither a station nor a point", self.refused(unit, "", math.nan, 0, 0, 0))
        wall = int(np.flatnonzero(~self.plan.passable)[0])
        x, y = self.plan.point_of(wall)
        self.assertIn("no robot can stand", self.refused(unit, "", x, y, 0, 0))
        lane = self.plan.stations[0].cells[0]
        x, y = self.plan.point_of(int(lane))
        self.assertIn("lane of a station", self.refused(unit, "", x, y, 0, 0))
        self.assertIn("then is 7", self.refused(unit, self.plan.stations[0].name, 0, 0, 7, 0))
        answer = call("/warehouse/release_transport", ReleaseTransport, 99999)
        self.assertFalse(answer.success)
        self.assertIn("no transport 99999", answer.message)
        for mode, robot, reason in ((0, 999, "no kiva999"), (9, 1, "mode is 9")):
            answer = call("/warehouse/set_robot_mode", SetRobotMode, robot, mode)
            self.assertFalse(answer.success)
            self.assertIn(reason, answer.message)

    def test_d_a_robot_out_of_service_is_an_obstacle_until_it_is_back(self):
        robot = int(self.now().kiva_id[0])
        call(
            "/warehouse/set_robot_mode",
            SetRobotMode,
            robot,
            SetRobotMode._request_class.OUT_OF_SERVICE,
        )
        self.state.first(lambda state: state.out_of_service == 1)
        at = self.stands(robot)
        self.goes_on()
        self.assertEqual(self.stands(robot), at)
        call("/warehouse/set_robot_mode", SetRobotMode, robot, 0)
        self.state.clear()
        self.state.first(lambda state: state.automatic == 20)

    def stands(self, robot):
        """Where a robot is, once it is idle."""
        self.fleet.clear()
        index = list(self.now().kiva_id).index(robot)
        fleet = self.fleet.first(lambda f: f.status[index] == 0)
        return round(fleet.x[index], 2), round(fleet.y[index], 2)

    def test_e_a_robot_that_a_person_moves_is_manual_until_it_is_given_back(self):
        commander = Commander()
        robot = self.move_one(commander)
        self.state.clear()
        self.state.first(lambda state: state.manual == 1)
        self.goes_on()
        self.assertTrue(call("/warehouse/set_robot_mode", SetRobotMode, robot, 0).success)
        self.state.clear()
        self.state.first(lambda state: state.manual == 0 and state.automatic == 20)
        # The nearest robot is sent for a unit: by and by that is this one.
        at = self.stands(robot)
        units = self.idle_units()
        near = sorted(units, key=lambda u: math.dist(self.plan.point_of(units[u]), at))
        for unit in near[:3]:
            x, y = self.plan.point_of(units[unit])
            call("/warehouse/transport", Transport, unit, "", x, y, 1, AT_ONCE)
        self.transports.first(lambda e: e.kiva_id == robot, PATIENCE)
        commander.close()

    def move_one(self, commander):
        """A robot without a command that obeys a person, who has it drive a cell along y."""
        for _ in range(300):
            for robot, x, y in self.without_command(self.now()):
                answer = commander.ask("/mov", kiva_id=robot, x=x, y=y)
                # Not the answer to the coordinator, which may have been quicker.
                if answer.kind == Event.ACCEPTED and answer.text.startswith("go to"):
                    return robot
        raise AssertionError("all robots are at work all the time")

    def without_command(self, fleet):
        """(robot, x, y): where it could go, with no other near."""
        x, y = np.array(fleet.x), np.array(fleet.y)
        idle = np.frombuffer(fleet.status, np.uint8) == 0
        for index in np.flatnonzero(idle & (np.array(fleet.shelf_id) == 0)):
            for goal in (y[index] + 1, y[index] - 1):
                cell = self.plan.cell_of(x[index], goal)
                far = np.hypot(x - x[index], y - goal)
                far[index] = np.inf
                if cell >= 0 and self.plan.storage.flat[cell] and far.min() > 2.5:
                    yield int(fleet.kiva_id[index]), x[index], goal

    def test_f_one_that_is_killed_and_comes_back_takes_over_the_fleet(self):
        loaded = lambda f: {k for k, s in zip(f.kiva_id, f.shelf_id) if s}  # noqa: E731
        self.fleet.clear()
        fleet = self.fleet.first(lambda f: len(loaded(f)) >= 3 and max(map(abs, f.vx)) > 1)
        carriers, before = loaded(fleet), pid(NODE)
        begun = lambda messages: sorted(  # noqa: E731
            {e.transport_id for e in messages if e.kind == TransportEvent.RECEIVED}
            - {e.transport_id for e in messages if e.kind > TransportEvent.ASSIGNED}
        )
        asked = begun(self.transports.wait_for(begun, PATIENCE))
        os.kill(before, signal.SIGKILL)
        self.state.clear()
        wait_until(lambda: pid(NODE) not in (None, before), "the next coordinator")
        state = self.state.first(lambda state: state.automatic == 20)
        self.assertLessEqual(state.delivered, 1)
        # Who has asked the first one for something is told, and no number comes twice.
        lost = lambda messages: {  # noqa: E731
            e.transport_id for e in messages if e.text == "the coordinator was restarted"
        }
        events = self.transports.wait_for(lambda messages: lost(messages) >= set(asked), PATIENCE)
        numbers = [e.transport_id for e in events if e.kind == TransportEvent.RECEIVED]
        self.assertEqual(len(numbers), len(set(numbers)))
        # What they carry is put down, all of it.
        self.fleet.clear()
        free = set()
        self.fleet.wait_for(
            lambda messages: (
                free.update(*(carriers - loaded(m) for m in messages[-1:])) or free == carriers
            ),
            PATIENCE,
        )
        self.goes_on()
        state = self.state.next(1)[0]
        self.assertEqual((state.manual, list(state.alarms), state.watchdog), (0, [], 0))

    def test_g_state_is_latched_and_comes_once_a_second(self):
        first, second = self.state.next(2)
        self.assertAlmostEqual((second.header.stamp - first.header.stamp).to_sec(), 1, delta=0.25)
        self.assertGreater(latched("/warehouse/coordinator", CoordinatorState).automatic, 0)


if __name__ == "__main__":
    rospy.init_node("coordinating")
    rostest.rosrun("warehouse_tests", "coordinating", Fleet)
