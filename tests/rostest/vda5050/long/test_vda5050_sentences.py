#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What the specification demands of a vehicle, at a robot of a running warehouse, over a real
broker: each test is named by its sentence, and sends JSON as any master does."""

import itertools
import json
import math
import os
import signal
import socket
import subprocess
import time
import unittest
import xmlrpc.client
from datetime import UTC, datetime

import rosgraph
import rospy
import rostest
from rostest_support.node_test import latched

from warehouse_msgs.msg import Vda5050
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import Link, MqttLoop, Outgoing
from warehouse_vda5050.mqtt.settings import read_settings
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.topics import Identity, Kind, Topics

WHO = Identity("kiva", "1")
PATIENCE, SOON = 60.0, 1.0  # for a drive, and for an answer [s]
OVER = ("FINISHED", "FAILED")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def action(type, id, blocking="HARD", **parameters):
    rows = [{"key": key, "value": value} for key, value in parameters.items()]
    fields = {"actionType": type, "actionId": id, "blockingType": blocking}
    return {**fields, "actionParameters": rows}


def pick(id, blocking="HARD", **more):
    return action("pick", id, blocking, stationType="floor", loadType="unit", **more)


class Peer:
    """A master that sends whatever it is given, and keeps what comes."""

    def __init__(self, broker):
        self.topics, self.loop = Topics(), MqttLoop()
        self.states, self.connections, self.sheets = [], [], []
        kept = {Kind.STATE: self.states, Kind.CONNECTION: self.connections}
        self.kept = {**kept, Kind.FACTSHEET: self.sheets}
        filters = [(self.topics.of(WHO, kind), kind.qos) for kind in self.kept]
        self.link = Link("sentences", read_settings(broker), filters, self.hear)
        self.loop.add(self.link)
        self.numbers = itertools.count()

    def close(self):
        self.link.close()
        self.loop.close()

    def hear(self, topic, payload, _retained):
        _, kind = self.topics.parse(topic)
        self.kept[kind].append(json.loads(payload))

    def send(self, kind, header=True, **content):
        stamp = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3] + "Z"
        fields = {
            "headerId": next(self.numbers),
            "timestamp": stamp,
            "version": "2.1.0",
            "manufacturer": WHO.manufacturer,
            "serialNumber": WHO.serial,
        }
        payload = json.dumps({**(fields if header else {}), **content}).encode()
        self.send_raw(kind, payload)

    def send_raw(self, kind, payload, retain=False):
        self.link.publish(Outgoing(self.topics.of(WHO, kind), payload, 0, retain))

    def instant(self, *actions):
        self.send(Kind.INSTANT_ACTIONS, actions=actions)

    def until(self, condition, what, seconds=PATIENCE):
        """Returns what condition() returns once it is true."""
        end = time.monotonic() + seconds
        while not (result := condition()):
            newest = texts(self.states[-1])[-300:] if self.states else None
            assert time.monotonic() < end, f"in vain: {what}; {newest}"
            self.loop.poll(0.02)
        return result

    def state(self, condition, what, seconds=PATIENCE, since=None):
        """Returns the first state from now on, or from number `since`, that a condition holds
        for."""
        begin = len(self.states) if since is None else since
        return self.until(
            lambda: next((s for s in self.states[begin:] if condition(s)), None), what, seconds
        )


def texts(state):
    return " ".join(error.get("errorDescription", "") for error in state["errors"])


def types(state):
    return [error["errorType"] for error in state["errors"]]


def statuses(state):
    return {row["actionId"]: row["actionStatus"] for row in state["actionStates"]}


class Sentences(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        broker = OwnBroker(free_port())
        cls.addClassCleanup(broker.close)
        address = f"127.0.0.1:{broker.port}"
        # Launches of their own: rostest starts no node again that died, and ends with the world.
        world = ("size:=small", "rtf:=3", "viewer:=false", "viewer_port:=0")
        cls.launch("warehouse_sim", "warehouse.launch", *world)
        cls.launch("warehouse_vda5050", "vehicles.launch", f"broker:={address}", "strict:=true")
        latched("/warehouse/vda5050", Vda5050, lambda message: 1 in message.kiva_id)
        cls.grid = grid_of(read_map())
        cls.peer = Peer(address)
        cls.addClassCleanup(cls.peer.close)
        cls.count = itertools.count(1)
        cls.peer.until(lambda: cls.peer.connections and cls.peer.sheets, "the vehicle")

    @classmethod
    def launch(cls, *arguments):
        command = ["setpriv", "--pdeathsig", "TERM", "roslaunch", "--sigint-timeout=3", *arguments]
        launch = subprocess.Popen(command)
        cls.addClassCleanup(launch.wait, 30)
        cls.addClassCleanup(launch.terminate)

    def setUp(self):
        self.peer.instant(action("stateRequest", f"s{next(self.count)}", "NONE"))
        self.peer.state(lambda s: True, "a state")
        self.here = self.grid.cell_at(*(self.peer.states[-1]["agvPosition"][k] for k in "xy"))
        self.way = self.free_way()

    def tearDown(self):
        """Brings the vehicle to rest."""
        state = self.peer.states[-1]
        if state["nodeStates"] and self.peer.connections[-1]["connectionState"] == "ONLINE":
            self.peer.instant(action("stopPause", f"g{next(self.count)}", "NONE"))
            self.peer.instant(action("cancelOrder", f"c{next(self.count)}", "NONE"))
            self.peer.state(lambda s: not (s["nodeStates"] or s["driving"]), "its rest")

    def free_way(self):
        """Returns four cells in a row, from where the robot stands."""
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            way = [(self.here[0] + k * dx, self.here[1] + k * dy) for k in range(4)]
            if self.grid.contains(way[-1]) and self.grid.blocked_among(way) is None:
                return way
        raise AssertionError(f"no way is free at {self.here}")

    def order(self, way, nodes=None, edges=None, **more):
        """Returns an order; nodes and edges: fields of them, by number."""
        rows = []
        for k, cell in enumerate(way):
            x, y = self.grid.position(cell)
            at = {"x": x, "y": y, "mapId": "warehouse"}
            fields = dict((nodes or {}).get(k, {}))
            at |= fields.pop("nodePosition", {})
            row = {"nodeId": self.grid.node_id(cell), "sequenceId": 2 * k, "released": True}
            rows.append({**row, "nodePosition": at, "actions": [], **fields})
        between = []
        for k, (a, b) in enumerate(itertools.pairwise(rows)):
            names = {"edgeId": f"e{k}", "startNodeId": a["nodeId"], "endNodeId": b["nodeId"]}
            row = {**names, "sequenceId": 2 * k + 1, "released": True, "actions": []}
            between.append({**row, **(edges or {}).get(k, {})})
        id = f"order{next(self.count)}-{time.time_ns()}"
        return {"orderId": id, "orderUpdateId": 0, "nodes": rows, "edges": between, **more}

    def driven(self, order):
        """Sends an order; returns the state at its end."""
        self.peer.send(Kind.ORDER, **order)

        def is_over(state):
            rest = state["nodeStates"] or state["edgeStates"] or state["driving"]
            actions = all(status in OVER for status in statuses(state).values())
            return state["orderId"] == order["orderId"] and not rest and actions

        return self.peer.state(is_over, f"the end of {order['orderId']}")

    def refused(self, order, word, **how):
        """Sends an order, and demands an error of it that names a word, at once."""
        self.peer.send(Kind.ORDER, **how, **order)
        state = self.peer.state(lambda s: word in texts(s), f"a refusal with {word}", 2 * SOON)
        self.assertNotEqual(state["orderId"], order["orderId"])
        return state

    # --- fields

    def driven_or_refused(self, order, word):
        """Sends an order. Returns the states up to its end; none if it was refused with a word."""
        since = len(self.peer.states)
        self.peer.send(Kind.ORDER, **order)

        def is_answered(state):
            return word in texts(state) or state["orderId"] == order["orderId"]

        state = self.peer.state(is_answered, "an answer", 2 * SOON, since)
        if state["orderId"] != order["orderId"]:
            return []
        self.peer.state(lambda s: not s["nodeStates"] and not s["driving"], "the end")
        return self.peer.states[since:]

    def test_the_maximum_speed_of_an_edge_ahead_is_kept_from_where_the_edge_begins(self):
        order = self.order(self.way, edges={1: {"maxSpeed": 0.2}})
        since, begin = len(self.peer.states), self.grid.position(self.way[0])
        self.assertFalse(self.driven(order)["errors"])
        speeds = []
        for state in self.peer.states[since:]:
            way = math.dist((state["agvPosition"]["x"], state["agvPosition"]["y"]), begin)
            if state["orderId"] == order["orderId"] and 1.0 < way < 2.0:
                speeds.append(math.hypot(state["velocity"]["vx"], state["velocity"]["vy"]))
        self.assertTrue(speeds, "no state of the second edge")
        self.assertLess(max(speeds), 0.2001)
        self.assertGreater(max(speeds), 0.19)

    def test_a_maximum_speed_that_no_robot_can_creep_at_is_refused_by_the_field(self):
        for speed in (0, -1, 0.001):
            order = self.order(self.way[:2], edges={0: {"maxSpeed": speed}})
            self.refused(order, "maxSpeed")

    def test_a_maximum_height_below_the_robots_own_is_refused_by_the_field(self):
        state = self.refused(self.order(self.way[:2], edges={0: {"maxHeight": 0.1}}), "maxHeight")
        self.assertIn("orderError", types(state))

    def test_an_orientation_across_the_edge_is_refused_by_the_field(self):
        across = math.atan2(self.way[1][1] - self.way[0][1], self.way[1][0] - self.way[0][0]) + 1.5
        fields = {"orientation": math.remainder(across, math.tau), "orientationType": "GLOBAL"}
        self.refused(self.order(self.way[:2], edges={0: fields}), "orientation")

    def test_where_rotation_is_not_allowed_the_robot_does_not_rotate(self):
        order = self.order(self.way[:2], edges={0: {"rotationAllowed": False}})
        headings = [
            state["agvPosition"]["theta"]
            for state in self.driven_or_refused(order, "rotationAllowed")
            if state["orderId"] == order["orderId"]
        ]
        turned = [math.remainder(theta - headings[0], math.tau) for theta in headings]
        self.assertLess(max(map(abs, turned), default=0.0), 0.1)

    def test_a_node_with_theta_counts_as_reached_with_that_heading_alone(self):
        along = math.atan2(self.way[1][1] - self.way[0][1], self.way[1][0] - self.way[0][0])
        across = math.remainder(along + math.pi / 2, math.tau)
        for theta, is_sure in ((across, False), (along, True)):
            at = {1: {"nodePosition": {"theta": theta, "allowedDeviationTheta": 0.1}}}
            states = self.driven_or_refused(self.order(self.way[:2], nodes=at), "theta")
            self.assertTrue(states or not is_sure, "the heading of the edge is refused")
            for state in states[-1:]:
                off = math.remainder(state["agvPosition"]["theta"] - theta, math.tau)
                self.assertLess(abs(off), 0.1)

    def test_an_order_for_another_floor_is_refused(self):
        elsewhere = {1: {"nodePosition": {"mapId": "upstairs"}}}
        state = self.refused(self.order(self.way[:2], nodes=elsewhere), "mapId")
        self.assertIn("upstairs", texts(state))

    def test_an_unknown_field_is_warned_of(self):
        self.peer.send(Kind.ORDER, **self.order(self.way[:2]), conformField=3)
        state = self.peer.state(lambda s: "conformField" in texts(s), "the warning", 2 * SOON)
        self.assertEqual({error["errorLevel"] for error in state["errors"]}, {"WARNING"})
        self.peer.state(lambda s: not s["nodeStates"] and not s["driving"], "the end")

    def test_an_order_without_header_is_a_validation_error(self):
        state = self.refused(self.order(self.way[:2]), "headerId", header=False)
        kinds = {e["errorType"] for e in state["errors"] if "headerId" in e["errorDescription"]}
        self.assertEqual(kinds, {"validationError"})

    # --- actions

    def test_a_pick_at_a_height_by_another_device_or_side_is_refused(self):
        for name, value in (("height", 9.9), ("lhd", "left fork"), ("side", "left")):
            actions = {1: {"actions": [pick(f"p{next(self.count)}", **{name: value})]}}
            state = self.refused(self.order(self.way[:2], nodes=actions), name)
            self.assertEqual(types(state)[-1], "orderError")

    def test_an_action_that_fails_at_the_last_node_is_an_error_of_the_state(self):
        id = f"p{next(self.count)}"
        end = self.driven(self.order(self.way[:2], nodes={1: {"actions": [pick(id)]}}))
        self.assertEqual(statuses(end)[id], "FAILED")
        self.assertTrue(end["errors"], "the state has no error")
        references = [r for error in end["errors"] for r in error["errorReferences"]]
        self.assertIn({"referenceKey": "actionId", "referenceValue": id}, references)

    def test_two_picks_at_one_node_are_done_one_after_the_other(self):
        ids = [f"p{next(self.count)}" for _ in range(2)]
        since = len(self.peer.states)
        actions = {1: {"actions": [pick(id, "NONE") for id in ids]}}
        end = self.driven(self.order(self.way[:2], nodes=actions))
        self.assertTrue(all(statuses(end)[id] in OVER for id in ids))
        for state in self.peer.states[since:]:
            running = [id for id in ids if statuses(state).get(id) in ("RUNNING", "INITIALIZING")]
            self.assertLess(len(running), 2)
        drop = action("drop", f"d{next(self.count)}", stationType="floor", loadType="unit")
        if end["loads"]:  # others' ways lead between units
            self.driven(self.order(self.way[1:2], nodes={0: {"actions": [drop]}}))

    def test_the_factsheet_names_blocking_types(self):
        rows = self.peer.sheets[-1]["protocolFeatures"]["agvActions"]
        picks = next(row for row in rows if row["actionType"] == "pick")
        # No value of blockingTypes fits the published schema of 2.1.0, so the description has them.
        self.assertIn("blocking types: NONE, SOFT, HARD", picks["actionDescription"])

    # --- states

    def test_each_order_is_answered_by_a_state_at_once_also_a_copy(self):
        good, bad = self.order(self.way[:2]), self.order([self.way[0], self.way[3]], nodes={})
        bad["nodes"][1]["nodePosition"]["x"] += 0.3
        bad["nodes"][1]["nodeId"] = "off the grid"
        for order in (bad, bad, good, good):
            begin = len(self.peer.states)
            self.peer.send(Kind.ORDER, **order)
            self.peer.state(lambda s: True, "a state", SOON, since=begin)
        self.peer.state(lambda s: not s["nodeStates"] and not s["driving"], "the end")

    def test_a_removed_retained_message_is_no_message(self):
        before = self.peer.states[-1]["errors"]
        self.peer.send_raw(Kind.ORDER, b"", retain=True)
        self.peer.instant(action("stateRequest", f"s{next(self.count)}", "NONE"))
        self.assertEqual(self.peer.state(lambda s: True, "a state")["errors"], before)

    # --- instant actions

    def test_an_order_that_is_cancelled_while_paused_between_cells_ends(self):
        self.peer.send(Kind.ORDER, **self.order(self.way))
        self.peer.state(lambda s: s["driving"], "it drives")
        self.peer.instant(action("startPause", f"p{next(self.count)}", "NONE"))
        self.peer.state(lambda s: s["paused"] and not s["driving"], "the pause")
        id = f"c{next(self.count)}"
        self.peer.instant(action("cancelOrder", id, "NONE"))
        state = self.peer.state(lambda s: statuses(s).get(id) in OVER, "its end", 10.0)
        self.assertEqual((statuses(state)[id], state["nodeStates"]), ("FINISHED", []))
        self.peer.instant(action("stopPause", f"g{next(self.count)}", "NONE"))
        self.peer.state(lambda s: not s["paused"] and not s["driving"], "its rest", 20.0)

    def test_the_name_of_the_log_is_in_the_result_of_log_report(self):
        id = f"l{next(self.count)}"
        self.peer.instant(action("logReport", id, "NONE", reason="a try"))
        state = self.peer.state(lambda s: statuses(s).get(id) in OVER, "its end", 10.0)
        row = next(row for row in state["actionStates"] if row["actionId"] == id)
        self.assertEqual(row["actionStatus"], "FINISHED")
        self.assertIn("-1-", row["resultDescription"])

    def test_sixty_instant_actions_are_refused_as_a_whole(self):
        ids = [f"m{next(self.count)}" for _ in range(60)]
        self.peer.instant(*(action("stateRequest", id, "NONE") for id in ids))
        state = self.peer.state(lambda s: "60 actions" in texts(s), "the refusal", 2 * SOON)
        self.assertFalse(set(ids) & statuses(state).keys())

    # --- programs that end

    def pid(self, node):
        api = rosgraph.Master("/sentences").lookupNode(node)
        return xmlrpc.client.ServerProxy(api).getPid("/sentences")[2]

    def test_z1_a_vehicle_whose_program_is_killed_in_mid_order_is_usable_again(self):
        self.peer.send(Kind.ORDER, **self.order(self.way))
        self.peer.state(lambda s: s["driving"], "it drives")
        nodes = rosgraph.Master("/sentences").getSystemState()[0]
        names = {name for _, publishers in nodes for name in publishers}
        os.kill(self.pid(next(name for name in names if "vehicles" in name)), signal.SIGKILL)
        begin = len(self.peer.connections)

        def kinds():
            return [message["connectionState"] for message in self.peer.connections[begin:]]

        self.peer.until(lambda: "CONNECTIONBROKEN" in kinds(), "the will", 10.0)
        self.peer.until(lambda: kinds()[-1] == "ONLINE", "it comes back")
        self.peer.state(lambda s: not s["driving"] and not s["nodeStates"], "its rest")
        self.setUp()
        end = self.driven(self.order(self.way[:2]))
        self.assertEqual(end["lastNodeId"], self.grid.node_id(self.way[1]))

    def test_z2_a_dead_world_is_a_broken_connection_within_five_seconds(self):
        os.kill(self.pid("/gazebo"), signal.SIGKILL)
        began, since = time.monotonic(), len(self.peer.states)
        self.peer.send(Kind.ORDER, **self.order(self.way[:2]))

        def is_broken():
            return self.peer.connections[-1]["connectionState"] == "CONNECTIONBROKEN"

        self.peer.until(is_broken, "the will", 10.0)
        self.assertLess(time.monotonic() - began, 5.0)
        last = self.peer.states[since:]
        self.assertIn("robotSilent", [kind for s in last for kind in types(s)], last)


if __name__ == "__main__":
    rospy.init_node("vda5050_sentences")
    rostest.rosrun("warehouse_tests", "vda5050_sentences", Sentences)
