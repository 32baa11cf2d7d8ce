# SPDX-License-Identifier: Apache-2.0
"""The simulated robots of a world, as a shift drives them; ideal.IdealFleet is the other fleet."""

from collections import Counter

import numpy as np

from warehouse_fleet.fleet_driver import UPDATE, FleetDriver
from warehouse_operations.activities import ActivityLog
from warehouse_operations.protocols import Task
from warehouse_operations.travel import Travel

TOW_AFTER = 60.0  # in which people come to a robot that is broken in others' way [s]
STUCK = 60.0  # a robot with somewhere to go that stood still for so long is stuck [s]
ROUNDING = 1e-9  # [s]


class WorldFleet:
    """A FleetDriver whose decisions are made by policies, with the figures that a report wants."""

    def __init__(self, world, site, seed):
        self.world, self.plan, self.robots = world, site.plan, len(site.robots)
        self.travel = Travel(site.plan, site.kinematics)
        self._driver = FleetDriver(
            world, seed=seed, kinematics=site.kinematics, tow_after=TOW_AFTER
        )
        self.transports = self._driver.transports
        self._cells = self._driver.traffic.cell
        self._activities = ActivityLog(self.robots)
        self._traffic, self._waiting = np.zeros((2, site.plan.passable.size))

    def set_hooks(self, hooks):
        """Who decides from now on; see protocols.Hooks."""
        self._hooks = hooks
        self.transports.match_robots = self._match_robots
        self.transports.choose_place = self._choose_place
        self.transports.park = self._park
        self.transports.charging.policy = hooks.charging

    def _match_robots(self, asked, free):
        traffic, transports = self._driver.traffic, self.transports
        cells = [transports.cell_of_unit[one.shelf] for one in asked]
        seconds, _ = self.travel.unloaded(cells, traffic.cell[free])
        waiting = Counter(one.station for one in asked)
        tasks = [
            Task(
                one.number,
                one.shelf,
                one.station,
                one.priority,
                transports.waiting(one.station) + waiting[one.station],
            )
            for one in asked
        ]
        robots = traffic.kiva_ids[free].tolist()
        for task, robot in self._hooks.match_robots(tasks, robots, seconds):
            yield asked[task], free[robot]

    def _choose_place(self, shelf_id, cell, free):
        metres = self.travel.loaded_from(int(cell)).metres[free]
        return self._hooks.choose_place(shelf_id, free, metres)

    def _park(self, robot):
        traffic = self._driver.traffic
        return self._hooks.park(int(traffic.kiva_ids[robot]), int(traffic.cell[robot]))

    def step_until(self, time):
        while self.time < time - ROUNDING:
            self._driver.step()
            self._see()

    def _see(self):
        """Where loaded robots come through, where robots wait, and what they do."""
        traffic = self._driver.traffic
        cells, inside = traffic.cell, traffic.cell >= 0
        came = inside & traffic.loaded & (cells != self._cells)
        np.add.at(self._traffic, cells[came], 1)
        standing = inside & (traffic.still_since < traffic.time)
        np.add.at(self._waiting, cells[standing], UPDATE)
        self._activities.observe(UPDATE, self.transports, standing)
        self._cells = cells

    def traffic(self):
        """How often a robot with a load came through each cell, (h, w)."""
        return self._traffic.reshape(self.plan.shape)

    def waiting_map(self):
        """Robot-seconds spent in each cell by those who stood on their way, (h, w)."""
        return self._waiting.reshape(self.plan.shape)

    def activities(self):
        """Robot-seconds spent on each of activities.ACTIVITIES up to now."""
        return dict(self._activities.seconds)

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
    def energy(self):
        """How batteries are, and the robots' time at charging; empty where there are none."""
        charge = self._driver.traffic.charge
        robot_s = self._driver.failures.robot_s
        if not (charge < 1).any():
            return {}
        return {
            "charge_mean": float(charge.mean()),
            "charge_least": float(charge.min()),
            "charging_fraction": self.transports.charging.robot_s / max(robot_s, 1e-9),
        }

    @property
    def failures(self):
        """What broke: a FailureLog."""
        return self._driver.failures

    @property
    def fallen_items(self):
        """Those that lie on the floor, by name."""
        return [f"item{item}" for item in self._driver.fallen]

    @property
    def people(self):
        """What people on the floor cost: a PeopleLog."""
        return self._driver.people

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
        return int(np.count_nonzero(going & (traffic.stuck_for > STUCK)))

    def state_hash(self):
        """Of the world."""
        return self.world.state_hash()
