# SPDX-License-Identifier: Apache-2.0
"""A fleet at work in which things can be made to go wrong."""

import numpy as np

from kiva_plugin_cpp import World
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_fleet.robots.robot_table import reports_of

BOX = """<sdf version="1.6"><model name="box"><static>true</static><link name="link">
  <collision name="body"><pose>0 0 0.3 0 0 0</pose>
    <geometry><box><size>0.5 0.5 0.6</size></box></geometry></collision>
</link></model></sdf>"""
WARM_UP = 60  # until units arrive as fast as they are taken [s]


class Site:
    """A preset with all its stations busy; `medium` has twenty robots."""

    def __init__(self, seed=1, connection=lambda world, seed: world, size="medium"):
        self.seed = seed
        self.world = World.preset(size, seed=seed)
        self.begin(connection(self.world, seed))
        self.run(WARM_UP)

    def begin(self, world):
        """Begins with a driver that knows nothing yet."""
        self.driver = FleetDriver(world, seed=self.seed)
        self.traffic, self.transports = self.driver.traffic, self.driver.transports
        self.plan = self.driver.plan
        self._demand = RandomTransports(self.transports, self.seed, exchange=10)
        self.events = []

    def take_over(self):
        """Another driver, that ends the paths it finds."""
        self.driver.close()
        self.begin(self.world)
        while (left := self.traffic.unwanted(reports_of(self.world.fleet))).any():
            self.world.cancel(self.traffic.robots.kiva_ids[left])
            self.run(0.5)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.driver.close()

    def run(self, seconds, *happenings):
        """Goes on for so long. Units delivered a minute."""
        before, end = self.transports.totals.delivered, self.world.time + seconds
        while self.world.time < end - 1e-9:
            for happening in happenings:
                happening.advance()
            self.step()
        return (self.transports.totals.delivered - before) * 60 / seconds

    def step(self):
        self.driver.step()
        events = self.transports.take_events()
        self.events += events
        self._demand.advance(self.world.time, events)

    def until(self, condition, patience=60):
        """Goes on until that holds: what it says."""
        end = self.world.time + patience
        while not (met := condition()):
            assert self.world.time < end, "waited in vain"
            self.step()
        return met

    def has_seen(self, kind, shelf):
        return any(e.kind == kind and e.shelf_id == shelf for e in self.events)

    def at_speed(self, loaded):
        """Robots that drive fast through a street."""
        fleet = self.world.fleet
        fast = np.hypot(fleet.vx, fleet.vy) > 1
        aside = (self.plan.storage | self.plan.lane).ravel()
        ready = fast & ((fleet.shelf_id != 0) == loaded) & ~aside[self.traffic.robots.cell]
        return np.flatnonzero(ready).tolist()

    def between_cells(self, loaded):
        """Those of them that are far from the middle of a cell."""
        fleet = self.world.fleet
        x, y = self.plan.point_of(self.plan.cell_of(fleet.x, fleet.y))
        off = np.hypot(fleet.x - x, fleet.y - y)
        return [robot for robot in self.at_speed(loaded) if off[robot] > 0.2]

    def traffic_says(self, what, robot):
        return getattr(self.traffic.robots, what)[robot]

    def name(self, robot):
        return f"kiva{self.traffic.robots.kiva_ids[robot]}"
