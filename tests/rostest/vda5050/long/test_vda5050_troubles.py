#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What our master and the coordinator make of vehicles that jump, refuse, dawdle, run empty or get
lost: one carries a unit through all of it, another one stands by."""

import itertools
import json
import math
import threading
import time
from dataclasses import replace

import rospy
import rostest
from rostest_support.behind_broker import (
    AUTOMATIC,
    NUMBER,
    OUT_OF_SERVICE,
    PATIENCE,
    BrokerCase,
    set_modes,
)
from rostest_support.node_test import call, latched, wait_until

from warehouse_msgs.msg import CoordinatorState, Event, TransportEvent
from warehouse_msgs.srv import CloseZone, OpenZone, ReleaseTransport, Transport
from warehouse_vda5050.errors import Error, ErrorLevel
from warehouse_vda5050.formula_driver import FormulaRobot
from warehouse_vda5050.mqtt.loop import Link, MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import Kind

OTHER = 22  # the vehicle that stands by
UNIT, NEXT_UNIT = 7, 8
TOP = 3.0  # of the vehicles [m/s]
ROBOTS = (
    f"{NUMBER}: {{manufacturer: acme, serial: '7'}}\n{OTHER}: {{manufacturer: acme, serial: '8'}}\n"
)
WIDE = (2.3, -2.8)  # a place with nothing around it, off the middle of a cell [m]
ASKEW = 0.5  # [rad]
WORDS = "orderError: the robot refuses all orders: a fault on demand"
LOST = "was pushed and does not find back: put it straight, then set it AUTOMATIC"


class Stubborn(FormulaRobot):
    """Takes orders and, if it `refuses_updates`, no updates of them."""

    refuses_updates = False

    def report(self):
        report = super().report()
        is_under_way = self.refuses_updates and report.busy
        return replace(report, declines="I am under way") if is_under_way else report


class Ear(threading.Thread):
    """Hears the orders to the vehicles: (when it came [s], serial, order)."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.orders, self._loop = [], MqttLoop()
        topics = [("uagv/v2/acme/+/order", 0)]
        self._loop.add(Link("ear", BrokerSettings("localhost", port), topics, self._hear))
        self.start()

    def run(self):
        while True:
            self._loop.poll(0.1)

    def _hear(self, topic, payload, _retained):
        self.orders.append((time.monotonic(), topic.split("/")[-2], json.loads(payload)))


class Troubles(BrokerCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        set_modes(OUT_OF_SERVICE)
        first, other = cls.free_points()[:2]
        cls.vehicle = cls.add_vehicle(Stubborn(*first, 0.0, TOP), "7")
        cls.other = cls.add_vehicle(FormulaRobot(*other, 0.0, TOP), "8")
        cls.ear = Ear(cls.broker.port)
        cls.start_master(ROBOTS)
        there = lambda: {NUMBER, OTHER} <= {*cls.fleet.messages[-1].kiva_id}  # noqa: E731
        wait_until(there, "both vehicles")
        wait_until(lambda: cls.state.messages[-1].automatic == 2, "they are AUTOMATIC")

    def run(self, result=None):
        """Each test begins where the one before has ended: the first failure is the last test."""
        super().run(result)
        if not result.wasSuccessful():
            result.stop()

    def until_alarm(self, text, patience=PATIENCE):
        def is_there():
            return any(text in alarm for alarm in self.state.messages[-1].alarms)

        wait_until(is_there, f"the alarm {text!r}", patience)

    def until_no_alarm(self, name):
        def is_gone():
            return not any(name in alarm for alarm in self.state.messages[-1].alarms)

        wait_until(is_gone, f"no alarm of {name}")

    def until_moves(self):
        wait_until(lambda: math.hypot(self.row()["vx"], self.row()["vy"]) > 0.1, "it drives")

    def once_it_drives(self, act, *args):
        """Has the vehicle's thread do something while it drives; what the fleet tells is older, and
        may be over."""
        done = threading.Event()

        def attempt():
            if self.vehicle.robot.is_moving and not done.is_set():
                act(*args)
                done.set()

        def is_done():
            self.send_on()
            self.vehicle.do(attempt)
            return done.is_set()

        wait_until(is_done, "it drives")

    def send_on(self):
        """Has the station let the unit go, if it has arrived there."""
        last = [event for event in self.transports.messages if event.shelf_id == UNIT][-1]
        if last.kind == TransportEvent.ARRIVED:
            call("/warehouse/release_transport", ReleaseTransport, last.transport_id)

    def test_1_a_vehicle_30_m_off_the_floor_is_an_event_with_both_places(self):
        x, y = self.other.robot.x, self.other.robot.y
        states = self.other.link.sent_counts[Kind.STATE]
        self.other.do(self.other.vehicle.request_state)  # else it may have driven meanwhile
        wait_until(lambda: self.other.link.sent_counts[Kind.STATE] > states, "its state")
        self.other.do(self.other.robot.carry_to, x - 30, y)
        self.other.do(self.other.vehicle.request_state)
        wait_until(lambda: self.texts(Event.BLOCKED, OTHER), "the event")
        place = f"from {x:.2f}, {y:.2f} to {x - 30:.2f}, {y:.2f}"
        self.assertEqual(self.texts(Event.BLOCKED, OTHER), [f"the vehicle jumped 30.0 m, {place}"])

    def test_2_a_vehicle_that_refuses_is_asked_after_1_s_and_2_s_and_its_alarm_has_its_words(self):
        self.vehicle.fault("refuse")
        answer = call("/warehouse/transport", Transport, shelf_id=UNIT, station="pick1", then=0)
        self.assertTrue(answer.accepted, answer.message)
        self.until_alarm(f"kiva{NUMBER} does not move: it refuses what it is sent ({WORDS})")
        times = [when for when, *_ in self.ear.orders]
        gaps = [b - a for a, b in itertools.pairwise(times)]
        self.assertGreater(gaps[0], 0.9)
        self.assertGreater(gaps[1], 1.8)
        self.assertLess(len(times), 5)
        self.assertIn(WORDS, self.texts(Event.REFUSED))
        self.vehicle.fault("")

    def test_3_a_vehicle_that_drives_slowly_is_not_said_not_to_move(self):
        self.vehicle.fault("slow")
        wait_until(lambda: self.texts(Event.ACCEPTED)[-1:], "an order")
        self.until_no_alarm(f"kiva{NUMBER}")
        said = len(self.state.messages)
        begin = time.monotonic()
        wait_until(lambda: self.row()["shelf_id"] == UNIT, "the unit is lifted")
        self.assertGreater(time.monotonic() - begin, 5.0, "it was not slow")
        alarms = {a for state in self.state.messages[said:] for a in state.alarms}
        self.assertEqual([alarm for alarm in alarms if alarm.startswith(f"kiva{NUMBER}")], [])

    def test_4_a_dispute_after_a_refused_update_ends_with_a_new_way(self):
        """The way ahead is closed where the vehicle's base ends: the coordinator goes back to the
        last point that the vehicle has."""
        refusals = len(self.texts(Event.REFUSED))
        self.vehicle.robot.refuses_updates = True
        wait_until(lambda: len(self.texts(Event.REFUSED)) > refusals, "a refused update")
        wait_until(lambda: not self.vehicle.robot.is_moving, "the end of its base")
        base = self.ear.orders[-1][2]
        zone = self.close(base["nodes"][1]["nodePosition"])
        wait_until(lambda: self.ear.orders[-1][2]["orderId"] != base["orderId"], "a new order")
        self.vehicle.robot.refuses_updates = False
        self.until_moves()
        refused = [text for text in self.texts(Event.REFUSED)[refusals:] if "are released" in text]
        self.assertEqual(refused, [])
        call("/warehouse/open_zone", OpenZone, zone_id=zone)

    def close(self, position):
        """Closes the cell of a node; returns the zone."""
        x, y = position["x"], position["y"]
        zone = call("/warehouse/close_zone", CloseZone, x1=x, y1=y, x2=x, y2=y, reason="spill")
        self.assertTrue(zone.success, zone.message)
        return zone.zone_id

    def test_5_a_vehicle_that_jumps_2_m_is_cancelled_with_an_event_and_goes_on_from_where_it_is(
        self,
    ):
        before = len(self.texts(Event.BLOCKED))
        self.once_it_drives(self.vehicle.fault, "jump")
        wait_until(lambda: self.texts(Event.BLOCKED)[before:], "the event")
        text = r"^the vehicle (jumped \d\.\d m, from|is \d\.\d m off its path, at) -?\d"
        self.assertRegex(self.texts(Event.BLOCKED)[before], text)
        self.vehicle.fault("")
        wait_until(self.has_ended_a_way_since_it_was_blocked, "the end of a way")
        self.assertEqual(self.contacts(), [])

    def has_ended_a_way_since_it_was_blocked(self):
        kinds = [event.kind for event in self.events.messages if event.model == f"kiva{NUMBER}"]
        return [kind for kind in kinds if kind in (Event.BLOCKED, Event.DONE)][-1] == Event.DONE

    def test_6_off_the_floor_it_has_an_alarm_until_it_is_back_and_automatic(self):
        place = f"is off the floor, at {self.other.robot.x:.1f}, {self.other.robot.y:.1f} m"
        self.until_alarm(f"kiva{OTHER} {place}: put it back, then set it AUTOMATIC")
        self.other.do(self.other.robot.carry_to, self.other.robot.x + 30, self.other.robot.y)
        self.other.do(self.other.vehicle.request_state)
        self.until_alarm(f"kiva{OTHER} {LOST}")
        set_modes(AUTOMATIC, OTHER)
        self.until_no_alarm(f"kiva{OTHER}")
        set_modes(OUT_OF_SERVICE, OTHER)

    def test_7_nothing_but_safe_after_a_loaded_vehicle_jumped_and_was_set_automatic(self):
        self.assertEqual(self.row()["shelf_id"], UNIT)
        self.once_it_drives(self.stand, *WIDE, ASKEW)
        self.until_alarm(f"kiva{NUMBER} {LOST}")
        set_modes(AUTOMATIC, NUMBER)
        asked = len(self.ear.orders)
        self.until_no_alarm(f"kiva{NUMBER} {LOST}")
        self.until_alarm(f"kiva{NUMBER} {LOST}")  # for it does not turn
        orders = [order for _, _, order in self.ear.orders[asked:]]
        self.assertLess(len(orders), 10)
        for order in orders:
            (node,) = order["nodes"]
            self.assertIn("theta", node["nodePosition"])
        x, y = self.grid.position(self.grid.cell_at(*WIDE))
        self.vehicle.do(self.stand, x, y, 0.0)
        wait_until(lambda: abs(self.row()["yaw"]) < 0.01, "its state")  # else it is lost at once
        set_modes(AUTOMATIC, NUMBER)
        self.until_no_alarm(f"kiva{NUMBER} {LOST}")
        stored = lambda event: (event.kind, event.shelf_id) == (TransportEvent.STORED, UNIT)  # noqa: E731
        self.transports.first(stored, PATIENCE)
        self.assertEqual(self.contacts(), [])

    def stand(self, x, y, yaw):
        """Puts the vehicle elsewhere."""
        self.vehicle.robot.carry_to(x, y)
        self.vehicle.robot.yaw = yaw
        self.vehicle.vehicle.request_state()

    def test_8_drive_without_torque_is_said_only_if_so(self):
        for type, what in (
            ("scannerDirty", "out of order (scannerDirty: line 7)"),
            ("motorError", "drive without torque"),
        ):
            error = Error(type, ErrorLevel.FATAL, "line 7")
            self.vehicle.robot.reports = {"errors": (error,)}
            self.until_alarm(f"kiva{NUMBER}: {what}")
            wait_until(lambda: f"{error.type}: line 7" in self.texts(Event.FAILED), "the event")  # noqa: B023
            self.vehicle.robot.reports = {}
            self.until_no_alarm(f"kiva{NUMBER}")

    def test_9_a_vehicle_with_4_percent_gets_no_transport(self):
        """Another robot gets it that is farther away."""
        self.other.fault("battery")
        self.other.do(self.other.vehicle.request_state)
        wait_until(lambda: self.row(OTHER)["charge"] < 0.05, "the charge")
        set_modes(AUTOMATIC, OTHER, 1)
        wait_until(lambda: self.state.messages[-1].automatic == 3, "three robots")
        begin = len(self.transports.messages)
        answer = call("/warehouse/transport", Transport, shelf_id=NEXT_UNIT, station="pick2")
        self.assertTrue(answer.accepted, answer.message)
        assigned = self.transports.wait_for(
            lambda events: [e for e in events[begin:] if e.kind == TransportEvent.ASSIGNED]
        )
        self.assertEqual(assigned[-1].kiva_id, 1)


if __name__ == "__main__":
    rospy.init_node("vda5050_troubles")
    latched("/warehouse/coordinator", CoordinatorState)
    rostest.rosrun("warehouse_tests", "vda5050_troubles", Troubles)
