# SPDX-License-Identifier: Apache-2.0
"""What a robot can do, and how long that takes it in closed form."""

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Kinematics:
    """Of a robot; the defaults are RAWSim-O's."""

    speed: float = 1.5  # [m/s]
    acceleration: float = 1.0  # [m/s²]
    quarter_turn: float = 0.625  # [s]
    lift: float = 2.2  # [s]

    @property
    def start_stop(self):
        """What a start and a stop cost beside driving at top speed [s]."""
        return self.speed / self.acceleration

    def run(self, distance):
        """The time for a straight run from rest to rest [s]; arrays too."""
        distance = np.abs(distance)
        full = distance / self.speed + self.start_stop
        short = 2 * np.sqrt(distance / self.acceleration)
        return np.where(distance < self.speed * self.start_stop, short, full)

    def leaving(self, distance):
        """The time from rest until so far away [s], still accelerating or at top speed."""
        ramp = self.speed**2 / (2 * self.acceleration)
        if distance <= ramp:
            return math.sqrt(2 * distance / self.acceleration)
        return self.start_stop + (distance - ramp) / self.speed
