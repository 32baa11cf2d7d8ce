#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A shift is forecast over ROS while it goes on; a newer forecast replaces an older one."""

import math
import unittest

import rospy
import rostest
from rostest_support.node_test import Listener, call, latched
from std_srvs.srv import Empty

from warehouse_msgs.msg import ForecastResult, Kpis, StationStates
from warehouse_msgs.srv import Forecast

LONG = 120.0  # [s, wall]


def ask(minutes=10.0, runs=3, *changes):
    return call("/warehouse/forecast", Forecast, minutes, runs, list(changes))


def result_of(answer):
    def is_of(message):
        return message.forecast_id == answer.forecast_id

    return latched("/warehouse/forecasts", ForecastResult, is_of)


class Forecasts(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("/warehouse/forecast", LONG)
        latched("/warehouse/kpis", Kpis, lambda kpis: kpis.orders_completed > 2)

    def test_0_the_shift_is_looked_ahead_of_without_a_request(self):
        first = latched("/warehouse/forecasts", ForecastResult)
        self.assertEqual((first.forecast_id, first.minutes, list(first.changes)), (1, 60.0, []))
        self.assertGreaterEqual(first.runs, 5)

    def test_1_a_forecast_comes_while_the_shift_goes_on(self):
        stations = Listener("/warehouse/stations", StationStates)
        begin = rospy.get_time()
        answer = ask()
        self.assertTrue(answer.accepted, answer.message)
        self.assertLess(rospy.get_time() - begin, 10.0)  # simulated, at five times real time
        result = result_of(answer)
        self.assertEqual((result.runs, len(result.time), list(result.changes)), (3, 10, []))
        self.assertAlmostEqual(result.time[-1], result.made_at + 600)
        bands = zip(result.done_p10, result.done_p50, result.done_p90)
        self.assertTrue(all(low <= middle <= high for low, middle, high in bands))
        self.assertGreater(result.done_p50[-1], 0)
        self.assertGreaterEqual(result.open_p50[-1], 40)
        self.assertIn("orders done within 10 minutes", result.text)
        stamps = [message.header.stamp.to_sec() for message in stations.messages]
        stations.close()
        gaps = [after - before for before, after in zip(stamps, stamps[1:])]
        self.assertTrue(gaps and max(gaps) < 5.0, gaps)  # of one a simulated second

    def test_2_a_closed_station_is_seen_in_it(self):
        result = result_of(ask(10.0, 3, "+0 close pick1"))
        self.assertEqual(list(result.changes), ["+0 close pick1"])
        self.assertIn("against as it is: -", result.text)

    def test_3_a_newer_one_takes_the_place_of_an_older_one(self):
        old = ask(1440.0, 1000)
        new = ask(1.0, 1)
        self.assertEqual(new.forecast_id, old.forecast_id + 1)
        self.assertEqual(result_of(new).runs, 1)

    def test_4_what_can_not_be_is_refused_in_a_sentence(self):
        for asked, text in (
            ((10.0, 1, "+0 close pick9"), "close is pick9; there are"),
            ((1441.0, 1), "minutes is 1441; above 0, up to 1440 (a day), was expected"),
            ((math.nan, 1), "minutes is nan"),
            ((10.0, 1, "nonsense"), "were expected"),
            ((10.0, 1, "+0 policy storage random"), "the coordinator decides it by itself"),
        ):
            answer = ask(*asked)
            self.assertEqual((answer.forecast_id, answer.accepted), (0, False))
            self.assertIn(text, answer.message)

    def test_5_a_world_that_is_paused_is_not_forecast(self):
        call("/gazebo/pause_physics", Empty)
        self.addCleanup(call, "/gazebo/unpause_physics", Empty)
        rospy.rostime.wallsleep(3.0)
        answer = ask()
        self.assertFalse(answer.accepted)
        self.assertIn("paused", answer.message)


if __name__ == "__main__":
    rospy.init_node("test_forecast")
    rostest.rosrun("warehouse_tests", "forecast_the_shift", Forecasts)
