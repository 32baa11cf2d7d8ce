# SPDX-License-Identifier: Apache-2.0
"""One run ahead: a fork goes on with ideal robots, or simulated ones, and is looked at minute by
minute."""

import contextlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_layout.message_enums import OrderEventKind
from warehouse_operations.fleets.availability import Availability
from warehouse_operations.fleets.forked_fleet import ForkedFleet
from warehouse_operations.fleets.loads import ITEM_KG
from warehouse_operations.forecast.fork import PLAN, TRANSPORTS, TRAVEL, Fork, shift_of
from warehouse_operations.runs.director import Director
from warehouse_operations.runs.event_file import Event, most_added
from warehouse_operations.runs.operations import CYCLE, ROUNDING
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.site import Site

if TYPE_CHECKING:
    from warehouse_operations.fleets.forked_world import ForkedWorld

OVER = (OrderEventKind.COMPLETED, OrderEventKind.CANCELLED)


@dataclass(frozen=True)
class Task:
    """What all runs of a forecast share. times: at which runs are looked at [s]. seed: of the
    forecast; a run adds its number. physics: robots are simulated, from the fork's checkpoint."""

    site: Site
    fork: Fork
    times: tuple[float, ...]
    events: tuple[Event, ...] = ()
    availability: Availability = field(default_factory=Availability)
    seed: int = 1
    physics: bool = False


@dataclass(frozen=True)
class Outcome:
    """What came of a run. done, open, late, pieces: at each time of its Task: orders done since the
    fork, not over, and past their due time (of both); pieces picked since the fork.

    over: when each order that was known at the fork was over [s], by id.
    """

    number: int
    done: tuple[int, ...]
    open: tuple[int, ...]
    late: tuple[int, ...]
    pieces: tuple[int, ...]
    over: dict[int, float]
    finish: float  # when all orders known at the fork were over [s]; NaN: not within


class Ahead:
    """A shift that goes on from a fork, with what a Director needs: shift, fleet, site, ideal."""

    def __init__(self, task: Task, number: int) -> None:
        fork, site = task.fork, task.site
        chance = (task.seed, number)
        spare = _spare_robots(site, fork, most_added(task.events))
        failures = task.availability.failures
        repairs = np.random.default_rng((*chance, 2**20))
        usual = failures.repair_time if failures else 0.0
        self.ideal = not task.physics
        self.fleet = _fleet(task, number, spare)
        transports: Any = self.fleet.transports
        parts = {TRANSPORTS: transports, TRAVEL: self.fleet.travel, PLAN: site.plan}
        self.shift = shift_of(fork, parts, chance)
        self.site = _with_robots(site, fork, spare)
        self.fleet.set_hooks(self.shift.hooks)
        self.fleet.resume(lambda: float(repairs.exponential(usual)) if usual else 0.0)
        if task.availability and isinstance(self.fleet, ForkedFleet):
            rng = np.random.default_rng((*chance, 2**20 + 2))
            self.fleet.keep_up(task.availability, rng, self._mass_of_items)
        if task.events:
            Director(self, task.events, sorted(spare), task.seed)
        self.known = dict(self.shift.orders)
        self.over: dict[int, float] = {}
        self.shift.on_order_event = self._note

    def _mass_of_items(self, unit: int) -> float:
        return ITEM_KG * len(self.shift.inventory.of_unit.get(unit, ()))

    def _note(self, order: Order, kind: OrderEventKind, *_: Any) -> None:
        if kind in OVER and order.order_id in self.known:
            self.over[order.order_id] = self.shift.now

    def step_until(self, end: float) -> None:
        """Goes on to a time [s]."""
        cycle = math.inf if self.ideal else CYCLE
        while self.shift.now < end:
            until = min(self.shift.next_time(), end, self.fleet.time + cycle)
            self.fleet.step_until(until)
            now = self.fleet.time
            if not self.ideal:
                self.shift.fallen.update(self.fleet.fallen_items)
            # A world counts steps: its times differ from these by rounding.
            self.shift.advance(until if abs(now - until) < ROUNDING else min(now, end))

    def close(self) -> None:
        """Ends the threads of simulated robots."""
        self.fleet.close()

    def overdue(self) -> int:
        """Returns the number of orders that are not over and past their due time."""
        now = self.shift.now
        return sum(0 < order.due < now for order in self.shift.orders.values())


def run(task: Task, number: int, look: Callable[[], object] = lambda: None) -> Outcome:
    """Returns the Outcome of a run. look: is called now and then. Raises EventError."""
    ahead = Ahead(task, number)
    with contextlib.closing(ahead):
        return _outcome(ahead, task, number, look)


def _outcome(ahead: Ahead, task: Task, number: int, look: Callable[[], object]) -> Outcome:
    tally = ahead.shift.tally
    done, late, pieces = tally.orders_completed, tally.late_orders, tally.items_picked
    rows: list[tuple[int, int, int, int]] = []
    for time in task.times:
        ahead.step_until(time)
        rows.append(
            (
                tally.orders_completed - done,
                len(ahead.shift.orders),
                tally.late_orders - late + ahead.overdue(),
                tally.items_picked - pieces,
            )
        )
        look()
    ended = len(ahead.over) == len(ahead.known)
    finish = max(ahead.over.values(), default=task.fork.time) if ended else math.nan
    done_then, open_then, late_then, pieces_then = _columns(rows)
    return Outcome(number, done_then, open_then, late_then, pieces_then, ahead.over, finish)


def _fleet(task: Task, number: int, spare: dict[int, int]) -> "ForkedFleet | ForkedWorld":
    """Returns the robots of a run."""
    fork, site = task.fork, task.site
    if task.physics:
        from warehouse_operations.fleets.forked_world import ForkedWorld

        return ForkedWorld(fork.world, fork.fleet, site, task.seed, number)
    return ForkedFleet(
        site.plan, fork.fleet, kinematics=site.kinematics, pace=fork.pace, spare=spare
    )


def _columns(rows: Sequence[tuple[int, int, int, int]]) -> list[tuple[int, ...]]:
    return [tuple(row[i] for row in rows) for i in range(4)]


def _spare_robots(site: Site, fork: Fork, count: int) -> dict[int, int]:
    """Returns cells for further robots by their new ids: free parking places first."""
    if not count:
        return {}
    plan, robots = site.plan, fork.fleet.robots
    taken = {robot.cell for robot in robots.values()}
    street = plan.passable & ~plan.lane & ~plan.storage & ~plan.parking
    cells = [*np.flatnonzero(plan.parking).tolist(), *np.flatnonzero(plan.storage).tolist()]
    cells += np.flatnonzero(street).tolist()
    free = [cell for cell in cells if cell not in taken] or cells
    first = max(robots, default=0) + 1
    return {first + i: free[i % len(free)] for i in range(count)}


def _with_robots(site: Site, fork: Fork, spare: dict[int, int]) -> Site:
    cells = {kiva_id: robot.cell for kiva_id, robot in fork.fleet.robots.items()}
    return replace(site, robots=cells | spare)


def times_of(fork: Fork, minutes: float, step: float = 60.0) -> tuple[float, ...]:
    """Returns the times at which runs are looked at [s]: each minute, and the end."""
    count = math.ceil(minutes * 60 / step - 1e-9)
    ends: Sequence[float] = [min(step * (i + 1), minutes * 60) for i in range(count)]
    return tuple(fork.time + end for end in ends)
