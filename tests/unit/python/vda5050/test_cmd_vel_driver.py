# SPDX-License-Identifier: Apache-2.0
"""The example's driver, on a robot of wheels with inertia and a noisy odometry."""

import math
import random
import sys

import pytest
from paths import ROOT

sys.path.insert(0, str(ROOT / "examples" / "cmd_vel_robot"))

from driver import CmdVelDriver

STEP = 0.05  # [s]
LAG = 0.1  # of the motors [s]


class Wheels:
    """A unicycle that follows speeds with a lag; its odometry is off by noise [m]."""

    def __init__(self, noise=0.0, seed=1):
        self.driver = CmdVelDriver()
        self.x = self.y = self.yaw = self.v = self.w = self.time = 0.0
        self.noise, self.random = noise, random.Random(seed)
        self.furthest = 0.0
        self.run(0.2)

    def run(self, seconds):
        for _ in range(round(seconds / STEP)):
            self.step()

    def step(self):
        self.time += STEP
        off = [self.random.gauss(0, self.noise) for _ in range(3)]
        pose = (self.x + off[0], self.y + off[1], self.yaw + off[2])
        self.driver.on_odometry(self.time, pose, self.v, self.w)
        v, w = self.driver.command(self.time, STEP)
        self.v += (v - self.v) * STEP / (STEP + LAG)
        self.w += (w - self.w) * STEP / (STEP + LAG)
        self.yaw += self.w * STEP
        self.x += self.v * STEP * math.cos(self.yaw)
        self.y += self.v * STEP * math.sin(self.yaw)
        self.furthest = max(self.furthest, self.x)

    def until_idle(self, seconds=120):
        for _ in range(round(seconds / STEP)):
            self.step()
            if not self.driver.report().busy:
                self.run(0.5)
                return
        raise AssertionError(f"still under way at {self.x:.2f}, {self.y:.2f}")

    def expect(self, x, y, yaw):
        assert math.hypot(self.x - x, self.y - y) < 0.03, (self.x, self.y)
        assert abs(math.remainder(self.yaw - yaw, math.tau)) < math.radians(2), self.yaw


CORNER = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2)]


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.02])
def test_it_follows_the_points(noise):
    for seed in range(5):
        robot = Wheels(noise, seed)
        robot.driver.follow(1, 0, CORNER, len(CORNER))
        robot.until_idle()
        robot.expect(1, 2, math.pi)
        assert robot.driver.report().reached == len(CORNER)


def test_it_stops_at_the_last_released_point_and_goes_on():
    robot = Wheels(0.01)
    robot.driver.follow(1, 0, CORNER[:2], 2)
    robot.until_idle()
    robot.expect(1, 0, 0)
    assert robot.furthest < 1.03
    robot.driver.follow(1, 2, CORNER[2:], len(CORNER))
    robot.until_idle()
    robot.expect(1, 2, math.pi)


def test_what_is_released_in_time_costs_no_speed():
    robot = Wheels()
    robot.driver.follow(1, 0, [(0, 0), (1, 0), (2, 0)], 3)
    robot.run(2.5)
    slowest = robot.v
    robot.driver.follow(1, 3, [(3, 0), (4, 0)], 5)
    while robot.x < 3:
        robot.step()
        slowest = min(slowest, robot.v)
    assert slowest > 0.45
    robot.until_idle()
    robot.expect(4, 0, 0)


def test_it_stands_while_stopped():
    robot = Wheels()
    robot.driver.follow(1, 0, CORNER, len(CORNER))
    robot.run(2.5)
    robot.driver.stop(True)
    robot.run(1)
    at = robot.x
    robot.run(3)
    assert robot.x == pytest.approx(at, abs=0.01)
    robot.driver.stop(False)
    robot.until_idle()
    robot.expect(1, 2, math.pi)


def test_a_cancelled_path_ends_at_the_next_point():
    robot = Wheels()
    robot.driver.follow(1, 0, [(x, 0) for x in range(8)], 8)
    robot.run(4)
    begin = robot.x
    robot.driver.cancel()
    robot.until_idle()
    robot.expect(round(robot.x), 0, 0)
    assert begin < robot.x < begin + 1.5


def test_without_odometry_it_is_not_heard_and_stands():
    robot = Wheels()
    robot.driver.follow(1, 0, CORNER, len(CORNER))
    robot.run(2)
    assert robot.driver.command(robot.time + 5, STEP) == (0.0, 0.0)
    assert not robot.driver.report().heard


def test_a_robot_whose_clock_is_another_is_heard():
    robot = Wheels()
    robot.driver.on_odometry(robot.time - 1e6, (robot.x, robot.y, robot.yaw), 0.3, 0.1)
    robot.driver.command(robot.time + 10, STEP)
    report = robot.driver.report()
    assert report.heard and (report.vx, report.omega) == (pytest.approx(0.3), 0.1)
