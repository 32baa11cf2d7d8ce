# SPDX-License-Identifier: Apache-2.0
"""Whether a coordinator keeps up with simulated time."""

import math
from collections import deque
from itertools import pairwise
from statistics import median

from warehouse_fleet.hosts.fleet_driver import UPDATE

TOO_LONG = 1.0  # between two decisions, after which robots wait for the coordinator [s]
DECISIONS = 50  # that are looked at
REPEATED = 600.0  # after which it is said again, by the wall clock [s]


class PaceWatch:
    """Notices that simulated time runs away: that decisions of a coordinator are farther apart than
    it can drive by."""

    def __init__(self) -> None:
        self._decisions: deque[tuple[float, float]] = deque(maxlen=DECISIONS)  # simulated, wall [s]
        self._said = -math.inf  # by the wall clock [s]

    def decided(self, time: float, wall: float) -> str:
        """Takes in a decision at a simulated and a wall time [s]. Returns what is wrong with the
        pace, once in REPEATED seconds, or an empty text."""
        if self._decisions and time < self._decisions[-1][0]:
            self._decisions.clear()  # the world began again
        self._decisions.append((time, wall))
        if (
            len(self._decisions) < DECISIONS
            or wall < self._said + REPEATED
            or wall <= self._decisions[0][1]
        ):
            return ""
        apart = median(after[0] - before[0] for before, after in pairwise(self._decisions))
        if apart < TOO_LONG:
            return ""
        self._said = wall
        most = UPDATE * (DECISIONS - 1) / (wall - self._decisions[0][1])
        return (
            f"simulated time runs away from the coordinator: {apart:.1f} s pass between two of its "
            f"decisions, of which {UPDATE:g} s are meant. Robots wait for it, so what they deliver "
            f"says nothing about the warehouse; start with rtf:={most:.2g} or less"
        )
