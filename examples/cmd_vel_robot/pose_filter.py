# SPDX-License-Identifier: Apache-2.0
"""Smooths a noisy odometry: goes on by the speeds that it tells, and believes its poses little by
little."""

import math

Pose = tuple[float, float, float]  # x, y [m], yaw [rad]


class PoseFilter:
    """A complementary filter; `trust` is the share of a new pose that counts."""

    def __init__(self, trust: float = 0.1) -> None:
        self._trust = trust
        self._time = 0.0
        self.pose: Pose | None = None

    def update(self, time: float, measured: Pose, speed: float, rate: float) -> Pose:
        """Returns the pose at a time [s], by the pose measured then and the speeds [m/s, rad/s]."""
        if self.pose is None or not 0 <= time - self._time < 1:
            self.pose = measured
        else:
            self.pose = self._blend(self._ahead(time - self._time, speed, rate), measured)
        self._time = time
        return self.pose

    def _ahead(self, dt: float, speed: float, rate: float) -> Pose:
        x, y, yaw = self.pose or (0.0, 0.0, 0.0)
        middle = yaw + rate * dt / 2
        return x + speed * dt * math.cos(middle), y + speed * dt * math.sin(middle), yaw + rate * dt

    def _blend(self, expected: Pose, measured: Pose) -> Pose:
        x, y = (e + self._trust * (t - e) for e, t in zip(expected[:2], measured[:2]))
        turn = math.remainder(measured[2] - expected[2], math.tau)
        return x, y, expected[2] + self._trust * turn
