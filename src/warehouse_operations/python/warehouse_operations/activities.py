# SPDX-License-Identifier: Apache-2.0
"""What robots spend their time on, counted alike for simulated and for ideal robots.

"queue" is the wait for a station: standing in its lane, or beneath the unit until the lane has
room. Standing in a street for others is part of the drive: that is what traffic costs.
"""

from typing import Any

import numpy as np

from warehouse_fleet.transport_book import BRINGING

ACTIVITIES = ("to unit", "lift", "to station", "queue", "service", "back", "idle")
# By Step: a transport that is open has no robot.
OF_STEP = ("idle", "to unit", "queue", "lift", "to station", "service", "back", "lift")


class ActivityLog:
    """Robot-seconds by activity of a fleet that Transports drives."""

    def __init__(self, robots: int) -> None:
        self.robots = robots
        self.seconds = dict.fromkeys(ACTIVITIES, 0.0)

    def observe(self, elapsed: float, transports: Any, standing: np.ndarray) -> None:
        """Adds what all robots do for `elapsed` seconds; standing: (n,) bool by robot."""
        steps = transports.book.step_of
        queues = standing & (steps == BRINGING)
        waiting = int(np.count_nonzero(queues & transports.in_lane())) if queues.any() else 0
        doing = np.bincount(steps + 1, minlength=len(OF_STEP) + 1)[1:].tolist()
        counts = dict.fromkeys(ACTIVITIES, 0)
        for activity, count in zip(OF_STEP, doing):
            counts[activity] += count
        counts["to station"] -= waiting
        counts["queue"] += waiting
        counts["idle"] = self.robots - sum(doing)
        for activity, count in counts.items():
            self.seconds[activity] += elapsed * count
