# SPDX-License-Identifier: Apache-2.0
"""A shift and its fleet in one object."""

import contextlib
import math
import time as clock

from warehouse_operations import kpis
from warehouse_operations.ideal import IdealFleet
from warehouse_operations.opening import open_shift
from warehouse_operations.policies import Policies
from warehouse_operations.site import Site

CYCLE = 0.1  # for so long a world is stepped before the shift is asked again [s]
ROUNDING = 1e-6  # [s]


class Operations:
    """Orders, stock and fleet of one shift.

    world: a kiva_plugin_cpp.World. site: what stands in it, if it can't tell that itself; without
    world, or with physics False, robots are ideal. orders: fill, fill:N,
    poisson:PER_HOUR, FILE.csv or none. policies: a Policies, a mapping, or the path of a YAML file.
    database: a URL, or the path of an SQLite file, in which everything is kept; what one has kept
    goes on. The same seed gives the same shift, to the last event. Raises as open_shift does.
    """

    def __init__(
        self,
        world=None,
        orders="fill",
        seed=1,
        policies=None,
        database=None,
        physics=True,
        settings=None,
        site=None,
    ):
        self.site = site or Site.of_world(world)
        if not isinstance(policies, Policies):
            policies = Policies.read(policies) if isinstance(policies, str) else Policies(policies)
        self.fleet = self._fleet(world, physics, seed)
        self.database = None
        if database:
            from warehouse_operations.database import Database

            self.database = Database(database)
        with contextlib.ExitStack() as unless_open:
            if self.database:
                unless_open.callback(self.database.close)
            self.shift = open_shift(
                self.site,
                self.fleet.transports,
                orders=orders,
                seed=seed,
                policies=policies,
                database=self.database,
                settings=settings,
                travel=self.fleet.travel,
            )
            unless_open.pop_all()
        self.fleet.set_hooks(self.shift.hooks)
        self.wall_s = 0.0

    def _fleet(self, world, physics, seed):
        if physics and world is not None:
            from warehouse_operations.world_fleet import WorldFleet

            return WorldFleet(world, self.site, seed)
        site = self.site
        return IdealFleet(site.plan, site.robots, site.units, kinematics=site.kinematics)

    @property
    def time(self):
        """Simulated seconds."""
        return self.shift.now

    @property
    def ideal(self):
        """Whether robots are ideal instead of simulated."""
        return isinstance(self.fleet, IdealFleet)

    def run(self, hours=0.0, minutes=0.0, seconds=0.0, progress=None):
        """Goes on for so long.

        progress(self) is called now and then; it may return True to stop.
        """
        self.step_until(self.time + hours * 3600 + minutes * 60 + seconds, progress)

    def step_until(self, end, progress=None):
        """Goes on to a time of the shift [s]; progress as of run()."""
        cycle = math.inf if self.ideal else CYCLE
        began, count = clock.monotonic(), 0
        if not self.time:
            self.shift.advance(0.0)
        while self.shift.now < end:
            until = min(self.shift.next_time(), end, self.fleet.time + cycle)
            self.fleet.step_until(until)
            now = self.fleet.time
            self.shift.fallen.update(self.fleet.fallen_items)
            # A world counts steps: what differs by rounding alone is the same time.
            self.shift.advance(until if abs(now - until) < ROUNDING else min(now, end))
            count += 1
            if progress and count % 256 == 0 and progress(self):
                break
        self.wall_s += clock.monotonic() - began

    def kpis(self):
        """The figures up to now, as kpis.json has them."""
        return kpis.of_shift(self.shift, self.fleet, self.site.kinematics, self.wall_s)

    def close(self):
        """Ends the fleet, and writes what is left to the database with the run's figures; raises
        DatabaseError."""
        if self.database:
            self.shift.journal.end(self.shift, self.kpis())
            self.database.close()
            self.database = None
        self.fleet.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
