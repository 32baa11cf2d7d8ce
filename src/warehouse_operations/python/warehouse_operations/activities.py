# SPDX-License-Identifier: Apache-2.0
"""What robots spend their time on, counted alike for simulated and for ideal robots.

"queue" is the wait for a station: standing in its lane, or beneath the unit until the lane has
room. Standing in a street for others is part of the drive: that is what traffic costs.
"""

import collections
from typing import Any

import numpy as np

from warehouse_fleet.transports import Step

ACTIVITIES = ("to unit", "lift", "to station", "queue", "service", "back", "idle")
OF_STEP = {
    Step.FETCHING: "to unit",
    Step.READY: "queue",
    Step.LIFTING: "lift",
    Step.BRINGING: "to station",
    Step.WAITING: "service",
    Step.STORING: "back",
    Step.DROPPING: "lift",
}


class ActivityLog:
    """Robot-seconds by activity of a fleet that Transports drives."""

    def __init__(self, robots: int) -> None:
        self.robots = robots
        self.seconds = dict.fromkeys(ACTIVITIES, 0.0)

    def observe(self, elapsed: float, transports: Any, standing: np.ndarray) -> None:
        """Adds what all robots do for `elapsed` seconds; standing: (n,) bool by robot."""
        doing: collections.Counter[str] = collections.Counter()
        bringing = Step.BRINGING
        for one in transports.assigned():
            queues = one.step == bringing and standing[one.robot] and transports.in_lane(one)
            doing["queue" if queues else OF_STEP[one.step]] += 1
        doing["idle"] = self.robots - doing.total()
        for activity, count in doing.items():
            self.seconds[activity] += elapsed * count
