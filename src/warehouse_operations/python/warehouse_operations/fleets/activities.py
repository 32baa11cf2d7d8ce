# SPDX-License-Identifier: Apache-2.0
"""Robots' time by activity, counted alike for simulated and for ideal robots.

"queue" is the wait for a station: standing in its lane, or beneath the unit until the lane has
room. Standing in a street for others is part of the drive: that is what traffic costs.
"""

from typing import Any

import numpy as np

from warehouse_fleet.transports.transport_book import BRINGING

ACTIVITIES = ("to unit", "lift", "to station", "queue", "service", "back", "idle")
# By Step; an open transport has no robot.
OF_STEP = ("idle", "to unit", "queue", "lift", "to station", "service", "back", "lift")


class ActivityLog:
    """Robot-seconds by activity of a fleet that Transports drives."""

    def __init__(self) -> None:
        self._by_step = np.zeros(1 + len(OF_STEP))  # the first: without a transport
        self._in_lanes = 0.0  # of those at BRINGING

    def observe(self, elapsed: float, transports: Any, standing: np.ndarray) -> None:
        """Adds the activities of all robots for `elapsed` seconds; standing: (n,) bool by robot."""
        steps = transports.book.step_of
        queues = standing & (steps == BRINGING)
        if queues.any():
            self._in_lanes += elapsed * int(np.count_nonzero(queues & transports.in_lane()))
        self._by_step += elapsed * np.bincount(steps + 1, minlength=len(self._by_step))

    @property
    def seconds(self) -> dict[str, float]:
        """The robot-seconds spent on each of ACTIVITIES so far."""
        out = dict.fromkeys(ACTIVITIES, 0.0)
        for activity, seconds in zip(("idle", *OF_STEP), self._by_step.tolist()):
            out[activity] += seconds
        out["to station"] -= self._in_lanes
        out["queue"] += self._in_lanes
        return out
