# SPDX-License-Identifier: Apache-2.0
"""A shift and its fleet in one object."""

import math
import time as clock
from dataclasses import dataclass, field

import numpy as np

from warehouse_fleet.floor_plan import FloorPlan
from warehouse_fleet.ideal import IdealFleet
from warehouse_fleet.operations import kpis
from warehouse_fleet.operations.assortment import stocked
from warehouse_fleet.operations.demand import make_demand
from warehouse_fleet.operations.policies import Policies
from warehouse_fleet.operations.shift import Settings, Shift
from warehouse_fleet.operations.whereabouts import Whereabouts
from warehouse_fleet.travel import Kinematics

CYCLE = 0.1  # for so long a world is stepped before the shift is asked again [s]


@dataclass(frozen=True)
class Site:
    """A warehouse before the shift: its floor and who stands where; cells by id."""

    plan: FloorPlan
    robots: dict
    units: dict
    items: list  # of (name, unit): the bins
    name: str = ""
    kinematics: Kinematics = field(default_factory=Kinematics)
    settings: Settings = field(default_factory=Settings)
    skus: int = None  # how many; None: by the number of bins

    @classmethod
    def of_world(cls, world, name=""):
        """That of an in-process kiva_plugin_cpp.World."""
        plan = FloorPlan.of_world(world)
        fleet, units = world.fleet, world.storage_units
        return cls(
            plan,
            {int(i): plan.cell_of(x, y) for i, x, y in zip(fleet.kiva_id, fleet.x, fleet.y)},
            {int(u["shelf_id"]): plan.cell_of(u["x"], u["y"]) for u in units},
            [(f"item{i['item_id']}", int(i["shelf_id"])) for i in world.items if i["shelf_id"]],
            name,
        )


class Operations:
    """Orders, stock and fleet of one shift.

    world: a kiva_plugin_cpp.World, or a Site, which has no physics. orders: fill, fill:N,
    poisson:PER_HOUR, FILE.csv or none. policies: a Policies, a mapping, or the path of a YAML file.
    database: a URL or the path of an SQLite file in which everything is kept. physics False: ideal
    robots instead of the world's. The same seed gives the same shift, to the last event.
    """

    def __init__(
        self,
        world,
        orders="fill",
        seed=1,
        policies=None,
        database=None,
        physics=True,
        settings=None,
    ):
        self.site = world if isinstance(world, Site) else Site.of_world(world)
        self.fleet = self._fleet(world, physics, seed)
        if not isinstance(policies, Policies):
            policies = Policies.read(policies) if isinstance(policies, str) else Policies(policies)
        stock_rng, demand_rng, policy_rng = (
            np.random.default_rng(seed).spawn(3)
            if hasattr(np.random.Generator, "spawn")
            else [np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(3)]
        )
        assortment, stock = stocked(self.site.items, stock_rng, self.site.skus)
        kinds = [station.kind for station in self.fleet.stations]
        demand = make_demand(
            orders, assortment, (kinds.count("PICK"), kinds.count("REPLENISH")), demand_rng
        )
        self.journal = None
        if database:
            from warehouse_fleet.operations.database import Database, DatabaseJournal

            self.database = Database(database)
            self.journal = DatabaseJournal(
                self.database,
                seed=seed,
                orders=str(orders),
                policies=policies.chosen,
                site=self.site.name,
            )
        floor = Whereabouts(
            self.site.plan, self.site.robots, self.site.units, getattr(self.fleet, "travel", None)
        )
        self.shift = Shift(
            self.fleet.transports,
            self.fleet.stations,
            assortment,
            [one for one, _ in stock],
            floor=floor,
            policies=policies,
            demand=demand,
            settings=settings or self.site.settings,
            journal=self.journal,
            rng=policy_rng,
        )
        if self.journal:
            self.journal.begin(self.shift)
        self.shift.begin(stock)
        self.wall_s = 0.0

    def _fleet(self, world, physics, seed):
        if physics and not isinstance(world, Site):
            from warehouse_fleet.fleet_driver import FleetDriver

            return FleetDriver(world, seed=seed)
        site = self.site
        return IdealFleet(site.plan, site.robots, site.units, kinematics=site.kinematics)

    @property
    def time(self):
        """Simulated seconds."""
        return self.shift.now

    def run(self, hours=0.0, minutes=0.0, seconds=0.0, progress=None):
        """Goes on for so long; progress(self) is called now and then, and may return True to stop."""
        self.step_until(self.time + hours * 3600 + minutes * 60 + seconds, progress)

    def step_until(self, end, progress=None):
        """Goes on to a time of the shift [s]."""
        cycle = math.inf if isinstance(self.fleet, IdealFleet) else CYCLE
        began, count = clock.monotonic(), 0
        if not self.time:
            self.shift.advance(0.0)
        while self.shift.now < end:
            until = min(self.shift.next_time(), end, self.fleet.time + cycle)
            self.fleet.step_until(until)
            self.shift.advance(min(self.fleet.time, end))
            count += 1
            if progress and count % 256 == 0 and progress(self):
                break
        self.wall_s += clock.monotonic() - began

    def kpis(self):
        """The figures up to now, as kpis.json has them."""
        return kpis.of_shift(self.shift, self.fleet, self.site.kinematics, self.wall_s)

    def close(self):
        """Writes what is left to the database, with the run's figures; raises what went wrong."""
        if self.journal:
            self.journal.end(self.shift, self.kpis())
            self.database.close()
            self.journal = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
