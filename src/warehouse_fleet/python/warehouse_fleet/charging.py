# SPDX-License-Identifier: Apache-2.0
"""Who is charged where, and when. Who decides when is a policy, one of NAMES or one's own."""

import numpy as np

FULL = 0.98  # from there on nothing is to be gained


class Threshold:
    """Works until the battery is down to `low`, then charges up to `high`, 0…1: as far as the power
    of the charger lasts."""

    def __init__(self, low=0.3, high=0.8):
        if not 0 < low < high <= 1:
            raise ValueError(f"low is {low} and high {high}; 0 < low < high <= 1 was expected")
        self.low, self.high = low, high

    def sends(self, charge, _is_wanted):
        """Which robots without work are to charge, (n,) bool. charge: of their batteries, (n,);
        is_wanted: whether transports wait for robots."""
        return charge < self.low

    def frees(self, charge):
        """Which of those that charge may be given work, (n,) bool."""
        return charge >= self.high

    def spares(self, charge):
        """Which robots get no work even if no place to charge at is free, (n,) bool."""
        return charge < self.low / 2


class Opportunity(Threshold):
    """The same, but whoever has nothing to do charges as well, and works from `enough` on: the more
    that is, the fewer are the ways to a charger and back."""

    def __init__(self, low=0.3, high=0.9, enough=0.6):
        super().__init__(low, high)
        if not low < enough <= high:
            raise ValueError(f"enough is {enough}; low < enough <= high was expected")
        self.enough = enough

    def sends(self, charge, is_wanted):
        return charge < (self.low if is_wanted else self.high)

    def frees(self, charge):
        return charge >= self.enough


NAMES = {"opportunity": Opportunity, "threshold": Threshold}


class Charging:
    """The places to charge at, and who has each. Batteries that are not simulated cost nothing."""

    def __init__(self, plan, traffic, far):
        """far(cell, cells): how far those are."""
        self._cells, self._traffic, self._far = np.asarray(plan.charging, int), traffic, far
        self.policy = Opportunity()
        self.cell_of = {}  # by robot
        self.robot_s = 0.0  # spent at a place to charge at, in all
        self._time = None

    @property
    def _is_simulated(self):
        return len(self._cells) and (self._traffic.robots.charge < 1).any()

    def kept(self):
        """Which robots get no work, (n,) bool: they charge, or have to before all else."""
        charge = self._traffic.robots.charge
        kept = np.zeros(len(charge), bool)
        if not self._is_simulated:
            return kept
        charging = list(self.cell_of)
        kept[charging] = ~self.policy.frees(charge[charging])
        return kept | self.policy.spares(charge)

    def advance(self, idle, is_wanted):
        """Sends robots to charge; idle: those without work, (n,) bool."""
        if not self._is_simulated:
            return
        traffic = self._traffic
        self._count()
        for robot in [r for r in self.cell_of if not idle[r] or traffic.robots.charge[r] >= FULL]:
            del self.cell_of[robot]
        wants = idle & ~traffic.robots.broken & self.policy.sends(traffic.robots.charge, is_wanted)
        wants[list(self.cell_of)] = False
        for robot in sorted(np.flatnonzero(wants), key=lambda r: traffic.robots.charge[r]):
            if not self._place(int(robot)):
                break
        for robot, cell in self.cell_of.items():  # back, too, whom others pushed out
            if traffic.robots.goal[robot] != cell:
                traffic.robots.send(robot, cell)

    def _place(self, robot):
        """Whether there was a place for it: a free one, or that of a robot which needs it less."""
        traffic = self._traffic
        cells = np.setdiff1d(self._cells, [*self.cell_of.values(), *traffic.closed.tolist()])
        if not len(cells):
            others = np.array(list(self.cell_of), int)
            done = others[self.policy.frees(traffic.robots.charge[others])]
            if not len(done) or traffic.robots.charge[robot] >= self.policy.low:
                return False
            fullest = int(done[traffic.robots.charge[done].argmax()])
            cells = np.array([self.cell_of.pop(fullest)])
        # Where others only wait it is to wait for them to go.
        far = self._far(int(traffic.robots.cell[robot]), cells) + 10 * np.isin(
            cells, traffic.robots.cell
        )
        far[cells == traffic.robots.cell[robot]] = 0
        self.cell_of[robot] = int(cells[far.argmin()])
        return True

    def _count(self):
        traffic = self._traffic
        elapsed = 0.0 if self._time is None else traffic.time - self._time
        self._time = traffic.time
        self.robot_s += elapsed * sum(traffic.robots.cell[r] == c for r, c in self.cell_of.items())
