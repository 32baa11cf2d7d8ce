#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Each fault on demand, by service and by HTTP, as the broker shows it."""

import json
import time
from datetime import UTC, datetime

import rospy
import rostest
from rostest_support.node_test import Listener, call, latched
from rostest_support.page_test import PageTest, ask

from warehouse_msgs.msg import Event, Vda5050
from warehouse_msgs.srv import Vda5050Fault
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.demo_master import order_of
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.model import Action, BlockingType, InstantActions
from warehouse_vda5050.mqtt.loop import Link, MqttLoop, Outgoing
from warehouse_vda5050.mqtt.settings import read_settings
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.topics import Identity, Kind, Topics

ASKS = 0.2  # between two requests for a state [s]
PATIENCE = 30.0  # [s]


class Watch:
    """Asks a vehicle for its state again and again; keeps what comes, with the time of arrival."""

    def __init__(self, broker, who):
        self.who, self.states, self._asked = who, [], 0.0
        self._codec, self._topics, self._headers = codec_for(), Topics(), Headers(who, "2.1.0")
        self._loop = MqttLoop()
        filters = [(self._topics.of(who, Kind.STATE), 0)]
        self._link = self._loop.add(Link("watch", read_settings(broker), filters, self._hear))
        self.until(lambda: self.states, "a state")

    def _hear(self, _topic, payload, _retained):
        self.states.append((time.monotonic(), json.loads(payload)))

    def send(self, kind, message):
        message.__dict__["header"] = self._headers.next(kind)
        payload = self._codec.encode(message)
        self._link.publish(Outgoing(self._topics.of(self.who, kind), payload))

    def until(self, condition, what):
        """Returns what condition() returns once it is true."""
        end = time.monotonic() + PATIENCE
        while not (result := condition()):
            assert time.monotonic() < end, f"waited in vain: {what}; {self.states[-1:]}"
            if time.monotonic() - self._asked > ASKS:
                self._ask()
            self._loop.poll(0.02)
        return result

    def _ask(self):
        """Asks for a state; returns the id of the request."""
        self._asked = time.monotonic()
        action = Action("stateRequest", f"s{time.time_ns()}", BlockingType.NONE)
        self.send(Kind.INSTANT_ACTIONS, InstantActions((action,)))
        return action.id

    def answer(self):
        """Returns a state that answers a request of now: others may have been sent before."""
        id = self._ask()
        return self.state(lambda s: id in {a["actionId"] for a in s["actionStates"]}, "the answer")

    def state(self, condition, what):
        """Returns the first state from now on for which condition(state) holds."""
        begin = len(self.states)
        return self.until(
            lambda: next((s for _, s in self.states[begin:] if condition(s)), 0), what
        )

    def some(self, count=8):
        """Returns the next states."""
        begin = len(self.states)
        return self.until(
            lambda: len(self.states) >= begin + count and [s for _, s in self.states[begin:]],
            f"{count} states",
        )

    def close(self):
        self._link.close()
        self._loop.close()


def clock(state):
    return datetime.fromisoformat(state["timestamp"]).timestamp()


def ids(states):
    return [state["headerId"] for state in states]


class Faults(PageTest):
    ready = "page.world.scene.robots.length === 4"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.events = Listener("/warehouse/events", Event)
        at_broker = latched("/warehouse/vda5050", Vda5050, lambda message: 1 in message.kiva_id)
        cls.watch = Watch(at_broker.broker, Identity("kiva", "1"))
        cls.addClassCleanup(cls.watch.close)

    def begin(self, fault, seconds=0.0):
        answer = call("/warehouse/vda5050_fault", Vda5050Fault, 1, fault, seconds)
        self.assertEqual((answer.success, answer.message), (True, ""))
        word = "fault on demand:" if fault else "fault on demand is over"
        self.events.until(lambda event: event.text.startswith(word))

    def end(self):
        self.begin("")
        self.watch.state(lambda s: not s["errors"], "a state without errors")

    def test_jump(self):
        x = self.watch.answer()["agvPosition"]["x"]
        self.begin("jump")
        self.watch.state(lambda s: abs(s["agvPosition"]["x"] - x - 2) < 0.1, "the jump")
        self.end()
        self.watch.state(lambda s: abs(s["agvPosition"]["x"] - x) < 0.1, "the place before")

    def test_heading(self):
        theta = self.watch.answer()["agvPosition"]["theta"]
        self.begin("heading")

        def turned(state):
            return abs(abs(state["agvPosition"]["theta"] - theta) % 3.1416 - 1.5708) < 0.1

        self.watch.state(turned, "the heading")
        self.end()

    def test_battery_by_service_and_by_the_script(self):
        self.begin("battery")
        self.watch.state(lambda s: s["batteryState"]["batteryCharge"] == 4, "the charge")
        self.end()
        self.watch.state(lambda s: s["batteryState"]["batteryCharge"] > 4, "the charge before")
        message = latched("/warehouse/vda5050", Vda5050, lambda m: 2 in m.kiva_id)
        self.assertEqual(message.faults[message.kiva_id.index(2)], "battery")

    def test_clock(self):
        self.begin("clock")
        now = datetime.now(UTC).timestamp()
        self.watch.state(lambda s: abs(clock(s) - now + 3600) < 60, "a time long past")
        self.end()
        self.watch.state(lambda s: abs(clock(s) - now) < 60, "the time")

    def test_lost_doubled_reordered(self):
        self.begin("lost")
        numbers = ids(self.watch.some())
        self.assertGreater(numbers[-1] - numbers[0], len(numbers) - 1)
        self.end()
        self.begin("doubled")
        numbers = ids(self.watch.some())
        self.assertLess(len(set(numbers)), len(numbers))
        self.end()
        self.begin("reordered")
        numbers = ids(self.watch.some())
        self.assertNotEqual(numbers, sorted(numbers))
        self.end()
        numbers = ids(self.watch.some())
        self.assertEqual(numbers, [*range(numbers[0], numbers[0] + len(numbers))])

    def test_silent(self):
        self.begin("silent", 2.0)
        heard = len(self.watch.states)
        self.watch.state(lambda s: True, "a state after the silence")
        self.events.until(lambda event: event.text == "fault on demand is over: silent")
        before, after = self.watch.states[heard - 1][0], self.watch.states[heard][0]
        self.assertGreater(after - before, 1.0)

    def test_error(self):
        for fault, level in (("error", "FATAL"), ("error:WARNING", "WARNING")):
            self.begin(fault)

            def has(state, level=level):
                errors = {(e["errorType"], e["errorLevel"]) for e in state["errors"]}
                return ("faultOnDemand", level) in errors

            self.watch.state(has, fault)
            self.end()

    def order(self, count):
        """Sends an order along the longest free way from where the robot stands, and back."""
        grid: Grid = grid_of(read_map())
        at = self.watch.answer()["agvPosition"]
        here = grid.cell_at(at["x"], at["y"])
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            way = [(here[0] + k * dx, here[1] + k * dy) for k in range(count)]
            if grid.contains(way[-1]) and grid.blocked_among(way) is None:
                break
        order = order_of(f"o{time.time_ns()}", way, grid)
        self.watch.send(Kind.ORDER, order)
        return order.id, grid.node_id(way[-1])

    def test_refuse(self):
        self.begin("refuse")
        self.watch.some(1)
        self.order(3)
        state = self.watch.state(lambda s: s["errors"], "the refusal")
        self.assertIn("refuses all orders", state["errors"][0]["errorDescription"])
        self.begin("")

    def test_slow(self):
        self.begin("slow")
        self.watch.some(1)
        id, goal = self.order(4)
        begin = len(self.watch.states)
        self.watch.state(lambda s: s["orderId"] == id and s["lastNodeId"] == goal, "the way's end")
        speeds = [abs(state["velocity"]["vx"]) for _, state in self.watch.states[begin:]]
        self.assertGreater(max(speeds), 0.05)
        self.assertLess(max(speeds), 0.9)
        self.end()

    def test_bad_requests_get_a_sentence(self):
        for number, fault, seconds, text in (
            (1, "explode", 0.0, "fault is 'explode'; one of silent"),
            (1, "lost", float("nan"), "seconds is nan; 0 or more was expected"),
            (1, "lost", -1.0, "seconds is -1; 0 or more was expected"),
            (99, "lost", 1.0, "kiva99 is no vehicle; vehicles are kiva1"),
        ):
            answer = call("/warehouse/vda5050_fault", Vda5050Fault, number, fault, seconds)
            self.assertFalse(answer.success)
            self.assertTrue(answer.message.startswith(text), answer.message)

    def test_http(self):
        status, answer = ask("/vda5050/1/faults", {"fault": "jump", "seconds": 60})
        self.assertEqual((status, answer), (200, {"message": "kiva1: jump"}))

        def row():
            return next(robot for robot in ask("/vda5050")[1] if robot["id"] == 1)

        self.watch.until(lambda: row()["faults"] == ["jump"], "the fault in the API")
        self.assertEqual(ask("/vda5050/1/faults", {"fault": ""})[0], 200)
        self.watch.until(lambda: row()["faults"] == [], "its end in the API")
        self.assertEqual(ask("/vda5050/99/faults", {"fault": "jump"})[0], 404)
        for body in ({"fault": "explode"}, {"fault": "lost", "seconds": -1}, {}):
            self.assertEqual(ask("/vda5050/1/faults", body)[0], 422, body)

    def test_page(self):
        self.page.read("page.select('kiva1')")
        faults = "document.querySelector('#care [aria-label=Fault]')"
        self.page.until(f"{faults}?.checkVisibility()")
        self.page.read(f"{faults}.value = 'battery'")
        self.page.read(f"{faults}.parentElement.querySelector('button').click()")
        self.watch.state(lambda s: s["batteryState"]["batteryCharge"] == 4, "the charge")
        self.page.until("document.getElementById('facts').textContent.includes('battery')")
        self.page.read(f"{faults}.parentElement.querySelector('button:last-child').click()")
        self.watch.state(lambda s: s["batteryState"]["batteryCharge"] > 4, "the charge before")


if __name__ == "__main__":
    rospy.init_node("test_vda5050_faults")
    rostest.rosrun("warehouse_tests", "vda5050_faults", Faults)
