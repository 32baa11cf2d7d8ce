# SPDX-License-Identifier: Apache-2.0
"""Decides which robots charge, where and when. A policy decides when: one of NAMES, or a class with
the same methods."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from warehouse_fleet.robots.robot_table import RobotTable
from warehouse_fleet.transports.contracts import Clock, Roads
from warehouse_fleet.transports.distances import Distances

FULL = 0.98  # state of charge from which on charging gains nothing


class Policy(Protocol):
    """Decides when robots charge. All arrays are (n,); charge is the state of charge of batteries,
    0…1."""

    low: float  # a robot below it may take the place of one that could work already

    def sends(self, charge: NDArray[np.float32], is_wanted: bool, /) -> NDArray[np.bool_]:
        """Returns which robots without work are to charge. is_wanted: whether transports wait for
        robots."""
        ...

    def frees(self, charge: NDArray[np.float32], /) -> NDArray[np.bool_]:
        """Returns which charging robots may be given work."""
        ...

    def spares(self, charge: NDArray[np.float32], /) -> NDArray[np.bool_]:
        """Returns which robots get no work even if no charging place is free."""
        ...


class Threshold:
    """Lets robots work until the battery is down to `low`, then charges it up to `high`; both are
    states of charge, 0…1. Between the two, charging robots keep their places.

    Raises ValueError unless 0 < low < high <= 1.
    """

    def __init__(self, low: float = 0.3, high: float = 0.8) -> None:
        if not 0 < low < high <= 1:
            raise ValueError(f"low is {low} and high {high}; 0 < low < high <= 1 was expected")
        self.low, self.high = low, high

    def sends(self, charge: NDArray[np.float32], _is_wanted: bool) -> NDArray[np.bool_]:
        """Returns which robots without work are to charge, (n,): those below `low`."""
        return charge < self.low

    def frees(self, charge: NDArray[np.float32]) -> NDArray[np.bool_]:
        """Returns which charging robots may be given work, (n,): those from `high` on."""
        return charge >= self.high

    def spares(self, charge: NDArray[np.float32]) -> NDArray[np.bool_]:
        """Returns which robots get no work even if no charging place is free, (n,): those below
        half of `low`."""
        return charge < self.low / 2


class Opportunity(Threshold):
    """Charges robots without work as well, and lets them work from the state of charge `enough` on:
    the higher that is, the fewer trips robots make to a charger and back.

    Raises ValueError unless 0 < low < enough <= high <= 1.
    """

    def __init__(self, low: float = 0.3, high: float = 0.9, enough: float = 0.6) -> None:
        super().__init__(low, high)
        if not low < enough <= high:
            raise ValueError(f"enough is {enough}; low < enough <= high was expected")
        self.enough = enough

    def sends(self, charge: NDArray[np.float32], is_wanted: bool) -> NDArray[np.bool_]:
        """Returns which robots without work are to charge, (n,): those below `low`, or below `high`
        while no transport waits for a robot."""
        return charge < (self.low if is_wanted else self.high)

    def frees(self, charge: NDArray[np.float32]) -> NDArray[np.bool_]:
        """Returns which charging robots may be given work, (n,): those from `enough` on."""
        return charge >= self.enough


# Policies by their names in YAML.
NAMES: dict[str, type[Threshold]] = {"opportunity": Opportunity, "threshold": Threshold}


class Charging:
    """Assigns charging places, `cells`, to robots. Does nothing where batteries are not simulated.

    Attributes: `policy` (decides when robots charge), `cell_of` (the charging place of each robot
    that has one, by robot index), `robot_s` (robot seconds spent at charging places so far).
    """

    def __init__(
        self,
        cells: Sequence[int] | np.ndarray,
        distances: Distances,
        robots: RobotTable,
        roads: Roads,
        clock: Clock,
    ) -> None:
        self._cells, self._distances = np.asarray(cells, int), distances
        self._robots, self._roads, self._clock = robots, roads, clock
        self.policy: Policy = Opportunity()
        self.cell_of: dict[int, int] = {}
        self.robot_s = 0.0
        self._time: float | None = None

    @property
    def is_simulated(self) -> bool:
        """Whether robots have batteries, and places where they are charged."""
        return len(self._cells) > 0 and bool((self._robots.charge < 1).any())

    def kept(self) -> NDArray[np.bool_]:
        """Returns which robots get no work, (n,): those that charge, or must before anything
        else, be it elsewhere."""
        charge = self._robots.charge
        kept = np.zeros(len(charge), bool)
        charging = list(self.cell_of)
        kept[charging] = ~self.policy.frees(charge[charging])
        return kept | self.policy.spares(charge)

    def advance(self, idle: NDArray[np.bool_], is_wanted: bool) -> None:
        """Sends robots to charging places. idle: which have no work, (n,); is_wanted: whether
        transports wait for robots."""
        if not self.is_simulated:
            return
        robots = self._robots
        self._count()
        is_cut = self._roads.is_cut
        for robot in [
            r
            for r, cell in self.cell_of.items()
            if not idle[r] or robots.charge[r] >= FULL or is_cut[cell]
        ]:
            del self.cell_of[robot]
        wants = idle & ~robots.broken & self.policy.sends(robots.charge, is_wanted)
        wants[list(self.cell_of)] = False
        for robot in sorted(np.flatnonzero(wants), key=lambda r: float(robots.charge[r])):
            if not self._place(int(robot)):
                break
        # Also sends back robots that others pushed out of their places.
        for robot, cell in self.cell_of.items():
            if robots.goal[robot] != cell:
                robots.send(robot, cell)

    def _place(self, robot: int) -> bool:
        """Assigns a charging place to the robot: a free one, or that of a robot which needs it
        less. Returns whether there was one."""
        robots = self._robots
        reachable = self._cells[~self._roads.is_cut[self._cells]]
        cells = np.setdiff1d(reachable, [*self.cell_of.values(), *self._roads.closed.tolist()])
        if not len(cells):
            others = np.array(list(self.cell_of), int)
            done = others[self.policy.frees(robots.charge[others])]
            if not len(done) or robots.charge[robot] >= self.policy.low:
                return False
            fullest = int(done[robots.charge[done].argmax()])
            cells = np.array([self.cell_of.pop(fullest)])
        # A place counts as farther while another robot stands in it: that robot must leave first.
        own, taken = int(robots.cell[robot]), robots.cell
        far = self._distances(own, cells) + 10 * np.isin(cells, taken)
        far[cells == own] = 0
        self.cell_of[robot] = int(cells[far.argmin()])
        return True

    def _count(self) -> None:
        """Adds the time since the last call to `robot_s`, for each robot in its charging place."""
        time = self._clock.time
        elapsed = 0.0 if self._time is None else time - self._time
        self._time = time
        self.robot_s += elapsed * sum(self._robots.cell[r] == c for r, c in self.cell_of.items())
