#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle whose factsheet is too small for the units: it refuses them once, with a reason, and
the coordinator gives them to others. A factsheet that is invalid is reported."""

import json

import paho.mqtt.publish
import rospy
import rostest
from rostest_support.behind_broker import AUTOMATIC, MANUAL, NUMBER, PATIENCE, SIMULATED, set_modes
from rostest_support.node_test import call, latched, wait_until
from test_vda5050_master import MetricRobot, VehicleCase

from warehouse_msgs.msg import CoordinatorState, Event, TransportEvent, Vda5050
from warehouse_msgs.srv import Transport
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.model import Factsheet

UNIT, LIMIT = 7, 30.0  # an empty unit weighs 60 kg


class SmallRobot(MetricRobot):
    """A vehicle that carries up to LIMIT kg."""

    def factsheet(self):
        return Factsheet(max_load_mass=LIMIT)


class Sheet(VehicleCase):
    ROBOT = SmallRobot

    def refusals(self):
        """The texts of what the vehicle has refused."""
        return self.texts(Event.REFUSED)

    def test_1_a_unit_that_is_too_heavy_goes_to_another_robot(self):
        self.state.first(lambda state: state.automatic == 5, PATIENCE)
        set_modes(MANUAL)
        answer = call("/warehouse/transport", Transport, shelf_id=UNIT, station="pick1", then=0)
        self.assertTrue(answer.accepted, answer.message)
        wait_until(self.refusals, "the refusal", PATIENCE)
        (text,) = self.refusals()
        self.assertRegex(
            text,
            rf"^it can't carry storage_unit{UNIT}: the unit weighs \d+\.\d kg,"
            rf" and .* carries {LIMIT:g} kg$",
        )
        self.assertEqual(self.behind.robot.events, [])  # it has not moved
        set_modes(AUTOMATIC)
        arrived = self.transports.first(lambda e: e.kind == TransportEvent.ARRIVED, PATIENCE)
        self.assertIn(arrived.kiva_id, SIMULATED)
        events = [e for e in self.transports.messages if e.kind == TransportEvent.ASSIGNED]
        self.assertEqual([event.kiva_id == NUMBER for event in events], [True, False])
        self.assertEqual(len(self.refusals()), 1)

    def test_2_an_invalid_factsheet_is_reported_with_the_field(self):
        codec = codec_for(self.VERSION)
        sheet = json.loads(codec.encode(Factsheet(max_load_mass=LIMIT)))
        sheet |= {"manufacturer": "acme", "serialNumber": "7", "version": self.VERSION}
        sheet["physicalParameters"]["speedMax"] = "fast"
        paho.mqtt.publish.single(
            "uagv/v2/acme/7/factsheet", json.dumps(sheet), 0, True, port=self.broker.port
        )
        fault = "physicalParameters.speedMax is 'fast'; a number was expected"
        text = f"its factsheet can't be read: {fault}"
        wait_until(lambda: text in self.refusals(), "the event", PATIENCE)
        latched("/warehouse/vda5050", Vda5050, lambda m: m.errors == [f"factsheet: {fault}"])

    def test_3_a_vehicle_larger_than_a_cell_is_refused_and_manual(self):
        wait_until(lambda: self.state.messages[-1].automatic == 5, "five robots", PATIENCE)
        codec = codec_for(self.VERSION)
        sheet = json.loads(codec.encode(Factsheet(length=1.4)))
        sheet |= {"manufacturer": "acme", "serialNumber": "7", "version": self.VERSION}
        topic = "uagv/v2/acme/7/factsheet"
        paho.mqtt.publish.single(topic, json.dumps(sheet), 0, True, port=self.broker.port)
        text = "it does not fit: it is 1.4 m long, and a cell 1 m"
        wait_until(lambda: any(text in t for t in self.refusals()), "the refusal", PATIENCE)
        wait_until(lambda: self.state.messages[-1].automatic == 4, "it is MANUAL", PATIENCE)


if __name__ == "__main__":
    rospy.init_node("factsheet_at_a_broker")
    latched("/warehouse/coordinator", CoordinatorState)
    rostest.rosrun("warehouse_tests", "factsheet_at_a_broker", Sheet)
