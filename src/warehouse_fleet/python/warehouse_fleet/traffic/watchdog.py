# SPDX-License-Identifier: Apache-2.0
"""Watches for robots that make no progress."""

from collections.abc import Callable

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable

NO_PROGRESS = 30.0  # a robot counts as stuck after standing this long [s]
LOOKS_AHEAD = 5.0  # without progress, after which the cause of waiting is looked up [s]
MOVES_UP = 10.0  # a robot that has moved in a lane within this is about to be served, or leaves [s]


class Watchdog:
    """Counts robots that make no progress. A robot that waits for one that is served at a station,
    broken, commanded by a person, or at an elevator is excused. `lane`, (cells,) bool: those in
    lanes of stations. `all_ahead` returns the robot for which each robot waits, (n,)."""

    def __init__(
        self, robots: RobotTable, lane: np.ndarray, all_ahead: Callable[[], np.ndarray]
    ) -> None:
        self.count = 0  # how often a robot made no progress for NO_PROGRESS
        self._robots, self._lane, self._all_ahead = robots, lane, all_ahead
        self._time = 0.0  # of the last update [s]
        count = len(robots)
        self._excused = np.full(count, -np.inf)  # when each was last seen to be excused [s]
        self._counted = np.zeros(count, bool)

    @property
    def stuck_for(self) -> np.ndarray:
        """(n,) [s]: how long each robot has made no progress without an excuse; excuses are looked
        up after LOOKS_AHEAD."""
        return self._time - np.maximum(self._robots.still_since, self._excused)

    def update(self, time: float) -> None:
        """Looks up excuses at a time [s], and counts the robots without one."""
        robots, self._time = self._robots, time
        self._excused[robots.broken | robots.slowed_for_people | robots.rides] = time
        waiting = self.stuck_for > LOOKS_AHEAD
        if waiting.any():
            self._excused[waiting & self._wait_excused()] = time
        stuck = self.stuck_for > NO_PROGRESS
        self.count += int(np.count_nonzero(stuck & ~self._counted))
        self._counted = stuck

    def _wait_excused(self) -> np.ndarray:
        """Returns (n,) bool: robots that wait, directly or behind others, for one that excuses."""
        robots = self._robots
        # A robot that has just moved in a lane, which all pass in their order.
        in_lane = self._lane[robots.cell] & (robots.cell != NOWHERE)
        excuses = in_lane & (self._time - robots.still_since < MOVES_UP)
        excuses |= robots.busy | ~robots.automatic | robots.broken | robots.slowed_for_people
        excuses |= robots.rides
        ahead = self._all_ahead()
        ahead[ahead == NOWHERE] = len(robots)  # the end of each chain, which excuses none
        ahead, excused = np.append(ahead, len(robots)), np.append(excuses, False)
        excused = excused[ahead]
        # Each pass doubles the links followed; a chain has at most as many as there are robots.
        for _ in range(len(robots).bit_length()):
            further = excused | excused[ahead]
            if np.array_equal(further, excused):
                break
            excused, ahead = further, ahead[ahead]
        return excused[:-1]
