# SPDX-License-Identifier: Apache-2.0
"""A shift: orders go to stations, units to the orders, pieces into totes, and stock is refilled.

It is driven by events and by simulated time, and sees the fleet through protocols.Requests alone:

    shift.advance(time)           # handles all events up to then
    shift.next_time()             # time of the next call, if no event comes before
"""

from collections.abc import Callable, Collection, Iterable
from typing import Any

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout.message_enums import OrderState, StationMode
from warehouse_operations.goods.kinds import Goods
from warehouse_operations.policies import Policies
from warehouse_operations.policies.view import View
from warehouse_operations.shift import kpis
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.fallen import Fallen
from warehouse_operations.shift.journal import Journal
from warehouse_operations.shift.manual_stations import (
    ManualPicking,
    ManualReplenishing,
    ManualStations,
)
from warehouse_operations.shift.notices import Notices
from warehouse_operations.shift.order_book import Lines, OrderBook
from warehouse_operations.shift.picking import Picking
from warehouse_operations.shift.policy_hooks import PolicyHooks
from warehouse_operations.shift.replenishing import PERIOD, Replenishing
from warehouse_operations.shift.taking_back import TakingBack
from warehouse_operations.shift.task_reports import TaskNumbers
from warehouse_operations.shift.tasks import Tasks
from warehouse_operations.shift.visits import Visits
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.event_queue import Clock
from warehouse_operations.stock.goods_in import GoodsIn
from warehouse_operations.stock.inventory import Bin, Reason
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.protocols import Requests
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.stations import WorkStation
from warehouse_operations.stock.stored_warehouse import Changes, Stored
from warehouse_operations.stock.units_by_id import UnitSet
from warehouse_operations.stock.whereabouts import Whereabouts

__all__ = ["Settings", "Shift"]

FEW = 3  # orders that say how long others take, at least
RECENT = 200  # latest orders, whose median time is the usual one


class Shift:
    """The work of a warehouse during a shift.

    order_book, visits, picking, replenishing, fallen, manual, tasks: its parts, which share its
    context. task_numbers: of tasks for people. view: its state for policies. hooks: the policies'
    answers for the fleet. notices: for people. tally: counts for the KPIs.
    """

    def __init__(
        self,
        transports: Requests,
        assortment: Assortment,
        bins: Collection[Bin],
        *,
        floor: Whereabouts,
        policies: Policies,
        demand: Any = None,
        settings: Settings | None = None,
        journal: Journal | None = None,
        rng: np.random.Generator | None = None,
        now: float = 0.0,
        goods: Goods | None = None,
    ) -> None:
        self.policies, self.floor = policies, floor
        self.settings = settings or Settings()
        self.assortment, self.demand = assortment, demand
        self._transports, self._rng = transports, rng or np.random.default_rng(1)
        self._clock, self.notices = Clock(now), Notices()
        self.context = Context(self._clock, bins, journal or Journal(), goods)
        self.inventory, self.tally = self.context.inventory, self.context.tally
        self.order_book = OrderBook(self.context, assortment.skus, self.notices)
        most = self.settings.units_at(len(floor.robots), len(floor.plan.stations))
        self.visits = Visits(self.context, transports, floor, self.notices, most)
        self._stations = {place.name: self._work_station(place) for place in floor.plan.stations}
        self._make_parts(GoodsIn(), TaskNumbers())
        self._clock.schedule(now, self._refill)
        self._schedule_bundle()

    def _make_parts(self, goods_in: GoodsIn, task_numbers: TaskNumbers) -> None:
        context, order_book, visits = self.context, self.order_book, self.visits
        self.view = View(
            clock=self._clock,
            inventory=self.inventory,
            backlog=order_book.backlog,
            floor=self.floor,
            stations=self.stations,
            orders=order_book.orders,
            goods_in=goods_in,
            free_units=visits.free_units,
            assortment=self.assortment,
            settings=self.settings,
            rng=self._rng,
        )
        self.hooks, self.task_numbers = PolicyHooks(self.policies, self.view), task_numbers
        self.picking = Picking(
            context,
            [station for station in self.stations if station.picks],
            policies=self.policies,
            view=self.view,
            order_book=order_book,
            visits=visits,
            task_numbers=task_numbers,
        )
        self.replenishing = Replenishing(
            context,
            [station for station in self.stations if station.replenishes],
            policies=self.policies,
            view=self.view,
            goods_in=goods_in,
            visits=visits,
            task_numbers=task_numbers,
        )
        taking_back = TakingBack(context, order_book, self.picking, task_numbers)
        self.manual = ManualStations(
            context,
            self._stations,
            ManualPicking(context, self.picking, order_book, visits, taking_back),
            ManualReplenishing(context, self.replenishing, task_numbers, taking_back),
        )
        self.tasks = Tasks(context, self._stations, self.manual.part_of)
        self.fallen = Fallen(self.inventory, visits, self.picking, self.replenishing)

    def _work_station(self, place: Any) -> WorkStation:
        settings = self.settings.of(place.name)
        station = WorkStation(place, settings, self.inventory, self.began)
        edges = [(0.0, False)] if settings.hours else []
        edges += [edge for begin, end in settings.hours for edge in ((begin, True), (end, False))]
        for hour, is_open in edges:
            self._clock.schedule(self.began + 3600 * hour, self._keep_hours, (station, is_open))
        for hour, pickers in settings.shifts():
            self._clock.schedule(self.began + 3600 * hour, self._set_pickers, (station, pickers))
        if station.piece_sd:
            station.set_chance(np.random.default_rng(self._rng.integers(2**63)))
        return station

    def _set_pickers(self, argument: tuple[WorkStation, int]) -> None:
        """Sets the number of a station's pickers, 0 during a break."""
        station, pickers = argument
        station.set_pickers(pickers, self.now)
        station.next_work()

    def _keep_hours(self, argument: tuple[WorkStation, bool]) -> None:
        """Opens or closes a station as its hours say."""
        station, is_open = argument
        self.set_station(station.name, is_open, station.mode)

    def begin(self, stock: Iterable[tuple[Bin, int]]) -> None:
        """Lays the first stock, pairs (bin, pieces), into the bins."""
        for bin_, pieces in stock:
            if pieces:
                self.inventory.move(bin_, bin_.sku, pieces, Reason.INITIAL)

    def resume(self, stored: Stored, changed: Changes) -> None:
        """Goes on with the orders of a Stored warehouse, whose bins this shift has.

        Writes off what has Changed since, with a notice.
        """
        if text := str(changed):
            self.notices.add(text)
        for bin_ in changed.gone:
            self.fallen.forget(bin_)
            self.inventory.write_off(bin_)
        self.inventory.house(self.assortment.skus)
        self.order_book.resume(stored.orders, stored.last_order)

    @property
    def transports(self) -> Requests:
        """The fleet, as a shift sees it."""
        return self._transports

    # Time.

    @property
    def now(self) -> float:
        """The simulated time [s]."""
        return self._clock.now

    @property
    def began(self) -> float:
        """The simulated time at which the shift began [s]."""
        return self._clock.began

    def next_time(self) -> float:
        """Returns when the next event of the shift itself is due [s]."""
        return min(self._clock.next_time, self.demand.next_time() if self.demand else np.inf)

    def advance(self, time: float) -> None:
        """Handles the events up to a time [s], and decides what follows."""
        self._clock.now = time
        for event in self._transports.take_events():
            self.visits.on_event(event)
        self._clock.run_until(time)
        self._submit_due_orders()
        self.picking.work()
        self._submit_due_orders()
        self.replenishing.work()
        self.commit()

    def _submit_due_orders(self) -> None:
        if not self.demand:
            return
        for draft in self.demand.due(self.now, self.backlog, self.order_book.unpromised):
            order, why = self.submit(draft.lines, draft.due, draft.priority, draft.reference)
            if not order:
                self.notices.add(f"order {draft.reference} is refused: {why}")

    def _refill(self, _: None) -> None:
        self.replenishing.refill()
        self._clock.schedule(self.now + PERIOD, self._refill)

    def _schedule_bundle(self) -> None:
        per_hour = self.demand.bundles_per_hour if self.demand else 0
        if per_hour and self.replenishing.stations:
            wait = self._rng.exponential(3600 / per_hour)
            self._clock.schedule(self.now + wait, self._order_bundle)

    def _order_bundle(self, _: None) -> None:
        sku = self.view.sku_to_refill()
        if sku:
            self.replenishing.order(sku, self._bundle_of(sku))
        self._schedule_bundle()

    def _bundle_of(self, sku: str) -> int:
        return self.view.usual_bundle(sku) or int(self._rng.integers(4, 13))

    # Orders.

    @property
    def orders(self) -> dict[int, Order]:
        """The orders that are not over, by id."""
        return self.order_book.orders

    @property
    def backlog(self) -> Any:
        """The Backlog: the orders that no station has."""
        return self.order_book.backlog

    @property
    def on_order_event(self) -> Callable[..., object] | None:
        """Called for each event with (order, kind, sku, quantity, station, unit, text)."""
        return self.order_book.on_event

    @on_order_event.setter
    def on_order_event(self, call: Callable[..., object] | None) -> None:
        self.order_book.on_event = call

    def submit(
        self, lines: Lines, due: float = 0.0, priority: int = 0, reference: str = ""
    ) -> tuple[Order | None, str]:
        """Takes a new order; see OrderBook.submit."""
        return self.order_book.submit(lines, due, priority, reference)

    def cancel_order(self, order_id: int) -> tuple[bool, str]:
        """Cancels an order. Returns success and the reason of a refusal."""
        return self.order_book.cancel(order_id)

    def change_order(
        self, order_id: int, priority: int | None, due: float | None
    ) -> tuple[bool, str]:
        """Makes an order more or less urgent; see OrderBook.change."""
        return self.order_book.change(order_id, priority, due)

    def likely_completion(self, order_id: int) -> tuple[float, list[int]]:
        """Returns the expected time of completion of an order [s], 0: over or unknown; and the
        units at its station, or on their way there, with pieces of it."""
        order = self.order_book.orders.get(order_id)
        if not order:
            return 0.0, []
        places = {station.name: station for station in self.stations}
        place = places.get(order.station) if order.state == OrderState.ASSIGNED else None
        visits = place.coming if place else []
        units = [
            visit.unit for visit in visits if any(pick.line.order is order for pick in visit.picks)
        ]
        # Of those that took longer than it has waited: others say nothing about it.
        age = self.now - order.created
        longer = sorted(t for t in self.tally.turnover_s[-RECENT:] if t > age)
        usual = order.created + longer[len(longer) // 2] if len(longer) >= FEW else 0.0
        pace = place.seconds_a_piece if place else 0.0
        work = sum(visit.pieces_to_pick for visit in visits) * pace
        if not usual and not work:
            return 0.0, units
        return max(usual, self.now + work), units

    # Stations.

    def station(self, name: str) -> WorkStation:
        """Returns the WorkStation of that name. Raises KeyError."""
        return self._stations[name]

    @property
    def stations(self) -> Collection[WorkStation]:
        """All WorkStations."""
        return self._stations.values()

    def set_station(self, name: str, is_open: bool, mode: int) -> tuple[bool, str]:
        """Opens or closes a station and sets its StationMode. Returns success and the fault."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        station.set_open(bool(is_open), self.now)
        station.mode, station.attended = StationMode(mode), self.now
        self._transports.set_open(name, station.is_open)
        parts: list[Picking | Replenishing] = [self.picking] if station.picks else []
        parts += [self.replenishing] if station.replenishes else []
        for part in parts:
            if is_open:
                part.open(station)
            else:
                part.close(station)
        return True, ""

    def open_picking(self, count: int) -> None:
        """Opens the first `count` picking stations and closes the others; call it before robots
        begin."""
        for i, station in enumerate(self.picking.stations):
            self.set_station(station.name, i < count, station.mode)
        working = sum(station.is_open for station in self.stations)
        self.visits.most = self.settings.units_at(len(self.floor.robots), working)

    def confirm_pick(self, name: str, sku: str, quantity: int) -> tuple[bool, str]:
        """Takes pieces as picked, or put in, by a person. Returns success and the fault."""
        return self.manual.confirm(name, sku, quantity)

    def report_short(
        self, name: str, sku: str, lacking: int, damaged: bool = False
    ) -> tuple[bool, str]:
        """Writes off pieces that are missing or damaged. Returns success and the fault."""
        return self.manual.short(name, sku, lacking, damaged)

    # Units.

    @property
    def free_units(self) -> UnitSet:
        """The ids of units that stand in storage and may be asked for."""
        return self.visits.free_units

    def take_out(self, sku: str) -> None:
        """Writes off the pieces of a SKU that are promised to no order; no more come."""
        self.replenishing.sold_out.add(sku)
        for bin_ in list(self.inventory.with_sku(sku)):
            if bin_.available:
                self.inventory.move(bin_, sku, -bin_.available, Reason.SHORT)
        self.notices.add(f"{sku} is sold out")

    def update_units(self, units: set[int]) -> None:
        """Takes in the ids of all units of the warehouse; missing ones are not asked for."""
        self.visits.update_units(units)

    # Records.

    @property
    def journal(self) -> Journal:
        """Receives every change; another one takes over where it is set."""
        return self.context.journal

    @journal.setter
    def journal(self, journal: Journal) -> None:
        self.context.journal = journal

    def commit(self) -> None:
        """Marks everything recorded since the last call as one consistent state."""
        self.context.commit()

    def end(self, figures: dict[str, Any]) -> None:
        """Records the end of the run, with its figures."""
        self.journal.end(self.now, self.inventory.take_changed(), figures)

    def figures(self, fleet: Any, kinematics: Kinematics, wall_s: float) -> dict[str, Any]:
        """Returns the content of kpis.json up to now; see kpis.of_shift for the arguments."""
        orders, spacing = self.orders.values(), self.floor.plan.spacing
        about = {"fleet": fleet, "kinematics": kinematics, "wall_s": wall_s}
        figures = kpis.of_shift(self.context, self.stations, orders, spacing, **about)
        return figures | self.fallen.figures()

    def state_hash(self) -> str:
        """Returns a hash of all events: runs with equal hashes were equal to the last event."""
        return self.context.state_hash()
