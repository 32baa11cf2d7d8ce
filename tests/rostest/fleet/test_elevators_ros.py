#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Units come to stations of the other floor: their robots ride the elevator with them."""

import unittest

import numpy as np
import rosgraph
import rospy
import rostest
from nav_msgs.srv import GetMap
from rostest_support.node_test import call, latched, wait_until
from rostest_support.warehouse_test import Collector

from gazebo_msgs.srv import SetModelState, SetModelStateResponse
from warehouse_layout.floor import plan_reader
from warehouse_msgs.msg import CoordinatorState, Event, Scenery, TransportEvent, UnitStates
from warehouse_msgs.srv import ReleaseTransport, Transport

PATIENCE = 120.0  # [s, wall] of a transport
UNITS = {"pick4": (1, 2), "pick2": (7, 8)}  # on the other floor, by station
RIDER, STATION = 3, "pick4"
SET_DOWN = "/gazebo/set_model_state"
WHY = "a test stands there"
TRIES = 5


class Refusing:
    """Answers in the world's place that no robot is set down, until it ends."""

    def __init__(self):
        self.tries, me = 0, rospy.get_name()
        self._master = rosgraph.Master(me)
        self._service = self._master.lookupService(SET_DOWN)
        self._world = self._master.lookupNode("/gazebo")
        self._refusing = rospy.Service(SET_DOWN, SetModelState, self._refuse)

    def _refuse(self, _request):
        self.tries += 1
        return SetModelStateResponse(False, WHY)

    def end(self):
        """Has the world answer again."""
        self._refusing.shutdown()
        rosgraph.Master("/gazebo").registerService(SET_DOWN, self._service, self._world)


class Elevators(unittest.TestCase):
    def test_units_change_floors(self):
        state = Collector("/warehouse/coordinator", CoordinatorState)
        transports = Collector("/warehouse/transports", TransportEvent)
        events = Collector("/warehouse/events", Event)
        units = Collector("/warehouse/unit_states", UnitStates)
        state.first(lambda message: message.automatic == 6, PATIENCE)
        scenery = latched("/warehouse/scenery", Scenery)
        plan = plan_reader.of_messages(call("/warehouse/map", GetMap).map, scenery)
        services = {station.name: station.service_cell for station in plan.stations}
        numbers = {}
        for station, there in UNITS.items():
            for unit in there:
                answer = call("/warehouse/transport", Transport, shelf_id=unit, station=station)
                self.assertTrue(answer.accepted, answer.message)
                numbers[answer.transport_id] = unit, services[station]
        for number, (unit, service) in numbers.items():
            arrived = transports.first(
                lambda event, number=number: (
                    event.transport_id == number and event.kind == TransportEvent.ARRIVED
                ),
                PATIENCE,
            )
            self.assertEqual(arrived.shelf_id, unit)
            poses = np.reshape(units.messages[-1].pose, (-1, 7))
            cells = plan.cell_of(poses[:, 0], poses[:, 1])
            tier = plan.tier.flat[service]
            self.assertEqual(plan.tier.flat[cells[unit - 1]], tier, f"unit {unit}")
            self.assertTrue(call("/warehouse/release_transport", ReleaseTransport, number).success)
        self.assert_no_contacts(events)

    def test_who_is_not_set_down_is_an_alarm_until_the_world_does_it(self):
        state = Collector("/warehouse/coordinator", CoordinatorState)
        transports = Collector("/warehouse/transports", TransportEvent)
        events = Collector("/warehouse/events", Event)
        refusing = Refusing()
        answer = call("/warehouse/transport", Transport, shelf_id=RIDER, station=STATION)
        self.assertTrue(answer.accepted, answer.message)
        wait_until(lambda: refusing.tries > TRIES, "it is tried again", PATIENCE)
        (alarm,) = state.first(lambda message: message.alarms, PATIENCE).alarms
        self.assertRegex(alarm, rf"^kiva\d does not move: it stays in its elevator \({WHY}\)$")
        self.assertEqual({a for message in list(state.messages) for a in message.alarms}, {alarm})
        refusing.end()
        state.wait_for(lambda messages: not messages[-1].alarms, PATIENCE)
        there = (answer.transport_id, TransportEvent.ARRIVED)
        transports.first(lambda event: (event.transport_id, event.kind) == there, PATIENCE)
        self.assert_no_contacts(events)

    def assert_no_contacts(self, events):
        contacts = [e for e in list(events.messages) if e.kind == Event.COLLISION]
        self.assertEqual([f"{e.model} {e.text}" for e in contacts], [])


if __name__ == "__main__":
    rospy.init_node("test_elevators")
    rostest.rosrun("warehouse_tests", "elevators", Elevators)
