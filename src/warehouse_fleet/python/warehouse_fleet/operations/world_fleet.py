# SPDX-License-Identifier: Apache-2.0
"""The simulated robots of a world, as a shift drives them; ideal.IdealFleet is the other fleet."""

import numpy as np

from warehouse_fleet.fleet_driver import FleetDriver
from warehouse_fleet.transport import Task
from warehouse_fleet.travel import Travel

STUCK = 60.0  # a robot with somewhere to go that stood still for so long is stuck [s]


class WorldFleet:
    """A FleetDriver whose decisions are made by policies, with the figures that a report wants."""

    def __init__(self, world, site, seed):
        self.world, self.robots = world, len(site.robots)
        self.travel = Travel(site.plan, site.kinematics)
        self._driver = FleetDriver(world, seed=seed, kinematics=site.kinematics)
        self.transports = self._driver.transports

    def set_hooks(self, hooks):
        """Who decides from now on; see transport.Hooks."""
        self._hooks = hooks
        self.transports.choose_robot = self._choose_robot
        self.transports.choose_place = self._choose_place

    def _choose_robot(self, cell, free):
        traffic = self._driver.traffic
        seconds, _ = self.travel.unloaded([cell], traffic.cell[free])
        task = Task(0, 0, "", 0, 0)
        matched = self._hooks.match_robots([task], traffic.kiva_ids[free].tolist(), seconds)
        return next((free[robot] for _, robot in matched), free[0])

    def _choose_place(self, shelf_id, cell, free):
        metres = self.travel.loaded_from(int(cell)).metres[free]
        return self._hooks.choose_place(shelf_id, free, metres)

    def step_until(self, time):
        self._driver.step_until(time)

    def close(self):
        """Ends the planner's thread."""
        self._driver.close()

    @property
    def time(self):
        return self._driver.time

    @property
    def distance_m(self):
        return self._driver.distance_m

    @property
    def collisions(self):
        return self._driver.collisions

    @property
    def blocked(self):
        return self._driver.blocked

    @property
    def plan_ms(self):
        return self._driver.plan_ms

    @property
    def executed_over_planned(self):
        return self._driver.executed_over_planned

    @property
    def watchdog(self):
        """How often a robot made no progress for 30 s."""
        return self._driver.watchdog

    @property
    def stuck(self):
        """Robots that stand still for long though they have somewhere to go."""
        traffic = self._driver.traffic
        going = (traffic.goal >= 0) & (traffic.goal != traffic.cell) & ~traffic.busy
        return int(np.count_nonzero(going & (traffic.time - traffic.still_since > STUCK)))

    def state_hash(self):
        """Of the world."""
        return self.world.state_hash()
