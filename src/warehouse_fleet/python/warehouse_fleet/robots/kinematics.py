# SPDX-License-Identifier: Apache-2.0
"""Limits of a robot's motion, and closed forms for how long motions take."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

# The names of what was measured in the section `motion` of a realism.
MOTION = {
    "speed": "speed",
    "acceleration": "acceleration",
    "quarter_turn_time": "quarter_turn",
    "lift_time": "lift",
}


@dataclass(frozen=True)
class Kinematics:
    """The motion of one robot; the defaults are RAWSim-O's."""

    speed: float = 1.5  # top speed [m/s]
    acceleration: float = 1.0  # and deceleration [m/s²]
    quarter_turn: float = 0.625  # time of one, at rest [s]
    lift: float = 2.2  # time to raise or lower a unit [s]

    @property
    def start_stop(self) -> float:
        """The time that a start and a stop add to driving at top speed [s]."""
        return self.speed / self.acceleration

    def measured(self, motion: Mapping[str, float]) -> "Kinematics":
        """Returns the Kinematics with what was measured, by the names of a realism; 0: it was
        not."""
        values = {MOTION[key]: motion[key] for key in MOTION if motion.get(key, 0) > 0}
        return replace(self, **values)

    def run(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Returns the time of straight runs from rest to rest [s], in the shape of `distance` [m],
        whose sign does not matter."""
        distance = np.abs(distance)
        full = distance / self.speed + self.start_stop
        short = 2 * np.sqrt(distance / self.acceleration)
        return np.where(distance < self.speed * self.start_stop, short, full)

    def leaving(self, distance: float) -> float:
        """Returns the time from rest to a point `distance` [m] ahead that is passed without braking
        [s]."""
        ramp = self.speed**2 / (2 * self.acceleration)
        if distance <= ramp:
            return math.sqrt(2 * distance / self.acceleration)
        return self.start_stop + (distance - ramp) / self.speed
