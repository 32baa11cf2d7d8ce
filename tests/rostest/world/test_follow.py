#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Paths, cancel and stop over their topics; what is recorded of them runs again the same."""

import re
import signal
import tempfile
import unittest

import rosbag
import rospy
import rostest
from rostest_support.node_test import wait_until
from rostest_support.warehouse_test import (
    ANSWERS,
    Collector,
    Commander,
    place,
    sim_time,
    step_until,
    waiting_commands,
)
from rostest_support.world_node import Node

from warehouse_msgs.msg import Event, FleetState, FollowPath, KivaStatus

FLEET_PERIOD = 0.05  # [s]


def speed(state):
    """The largest of a FleetState along x or y [m/s]."""
    return max(map(abs, state.vx + state.vy))


class Follow(unittest.TestCase):
    """One run for all, in lockstep; `paper` has robots 1 and 2."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.bag = f"{self._folder.name}/run.bag"

    def after(self, duration):
        """Steps that long [s]; returns the state of the fleet at the end."""
        end = sim_time() + duration
        step_until(end)
        return self.fleet.first(lambda state: state.stamp.to_sec() > end - FLEET_PERIOD / 2)

    def send(self, topic, count=1, **fields):
        """Sends a message of `count` commands, which the next step takes."""
        self.commander.send(topic, **fields)
        wait_until(lambda: waiting_commands() == count, f"{topic} on its way")

    def robot(self, fleet, kiva_id):
        """(state, path_id, reached, left, last_end) of one in a FleetState."""
        i = fleet.kiva_id.index(kiva_id)
        return fleet.state[i], fleet.path_id[i], fleet.reached[i], fleet.left[i], fleet.last_end[i]

    def test_paths_are_followed_told_refused_stopped_cancelled_and_recorded(self):
        with Node(
            world="paper", lockstep=True, record=self.bag, fleet_rate=1 / FLEET_PERIOD
        ) as node:
            self.commander = Commander()
            self.fleet = Collector("/warehouse/fleet", FleetState)
            self.follow()
            self.commander.close()
            self.fleet.close()
            node.send(signal.SIGINT)
            code, said = node.end()
            self.assertEqual(code, 0, said)
        with rosbag.Bag(self.bag) as bag:
            counts = {t: i.message_count for t, i in bag.get_type_and_topic_info().topics.items()}
        self.assertEqual(counts["/follow_limited"], 2)
        # The first one waited when the recording began, and is in its keyframe.
        self.assertEqual((counts["/follow"], counts["/cancel"], counts["/stop"]), (7, 1, 2))
        with Node(rtf=0, replay=self.bag) as node:
            node.says("replayed ", "FATAL")
            node.send(signal.SIGINT)
            code, said = node.end()
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"replayed \d+ steps, and all \d+ hashes")

    def answered(self, topic, **fields):
        """Sends a command; returns the event that the next steps answer it with."""
        self.commander.events.clear()
        self.send(topic, **fields)
        self.after(FLEET_PERIOD)
        return self.commander.events.first(lambda e: e.kind in ANSWERS)

    def follow(self):
        (x1, y1, _), (x2, y2, _) = place("kiva1"), place("kiva2")
        ways = {1: [(x1 + k, y1) for k in range(6)], 2: [(x2 + k, y2) for k in range(6)]}
        xs = {i: [x for x, _ in way] for i, way in ways.items()}
        ys = {i: [y for _, y in way] for i, way in ways.items()}
        answer = self.answered(
            "/follow", kiva_id=1, path_id=5, first=0, x=xs[1], y=ys[1], released=3
        )
        self.assertEqual((answer.kind, answer.model), (Event.ACCEPTED, "kiva1"), answer.text)
        state = self.after(6)
        self.assertEqual(self.robot(state, 1), (KivaStatus.STATE_WAITING, 5, 3, 2, 0))

        # Both at once: a change of the first one's path, and a new one.
        answer = self.answered(
            "/warehouse/follow",
            count=2,
            kiva_id=[1, 2],
            path_id=[5, 6],
            first=[3, 0],
            points=[0, 6],
            x=xs[2],
            y=ys[2],
            released=[6, 6],
        )
        self.assertEqual((answer.kind, answer.model), (Event.ACCEPTED, "kiva2"), answer.text)
        self.after(1.5)
        self.send("/stop", kiva_id=0, stop=True)
        self.assertLess(speed(self.after(2)), 1e-6)
        begin = place("kiva1"), place("kiva2")
        self.after(1)
        self.assertEqual((place("kiva1"), place("kiva2")), begin)
        self.send("/stop", kiva_id=0, stop=False)
        self.assertGreater(speed(self.after(0.5)), 0.1)
        self.send("/cancel", kiva_id=2)
        state = self.after(6)
        end = self.commander.events.first(lambda e: e.kind == Event.DONE and e.model == "kiva2")
        self.assertEqual(end.text, "cancelled")
        self.assertEqual(self.robot(state, 1), (KivaStatus.STATE_IDLE, 5, 6, 5, Event.DONE))

        self.refusals(xs[1], ys[1])
        self.limited()

    def limited(self):
        x, y, _ = place("kiva1")
        xs = [x - k for k in range(4)]
        path = FollowPath(kiva_id=1, path_id=11, x=xs, y=[y] * 4, released=4)
        inf = float("inf")
        answer = self.answered("/follow_limited", path=path, max_speed=[inf, 0.0, inf, inf])
        self.assertEqual((answer.kind, answer.model), (Event.REFUSED, "kiva1"))
        self.assertIn("max_speed 0", answer.text)
        answer = self.answered("/follow_limited", path=path, max_speed=[inf, 0.3, 0.3, inf])
        self.assertEqual((answer.kind, answer.model), (Event.ACCEPTED, "kiva1"), answer.text)
        speeds = [speed(self.after(FLEET_PERIOD)) for _ in range(120)]
        self.assertAlmostEqual(speeds[-1], 0.3, 6)
        self.assertLess(max(speeds), 0.3 + 1e-6)

    def refusals(self, x, y):
        cases = (
            (
                "/follow",
                "path 5 is over",
                {"kiva_id": 1, "path_id": 5, "x": x, "y": y, "released": 6},
            ),
            (
                "/follow",
                "6 x and 5 y",
                {"kiva_id": 1, "path_id": 9, "x": x, "y": y[:5], "released": 2},
            ),
            (
                "/follow",
                "no robot kiva77",
                {"kiva_id": 77, "path_id": 9, "x": x, "y": y, "released": 2},
            ),
            (
                "/follow",
                "finite",
                {"kiva_id": 1, "path_id": 9, "x": [float("nan")], "y": [0], "released": 1},
            ),
            ("/warehouse/follow", "1 kiva_id, 0 path_id", {"kiva_id": [1]}),
        )
        for topic, why, fields in cases:
            answer = self.answered(topic, **fields)
            self.assertEqual(answer.kind, Event.REFUSED, why)
            self.assertTrue(re.search(why, answer.text), answer.text)


if __name__ == "__main__":
    rospy.init_node("test_follow", disable_signals=True)
    rostest.rosrun("warehouse_tests", "follow", __name__)
