# SPDX-License-Identifier: Apache-2.0
"""A shift and its fleet in one object."""

import contextlib
import math
import time as clock
from collections import Counter
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_operations.fleets.availability import Availability
from warehouse_operations.fleets.consumption import ITEM, MassOfItems
from warehouse_operations.fleets.ideal import IdealFleet
from warehouse_operations.fleets.loads import Loads
from warehouse_operations.policies import Policies
from warehouse_operations.runs.minute_log import MinuteLog
from warehouse_operations.runs.opening import open_shift
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.site import Site

if TYPE_CHECKING:
    from warehouse_operations.fleets.world_fleet import WorldFleet
    from warehouse_operations.store.database import Database

CYCLE = 0.1  # a world is stepped by this duration between two calls of the shift [s]
ROUNDING = 1e-6  # [s]
GATHER = 0.5  # interval at which rows are written to the database [s, wall]
ASKED = 16  # cycles between two calls of progress: in a large world these take seconds


class Operations:
    """Runs one shift with its orders, stock and fleet.

    world: a kiva_plugin_cpp.World; without one, or with physics False, robots are ideal. site: the
    warehouse; None: the world's own. orders: see orders_text.EXPECTED. policies: a Policies, a
    mapping, or the path of a YAML file. database: a URL, or the path of an SQLite file, in which
    everything is kept; a shift in it continues. planner, threads: see PlanLoop. availability: of
    ideal robots; simulated ones have their world's. The same seed gives the same shift, to the last
    event, with any number of threads. Raises what open_shift raises.

    context: what the parts of the shift share. stations: all of them. orders: those that are not
    over, by id. log: what happened, minute by minute.
    """

    def __init__(
        self,
        world: Any = None,
        orders: str = "fill",
        seed: int = 1,
        policies: Policies | Mapping[str, Any] | str | None = None,
        database: str | None = None,
        physics: bool = True,
        settings: Settings | None = None,
        site: Site | None = None,
        threads: int = 0,
        planner: Mapping[str, Any] | None = None,
        availability: Availability | None = None,
    ) -> None:
        self.site = site or Site.of_world(world)
        if not isinstance(policies, Policies):
            policies = Policies.read(policies) if isinstance(policies, str) else Policies(policies)
        self.fleet = self._fleet(world, physics, seed, threads, planner)
        self.database = _opened(database) if database else None
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
        self.context, self.stations = self.shift.context, self.shift.stations
        self.orders = self.shift.orders
        self.fleet.set_hooks(self.shift.hooks)
        if availability and isinstance(self.fleet, IdealFleet):
            rng = np.random.default_rng((seed, 1))
            self.fleet.keep_up(availability, rng, self._mass_of_items())
        elif self.site.weights and not self.ideal:
            self._weigh(world, Loads(self.shift.inventory, self.site.weights))
        self.wall_s = 0.0
        self.log = MinuteLog(
            self.context,
            self.stations,
            self.orders,
            fleet=self.fleet,
            kinematics=self.site.kinematics,
            spacing=self.site.plan.spacing,
        )

    def _mass_of_items(self) -> MassOfItems:
        """Returns the mass of the items on each unit: by the SKU master, where the site has one."""
        if self.site.weights:
            return Loads(self.shift.inventory, self.site.weights).of_unit
        items = Counter(unit for _, unit in self.site.items)
        return lambda unit: ITEM.mass * items[unit]

    def _weigh(self, world: Any, loads: Loads) -> None:
        """Has the world's items weigh what the stock says, from now on."""
        items = world.items
        masses = dict(zip(items["item_id"].tolist(), items["mass"].tolist()))
        for bin_ in self.shift.inventory.bins.values():
            if masses.get(int(bin_.item.removeprefix("item"))) != loads.of_item(bin_):
                world.set_mass(bin_.item, loads.of_item(bin_))
        self.shift.inventory.on_weight = lambda bin_: world.set_mass(bin_.item, loads.of_item(bin_))

    def _fleet(
        self, world: Any, physics: bool, seed: int, threads: int, planner: Any
    ) -> "IdealFleet | WorldFleet":
        if physics and world is not None:
            from warehouse_operations.fleets.world_fleet import WorldFleet

            return WorldFleet(world, self.site, seed, threads, planner)
        site = self.site
        return IdealFleet(site.plan, site.robots, site.units, kinematics=site.kinematics)

    @property
    def time(self) -> float:
        """The simulated time [s]."""
        return self.shift.now

    @property
    def ideal(self) -> bool:
        """Whether robots are ideal instead of simulated."""
        return isinstance(self.fleet, IdealFleet)

    def run(
        self,
        hours: float = 0.0,
        minutes: float = 0.0,
        seconds: float = 0.0,
        progress: "Callable[[Operations], bool | None] | None" = None,
        observe: "Callable[[Operations], None] | None" = None,
    ) -> None:
        """Simulates a duration, the sum of its arguments.

        progress(self) is called every ASKED cycles; it may return True to stop. observe(self) is
        called at the begin and after each cycle.
        """
        end = self.time + hours * 3600 + minutes * 60 + seconds
        self.step_until(end, progress, observe)

    def step_until(
        self,
        end: float,
        progress: "Callable[[Operations], bool | None] | None" = None,
        observe: "Callable[[Operations], None] | None" = None,
    ) -> None:
        """Goes on to a time of the shift [s]; see run() for progress and observe."""
        cycle = math.inf if self.ideal else CYCLE
        began, count = clock.monotonic(), 0
        if not self.time:
            self.shift.advance(0.0)
        observe = observe or _look_away
        observe(self)
        while self.shift.now < end:
            until = min(self.shift.next_time(), end, self.fleet.time + cycle)
            self.fleet.step_until(until)
            now = self.fleet.time
            self.shift.fallen.update(self.fleet.fallen_items)
            # A world counts steps: its times differ from these by rounding.
            self.shift.advance(until if abs(now - until) < ROUNDING else min(now, end))
            self.log.observe()
            observe(self)
            count += 1
            if progress and count % ASKED == 0 and progress(self):
                break
        self.wall_s += clock.monotonic() - began

    def kpis(self) -> dict[str, Any]:
        """Returns the figures so far, in the form of kpis.json."""
        return self.shift.figures(self.fleet, self.site.kinematics, self.wall_s)

    def close(self) -> None:
        """Writes pending rows and the run's figures to the database, and ends the fleet.

        Raises DatabaseError.
        """
        if self.database:
            self.shift.end(self.kpis())
            self.database.close()
            self.database = None
        self.fleet.close()

    def __enter__(self) -> "Operations":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _look_away(_: Operations) -> None:
    """Observes nothing."""


def _opened(url: str) -> "Database":
    """Returns a Database; imports its libraries here, for runs without one."""
    from warehouse_operations.store import database

    return database.Database(url, gather=GATHER)
