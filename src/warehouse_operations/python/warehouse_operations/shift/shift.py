# SPDX-License-Identifier: Apache-2.0
"""A shift: orders go to stations, units to the orders, pieces into totes, and stock is refilled.

It is driven by events and by simulated time, and sees the fleet through protocols.Requests alone:

    shift.advance(time)           # takes in what happened up to then
    shift.next_time()             # when it must be called next, if nothing happens before
"""

import hashlib
from collections.abc import Callable, Collection, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_operations.policies.view import PolicyHooks, View
from warehouse_operations.shift.fallen import Fallen
from warehouse_operations.shift.journal import Journal
from warehouse_operations.shift.kpis import Tally
from warehouse_operations.shift.manual_stations import ManualPicking, ManualReplenishing
from warehouse_operations.shift.notices import Notices
from warehouse_operations.shift.order_book import Lines, OrderBook
from warehouse_operations.shift.picking import Picking
from warehouse_operations.shift.replenishing import PERIOD, Replenishing
from warehouse_operations.shift.tasks import Tasks
from warehouse_operations.shift.visits import Visits
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.event_queue import EventQueue
from warehouse_operations.stock.inventory import Bin, Inventory, Reason
from warehouse_operations.stock.message_enums import Mode
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.protocols import Requests
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.stations import Visit, WorkStation
from warehouse_operations.stock.units_by_id import UnitSet
from warehouse_operations.stock.whereabouts import Whereabouts

if TYPE_CHECKING:
    from warehouse_operations.policies import Policies
    from warehouse_operations.store.returning import Changes
    from warehouse_operations.store.stored import Stored

__all__ = ["Settings", "Shift"]


class Shift:
    """The work of a warehouse from a moment on.

    now, began: simulated times [s]. order_book, visits, picking, replenishing, fallen, tasks: its
    parts. view: its state for policies. hooks: the policies' answers for the fleet. notices: what
    a person must know. tally: counts for the KPIs.
    """

    def __init__(
        self,
        transports: Requests,
        assortment: Assortment,
        bins: Collection[Bin],
        *,
        floor: Whereabouts,
        policies: "Policies",
        demand: Any = None,
        settings: Settings | None = None,
        journal: Journal | None = None,
        rng: np.random.Generator | None = None,
        now: float = 0.0,
    ) -> None:
        self.transports, self.policies, self.floor = transports, policies, floor
        self.settings = settings or Settings()
        self.assortment, self.demand = assortment, demand
        self.rng = rng or np.random.default_rng(1)
        self.journal, self.tally = journal or Journal(), Tally()
        self.now = self.began = now
        self.events, self.notices = EventQueue(), Notices()
        self._hash = hashlib.blake2b(digest_size=8)
        self.inventory = Inventory(bins, self._on_move)
        self.order_book, self.visits = OrderBook(self), Visits(self)
        self.units_per_station = self.settings.units_at(len(floor.robots), len(floor.plan.stations))
        self._stations = {place.name: self._work_station(place) for place in floor.plan.stations}
        self.picking = Picking(self, [one for one in self.stations if one.picks])
        self.replenishing = Replenishing(self, [one for one in self.stations if one.replenishes])
        self._manual_picking = ManualPicking(self.picking)
        self._manual_replenishing = ManualReplenishing(self.replenishing)
        self.fallen, self.tasks = Fallen(self), Tasks(self)
        self.view, self.hooks = View(self), PolicyHooks(self)
        self.events.schedule(now, self._refill)
        self._schedule_bundle()

    def _work_station(self, place: Any) -> WorkStation:
        settings = self.settings.of(place.name)
        station = WorkStation(place, settings, self.inventory, self.began)
        edges = [(0.0, False)] if settings.hours else []
        edges += [edge for begin, end in settings.hours for edge in ((begin, True), (end, False))]
        for hour, is_open in edges:
            self.events.schedule(self.began + 3600 * hour, self._keep_hours, (station, is_open))
        for hour, pickers in settings.shifts():
            self.events.schedule(self.began + 3600 * hour, self._set_pickers, (station, pickers))
        if station.piece_sd:
            station.set_chance(np.random.default_rng(self.rng.integers(2**63)))
        return station

    def _set_pickers(self, argument: tuple[WorkStation, int]) -> None:
        """Begins a break of a station's pickers, or has them or others go on."""
        station, pickers = argument
        station.set_pickers(pickers, self.now)
        self.next_work(station)

    def _keep_hours(self, argument: tuple[WorkStation, bool]) -> None:
        """Opens or closes a station as its hours say."""
        station, is_open = argument
        self.set_station(station.name, is_open, station.mode)

    def begin(self, stock: Iterable[tuple[Bin, int]]) -> None:
        """Lays the first stock, pairs (bin, pieces), into the bins."""
        for one, pieces in stock:
            if pieces:
                self.inventory.move(one, one.sku, pieces, Reason.INITIAL)

    def resume(self, stored: "Stored", changed: "Changes") -> None:
        """Goes on with the orders of a Stored warehouse, whose bins this shift was given.

        Writes off what has Changed since, with a notice.
        """
        if text := str(changed):
            self.notices.add(text)
        for one in changed.gone:
            self.fallen.forget(one)
            self.inventory.write_off(one)
        self.inventory.house(self.assortment.skus)
        self.inventory.blocked |= stored.blocked
        self.visits.free_units -= stored.blocked
        self.order_book.resume(stored.orders, stored.last_order)

    # Time.

    def next_time(self) -> float:
        """Returns when the next event of the shift itself is due [s]."""
        return min(self.events.next_time, self.demand.next_time() if self.demand else np.inf)

    def advance(self, time: float) -> None:
        """Takes in what happened up to a time [s] and decides what follows from it."""
        self.now = time
        for event in self.transports.take_events():
            self.visits.on_event(event)
        self.events.run_until(time)
        self._submit_due_orders()
        self.picking.work()
        self._submit_due_orders()
        self.replenishing.work()
        self.journal.commit(self)

    def _submit_due_orders(self) -> None:
        if not self.demand:
            return
        for wanted in self.demand.due(self.now, self.backlog, self.order_book.unpromised):
            order, why = self.submit(wanted.lines, wanted.due, wanted.priority, wanted.reference)
            if not order:
                self.notices.add(f"order {wanted.reference} is refused: {why}")

    def _refill(self, _: None) -> None:
        self.replenishing.refill()
        self.events.schedule(self.now + PERIOD, self._refill)

    def _schedule_bundle(self) -> None:
        per_hour = self.demand.bundles_per_hour if self.demand else 0
        if per_hour and self.replenishing.stations:
            wait = self.rng.exponential(3600 / per_hour)
            self.events.schedule(self.now + wait, self._order_bundle)

    def _order_bundle(self, _: None) -> None:
        sku = self.view.sku_to_refill()
        if sku:
            self.replenishing.order(sku, int(self.rng.integers(4, 13)))
        self._schedule_bundle()

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

    # Stations.

    def station(self, name: str) -> WorkStation:
        """Returns the WorkStation of that name. Raises KeyError."""
        return self._stations[name]

    def find_station(self, name: str) -> WorkStation | None:
        """Returns the WorkStation of that name, or None."""
        return self._stations.get(name)

    @property
    def stations(self) -> Collection[WorkStation]:
        """All WorkStations."""
        return self._stations.values()

    def part_of(self, visit: Visit) -> Picking | Replenishing:
        """Returns the part of the shift that asked for a visit."""
        return self.replenishing if visit.replenishes else self.picking

    def manual_part_of(self, station: WorkStation) -> ManualPicking | ManualReplenishing:
        """Returns the part of the shift that takes reports of people at a station now."""
        here = station.here
        replenishes = here.replenishes if here else not station.picks
        return self._manual_replenishing if replenishes else self._manual_picking

    def next_work(self, station: WorkStation) -> None:
        """Starts what people at a station can do next."""
        if station.picks:
            self.picking.next_piece(station)
        if station.replenishes:
            self.replenishing.next_bundle(station)

    def set_station(self, name: str, is_open: bool, mode: int) -> tuple[bool, str]:
        """Opens or closes a station and sets its Mode. Returns success and the fault."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        station.set_open(bool(is_open), self.now)
        station.mode, station.attended = Mode(mode), self.now
        self.transports.set_open(name, station.is_open)
        parts: list[Picking | Replenishing] = [self.picking] if station.picks else []
        parts += [self.replenishing] if station.replenishes else []
        for part in parts:
            if is_open:
                part.open(station)
            else:
                part.close(station)
        return True, ""

    def open_picking(self, count: int) -> None:
        """Opens the first so many picking stations and closes the others, before robots begin."""
        for i, station in enumerate(self.picking.stations):
            self.set_station(station.name, i < count, station.mode)
        working = sum(station.is_open for station in self.stations)
        self.units_per_station = self.settings.units_at(len(self.floor.robots), working)

    def confirm_pick(self, name: str, sku: str, quantity: int) -> tuple[bool, str]:
        """Takes pieces as picked, or put in, by a person. Returns success and the fault."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        if station.mode != Mode.MANUAL:
            return False, f"{name} works by itself"
        station.attended = self.now
        return self.manual_part_of(station).confirm(station, sku, quantity)

    def report_short(
        self, name: str, sku: str, lacking: int, damaged: bool = False
    ) -> tuple[bool, str]:
        """Writes off pieces that are missing or damaged. Returns success and the fault."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        reason = Reason.DAMAGED if damaged else Reason.SHORT
        station.attended = self.now
        return self.manual_part_of(station).short(station, sku, lacking, reason)

    # Units.

    @property
    def free_units(self) -> UnitSet:
        """The ids of units that stand in storage and may be asked for."""
        return self.visits.free_units

    def set_unit(self, unit: int, in_service: bool) -> tuple[bool, str]:
        """Takes a unit out of service, or back. Returns success and the fault."""
        if unit not in self.inventory.of_unit:
            return False, f"there is no storage unit {unit}"
        self.journal.unit(unit, in_service)
        if in_service:
            self.inventory.blocked.discard(unit)
            self.visits.free(unit)
        else:
            self.inventory.blocked.add(unit)
            self.visits.withdraw(unit)
        return True, ""

    def take_out(self, sku: str) -> None:
        """Writes off the pieces of a SKU that are promised to no order; no more come."""
        self.replenishing.sold_out.add(sku)
        for place in list(self.inventory.with_sku(sku)):
            if place.available:
                self.inventory.move(place, sku, -place.available, Reason.SHORT)
        self.notices.add(f"{sku} is sold out")

    def update_units(self, units: set[int]) -> None:
        """Takes in the ids of all units of the warehouse; missing ones are not asked for."""
        self.visits.update_units(units)

    # Records.

    def state_hash(self) -> str:
        """Returns a hash of all events: runs with equal hashes were equal to the last event."""
        return self._hash.hexdigest()

    def update_hash(self, *values: object) -> None:
        """Adds an event to the state hash, with the time."""
        self._hash.update(repr((round(self.now, 6), *values)).encode())

    def _on_move(self, one: Bin, quantity: int, reason: Reason, context: dict[str, Any]) -> None:
        station = context.get("station")
        self.update_hash("move", one.bin_id, one.sku, quantity, reason.value)
        name, visit = station.name if station else "", context.get("visit")
        self.journal.move(self.now, one, quantity, reason, context.get("line"), name, visit)
