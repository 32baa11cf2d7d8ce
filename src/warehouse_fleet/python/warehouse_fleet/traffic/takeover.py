# SPDX-License-Identifier: Apache-2.0
"""Takes over robots that follow another coordinator's paths, and gives robots away."""

import numpy as np

from warehouse_fleet.robots.robot_table import Reports
from warehouse_fleet.traffic.traffic import Traffic
from warehouse_layout.message_enums import State, Status

IN_TRANSIT = 2.0  # longest delivery time of a message to a robot [s]
LONGEST = 30.0  # after which a takeover ends whatever a robot is still doing [s]


class Takeover:
    """Keeps a Traffic from commanding robots until all of them stand, from `time` [s] on."""

    def __init__(self, traffic: Traffic, time: float) -> None:
        self._traffic, self._since = traffic, time
        traffic.takes_over = True

    def advance(self, reports: Reports) -> None:
        """Ends the takeover once no robot drives on a path any more, by reports (n,) of REPORT."""
        elapsed = self._traffic.time - self._since
        is_over = elapsed > IN_TRANSIT and not self._drive(reports).any()
        self._traffic.takes_over = not is_over and elapsed < LONGEST

    def _drive(self, reports: Reports) -> np.ndarray:
        robots = self._traffic.robots
        under_way = (reports["path_id"] != 0) & (reports["status"] != Status.IDLE)
        return under_way & robots.automatic & ~robots.broken


class Handover:
    """Ends the paths of robots that leave the fleet: a path that was sent just before its
    cancellation may have come to the robot after that."""

    def __init__(self) -> None:
        self._idle_since: dict[int, float | None] = {}  # by robot [s]; None: it is not idle

    def begin(self, robot: int) -> None:
        """Notes that a robot leaves the fleet."""
        self._idle_since[robot] = None

    def end(self, robot: int) -> None:
        """Notes that a robot belongs to the fleet again."""
        self._idle_since.pop(robot, None)

    def waiting(self, time: float, reports: Reports) -> list[int]:
        """Returns the robots that wait on a path at that time [s], which is to be cancelled."""
        waiting = []
        for robot, since in list(self._idle_since.items()):
            if reports["status"][robot] != Status.IDLE:
                self._idle_since[robot] = None
                if reports["state"][robot] == State.WAITING:
                    waiting.append(robot)
            elif since is None:
                self._idle_since[robot] = time
            elif time - since > IN_TRANSIT:
                del self._idle_since[robot]
        return waiting
