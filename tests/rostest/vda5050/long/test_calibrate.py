#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Vehicles over VDA 5050 and people that are other than believed: recorded, calibrated, and then
the forecast holds which did not before."""

import argparse
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
import yaml
from rostest_support.node_test import Listener, latched, wait_until
from sqlalchemy import create_engine, select

from warehouse_msgs.msg import CoordinatorState, Kpis, StationStates, TransportEvent, Vda5050
from warehouse_operations.forecast import ahead, pacing, program
from warehouse_operations.forecast.bands import forecast_of
from warehouse_operations.forecast.request import Request
from warehouse_operations.store import schema

ROBOTS = 4
LONG = 300.0  # [s, wall]
LEARNT, AHEAD = 110.0, 60.0  # of the shift, and of each forecast [s]
AGAIN = 10.0  # between two forecasts [s]
FORECASTS = 4
RUNS = 20
LINE = '{"time": %U, "topic": "%t", "payload": %p}'  # of mosquitto_sub


class Loop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.files, cls.database = (
            rospy.get_param(f"/calibrate_{name}") for name in ("files", "database")
        )
        cls.folder = Path(tempfile.mkdtemp(prefix="calibrate"))
        cls.processes = []
        cls.transports = Listener("/site/warehouse/transports", TransportEvent)
        at_broker = latched("/hall/warehouse/vda5050", Vda5050, lambda m: len(m.kiva_id) == ROBOTS)
        cls.record(at_broker.broker)
        cls.start_master(at_broker.broker)
        latched("/site/warehouse/coordinator", CoordinatorState, lambda s: s.automatic == ROBOTS)
        latched("/site/warehouse/stations", StationStates)

    @classmethod
    def tearDownClass(cls):
        for process in cls.processes:
            process.send_signal(signal.SIGINT)
            process.wait(20)

    @classmethod
    def record(cls, broker):
        host, _, port = broker.rpartition(":")
        cls.log = cls.folder / "log.jsonl"
        command = ["mosquitto_sub", "-h", host, "-p", port, "-t", "uagv/#", "-F", LINE]
        with cls.log.open("wb") as file:
            own = ["setpriv", "--pdeathsig", "TERM", *command]
            cls.processes.append(subprocess.Popen(own, stdout=file))

    @classmethod
    def start_master(cls, broker):
        robots = cls.folder / "robots.yaml"
        rows = {n: {"manufacturer": "kiva", "serial": str(n)} for n in range(1, ROBOTS + 1)}
        robots.write_text(yaml.safe_dump(rows))
        rospy.set_param("/site/vda5050_master/robots", str(robots))
        rospy.set_param("/site/vda5050_master/broker", broker)
        command = ["setpriv", "--pdeathsig", "TERM", "rosrun", "warehouse_vda5050", "master"]
        cls.processes.append(subprocess.Popen([*command, "__ns:=/site", "/clock:=clock"]))

    def shift_until(self, time):
        kpis = Listener("/site/warehouse/kpis", Kpis)
        wait_until(
            lambda: kpis.messages and kpis.messages[-1].header.stamp.to_sec() >= time,
            f"{time:.0f} s of the shift",
            LONG,
        )
        kpis.close()

    def done_at(self):
        """When orders were completed [s]."""
        engine = create_engine(f"sqlite:///{self.database}")
        with engine.connect() as connection:
            rows = connection.execute(select(schema.orders.c.completed)).scalars()
            return np.array([time for time in rows if time is not None])

    def band(self, at, realism):
        """(low, median, high) of the orders done AHEAD after a time of the shift."""
        args = argparse.Namespace(
            database=self.database,
            at=str(at),
            layout=f"{self.files}/believed.layout.yaml",
            robots=0,
            orders="",
            realism=realism,
        )
        asked = Request(AHEAD / 60, RUNS)
        prepared = program.prepare(args, asked)
        (task,) = pacing.paced(prepared.tasks)
        # In this process: runs of a forecast take only the time that nothing else wants.
        outcomes = [ahead.run(task, number) for number in range(RUNS)]
        forecast = forecast_of(task, asked.minutes, outcomes, prepared.known)
        return forecast.bands["done"][:, -1]

    def test_the_forecast_with_what_was_measured_holds(self):
        lifted = self.transports.until(lambda event: event.kind == TransportEvent.LIFTED)
        learnt = lifted.header.stamp.to_sec() + LEARNT
        self.shift_until(learnt)
        file = self.folder / "found.yaml"
        command = ["rosrun", "warehouse_operations", "calibrate", str(self.log), self.database]
        said = subprocess.run(
            [*command, "--out", str(file)], capture_output=True, text=True, timeout=60, check=False
        )
        self.assertEqual(said.returncode, 0, said.stderr)
        print(said.stdout)
        measured = yaml.safe_load(file.read_text())
        truth = yaml.safe_load(Path(self.files, "vehicles.yaml").read_text())["motion"]
        for name in ("speed", "acceleration", "quarter_turn_time"):
            value = truth[name]
            self.assertAlmostEqual(measured["motion"][name] / value, 1, delta=0.03, msg=name)
        piece = measured["service"]["seconds_a_piece"]
        self.assertAlmostEqual(piece["mean"], 5.0, delta=1.0)

        times = [learnt + AGAIN * i for i in range(FORECASTS)]
        self.shift_until(times[-1] + AHEAD + 5)
        done = self.done_at()
        rows = {"believed": [], "measured": []}
        for time in times:
            came = int(((done > time) & (done <= time + AHEAD)).sum())
            for name, realism in (("believed", ""), ("measured", str(file))):
                low, middle, high = self.band(time, realism)
                rows[name].append((low <= came <= high, abs(middle - came) / came))
                print(f"{time:.0f} s, {name}: {middle:g} ({low:g} to {high:g}), came {came}")
        held = {name: sum(row[0] for row in its) for name, its in rows.items()}
        error = {name: float(np.mean([row[1] for row in its])) for name, its in rows.items()}
        print(held, error)
        self.assertGreaterEqual(held["measured"], FORECASTS - 1)
        self.assertLessEqual(held["believed"], 1)
        self.assertLess(error["measured"], 0.15)
        self.assertGreater(error["believed"], 2 * error["measured"])


if __name__ == "__main__":
    rospy.init_node("test_calibrate")
    rostest.rosrun("warehouse_tests", "calibrate_loop", Loop)
