# SPDX-License-Identifier: Apache-2.0
"""A shift: orders go to stations, units to the orders, pieces into totes, and stock is refilled.

It is driven by events and by simulated time, and sees the fleet through transport.Transports alone:

    shift.advance(time)           # whatever happened up to then
    shift.next_time()             # when it wants to be called again, if nothing happens before
"""

import hashlib
import heapq
import itertools
from collections import defaultdict
from dataclasses import dataclass, field, replace

import numpy as np

from warehouse_fleet.transports import ENDS, Kind
from warehouse_operations import acceptance
from warehouse_operations.assortment import CAPACITY, Assortment
from warehouse_operations.fallen import Fallen
from warehouse_operations.inventory import Inventory, Reason
from warehouse_operations.journal import Journal
from warehouse_operations.kpis import Tally
from warehouse_operations.notices import Notices
from warehouse_operations.orders import Backlog, Order, OrderEventKind, OrderState
from warehouse_operations.picking import Picking
from warehouse_operations.replenishing import PERIOD, Replenishing
from warehouse_operations.stations import Mode, Visit, WorkStation
from warehouse_operations.tasks import Tasks

UNITS_LEAST, UNITS_MOST = 2, 8  # at a station or on their way to it
HOLD = 10.0  # for so long a unit is not asked for whose transport failed or was refused [s]
TOO_MANY = f"orders of {acceptance.MOST_WAITING} lines wait already; come back when there are fewer"
RANKS_KEPT = 300.0  # for so long the ranking of the units by turnover is used [s]


@dataclass(frozen=True)
class Settings:
    """Of the stations and of what a shift asks of the fleet; the defaults are RAWSim-O's."""

    slots: int = 12  # open orders a picking station
    piece_s: float = 10.0  # from a piece to the next
    pick_s: float = 3.0  # of that, until the piece is out of its bin and the unit may leave
    bundle_s: float = 10.0
    units_per_station: int = None  # at it or on their way; None: by the number of robots
    by_station: dict = field(default_factory=dict)  # what is otherwise at one, by its name

    def of(self, station):
        """Those of a station."""
        return replace(self, **self.by_station.get(station, {}))

    def units_at(self, robots, stations):
        """Units at a station or on their way to it, at most: robots are shared out to stations, and
        a few units more are asked for than are fetched at once."""
        share = round(1.5 * robots / max(stations, 1))
        return self.units_per_station or min(max(share, UNITS_LEAST), UNITS_MOST)


class Shift:
    """What policies see as `view`; the methods between the lines of dashes are for them.

    now [s]; rng, a numpy Generator; policies; settings; inventory; backlog; free_units, the ids of
    units that stand in storage and may be asked for.
    """

    def __init__(
        self,
        transports,
        assortment,
        bins,
        *,
        floor,
        policies,
        demand=None,
        settings=None,
        journal=None,
        rng=None,
        now=0.0,
    ):
        self.transports, self.policies, self.floor = transports, policies, floor
        self.settings = settings or Settings()
        self.assortment: Assortment = assortment
        self.demand, self.rng = demand, rng or np.random.default_rng(1)
        self.journal, self.tally = journal or Journal(), Tally()
        self.now = self.began = now
        self.backlog, self.orders = Backlog(), {}
        self.inventory = Inventory(bins, self._moved)
        self.free_units = set(floor.units)
        self.units_per_station = self.settings.units_at(len(floor.robots), len(floor.plan.stations))
        self._absent = set()  # units that are not in the warehouse any more
        self._visits = {}
        self._timers, self._order = [], itertools.count()
        self._visit_ids, self._order_ids = itertools.count(1), itertools.count(1)
        self._hash = hashlib.blake2b(digest_size=8)
        self._ranks, self._ranked_at = {}, -np.inf
        self._popularity_rank = _ranks_of(assortment)
        self._stations = {place.name: self._work_station(place) for place in floor.plan.stations}
        of_kind = defaultdict(list)
        for station in self._stations.values():
            of_kind[station.kind].append(station)
        self.picking = Picking(self, of_kind["PICK"])
        self.replenishing = Replenishing(self, of_kind["REPLENISH"])
        self.fallen = Fallen(self)
        self.tasks = Tasks(self)
        self.notices = Notices()
        self.on_order_event = None  # called with (order, kind, sku, quantity, station, unit, text)
        self.hooks = _Hooks(self)
        self.at(now, self._look_after_stock, None)
        self._bundles_come()

    def _work_station(self, place):
        settings = self.settings.of(place.name)
        if place.kind == "PICK":
            times = settings.slots, settings.piece_s, min(settings.pick_s, settings.piece_s)
        else:
            times = 0, settings.bundle_s, settings.bundle_s
        return WorkStation(place, *times, self.inventory)

    def begin(self, stock):
        """Lays the stock of the shift's beginning into the bins: pairs (bin, pieces)."""
        for one, pieces in stock:
            if pieces:
                self.inventory.move(one, one.sku, pieces, Reason.INITIAL)

    def resume(self, stored, changed):
        """Goes on with the orders of a Stored warehouse, whose bins this shift was given; what has
        Changed since is written off and told."""
        if told := str(changed):
            self.notices.add(told)
        for one in changed.gone:
            self.fallen.forget(one)
            self.inventory.write_off(one)
        self.inventory.house(self.assortment.skus)
        self._order_ids = itertools.count(stored.last_order + 1)
        self.inventory.blocked |= stored.blocked
        self.free_units -= stored.blocked
        for order in stored.orders:
            self.orders[order.order_id] = order
            fault = self._fault_of([(line.sku, line.quantity) for line in order.lines])
            if order.done:
                order.completed = self.now
                order.state = OrderState.COMPLETED
                self.order_over(order, OrderEventKind.COMPLETED)
            elif fault:
                self._cancel(order, fault)
                self.notices.add(
                    f"order {order.order_id} ({order.reference}) is cancelled: {fault}"
                )
            else:
                self.backlog.add(order)

    # Time.

    def at(self, time, act, argument):
        """Calls act(argument) at a time [s]."""
        heapq.heappush(self._timers, (time, next(self._order), act, argument))

    def next_time(self):
        """When something happens here, if nothing does in the fleet [s]."""
        timer = self._timers[0][0] if self._timers else np.inf
        return min(timer, self.demand.next_time() if self.demand else np.inf)

    def advance(self, time):
        """Takes in what happened up to a time [s] and decides what follows from it."""
        self.now = time
        for event in self.transports.take_events():
            self._transport_event(event)
        while self._timers and self._timers[0][0] <= time:
            _, _, act, argument = heapq.heappop(self._timers)
            act(argument)
        self._orders_come()
        self.picking.work()
        self._orders_come()
        self.replenishing.work()
        self.journal.commit(self)

    def _orders_come(self):
        if self.demand:
            for wanted in self.demand.due(self.now, self.backlog, self._unpromised):
                order, why = self.submit(
                    wanted.lines, wanted.due, wanted.priority, wanted.reference
                )
                if not order:
                    self.notices.add(f"order {wanted.reference} is refused: {why}")

    def _unpromised(self, sku):
        return self.inventory.available(sku) - self.backlog.demand.get(sku, 0)

    def _look_after_stock(self, _):
        self.replenishing.refill()
        self.at(self.now + PERIOD, self._look_after_stock, None)

    def _bundles_come(self):
        per_hour = self.demand.bundles_per_hour if self.demand else 0
        if per_hour and self.replenishing.stations:
            self.at(self.now + self.rng.exponential(3600 / per_hour), self._bundle_comes, None)

    def _bundle_comes(self, _):
        sku = self.sku_to_refill()
        if sku:
            self.replenishing.order(sku, int(self.rng.integers(4, 13)))
        self._bundles_come()

    # Orders.

    def submit(self, lines, due=0.0, priority=0, reference=""):
        """A new order of (sku, pieces); returns it, or None and why not, as (order, message)."""
        reason = self._fault_of(lines) or acceptance.fault_of_head(reference, due, priority)
        if reason:
            return None, reason
        if self.backlog.lines + len(lines) > acceptance.MOST_WAITING:
            return None, TOO_MANY
        merged = defaultdict(int)
        for sku, pieces in lines:
            merged[sku] += pieces
        order = Order(next(self._order_ids), merged.items(), self.now, due, priority, reference)
        self.orders[order.order_id] = order
        self.journal.order(order)
        self.tell_order(order, OrderEventKind.RECEIVED)
        lacking = [s for s, n in merged.items() if n > self._unpromised(s)]
        for sku in lacking:
            self.tell_order(
                order, OrderEventKind.SHORT, sku, merged[sku], text="waits for new stock"
            )
        self.backlog.add(order)
        self.picking.backlog_changed()
        text = f"waits for new stock of {', '.join(lacking)}" if lacking else ""
        return order, text

    def _fault_of(self, lines):
        return acceptance.fault_of_lines(lines, self._popularity_rank, self.inventory.capacity)

    def cancel_order(self, order_id):
        """Returns success and why not."""
        order = self.orders.get(order_id)
        if not order:
            return False, f"order {order_id} is unknown, or over"
        if order.done:
            return False, f"order {order_id} has all its pieces"
        if order.state == OrderState.ASSIGNED:
            self.picking.cancel(order)
        else:
            self.backlog.remove(order)
        return True, self._cancel(order)

    def _cancel(self, order, reason=""):
        """Of an order that neither the backlog nor a station has; returns what is to be said."""
        order.state = OrderState.CANCELLED
        picked = sum(line.picked for line in order.lines)
        text = "; ".join(
            filter(None, (reason, f"{picked} pieces were picked already" if picked else ""))
        )
        self.order_over(order, OrderEventKind.CANCELLED, text=text)
        return text

    def reopen(self, order):
        """An order whose station can't finish it waits again."""
        order.state = OrderState.OPEN
        self.backlog.add(order)
        self.journal.order(order)
        self.picking.backlog_changed()

    def order_over(self, order, kind, station="", text=""):
        """It is complete or cancelled: told, counted, and no longer kept."""
        if kind == OrderEventKind.COMPLETED:
            self.tally.completed(order)
        self.journal.order(order)
        self.tell_order(order, kind, station=station, text=text)
        del self.orders[order.order_id]

    def tell_order(self, order, kind, sku="", quantity=0, station="", unit=0, text=""):
        """An event of an order: written down, hashed, and handed to whoever listens."""
        station = station or order.station
        self._digest("order", order.order_id, int(kind), sku, quantity, station, unit)
        self.journal.event(self.now, kind, order.order_id, sku, quantity, station, unit, text)
        if self.on_order_event:
            self.on_order_event(order, kind, sku, quantity, station, unit, text)

    # Stations.

    def station(self, name):
        """The WorkStation of that name; KeyError."""
        return self._stations[name]

    def find_station(self, name):
        """The WorkStation of that name, or None."""
        return self._stations.get(name)

    @property
    def stations(self):
        """All of them."""
        return self._stations.values()

    def set_station(self, name, is_open, mode):
        """Opens or closes a station, by itself or by hand; returns success and why not."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        station.is_open, station.mode, station.attended = bool(is_open), Mode(mode), self.now
        part = self.part_of(station)
        self.transports.set_open(name, station.is_open)
        if not is_open:
            part.close(station)
        elif part is self.picking:
            self.picking.backlog_changed()
            self.picking.next_piece(station)
        else:
            self.replenishing.unit_free()
            self.replenishing.next_bundle(station)
        return True, ""

    def confirm_pick(self, name, sku, quantity):
        """A person at a station has picked, or put in; returns success and why not."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        if station.mode != Mode.MANUAL:
            return False, f"{name} works by itself"
        station.attended = self.now
        return self.part_of(station).confirm(station, sku, quantity)

    def report_short(self, name, sku, lacking, damaged=False):
        """Pieces are not there, or damaged; returns success and why not."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        reason = Reason.DAMAGED if damaged else Reason.SHORT
        station.attended = self.now
        return self.part_of(station).short(station, sku, lacking, reason)

    def set_unit(self, unit, in_service):
        """Takes a unit out of service, or back; returns success and why not."""
        if unit not in self.inventory.of_unit:
            return False, f"there is no storage unit {unit}"
        self.journal.unit(unit, in_service)
        if in_service:
            self.inventory.blocked.discard(unit)
            self._unit_free(unit)
            return True, ""
        self.inventory.blocked.add(unit)
        self._withdraw(unit)
        return True, ""

    def see_units(self, units):
        """Which storage units there are: of others, nothing is asked until they are back."""
        gone = self.inventory.of_unit.keys() - units
        for unit in sorted(gone - self._absent):
            self._withdraw(unit)
            self.notices.add(f"storage unit {unit} is gone: its stock is not asked for")
        back, self._absent = self._absent - gone, gone
        for unit in sorted(back):
            self.notices.drop(f"storage unit {unit} is gone: its stock is not asked for")
            self._unit_free(unit)

    def _withdraw(self, unit):
        self.free_units.discard(unit)
        for visit in [v for v in self._visits.values() if v.unit == unit]:
            self.part_of(visit.station).drop_visit(visit)
            if visit.here:
                self.release(visit)
            elif visit.released is None:
                self.cancel_visit(visit)

    def part_of(self, station):
        """The part of the shift that works there."""
        return self.picking if station.kind == "PICK" else self.replenishing

    # Units.

    def request(self, unit, station):
        """Asks for a unit; the Visit, or None where the fleet refuses: it is left alone a while."""
        answer = self.transports.submit(unit, station.name)
        self.free_units.discard(unit)
        if not answer.accepted:
            self.at(self.now + HOLD, self._unit_free, unit)
            return None
        visit = Visit(next(self._visit_ids), answer.transport_id, unit, station, self.now)
        self._visits[answer.transport_id] = visit
        station.inbound[visit.visit_id] = visit
        self.journal.visit(visit)
        return visit

    def release(self, visit):
        """The station is done with a unit."""
        visit.released = self.now
        self.transports.release(visit.transport_id)
        self.journal.visit(visit)

    def cancel_visit(self, visit):
        """A unit on its way is not needed."""
        visit.released = self.now
        self.transports.cancel(visit.transport_id)

    def _transport_event(self, event):
        visit = self._visits.get(event.transport_id)
        if not visit:
            return
        self._digest(
            "transport", event.transport_id, int(event.kind), event.kiva_id, event.shelf_id
        )
        if event.kind == Kind.CANCELLED:
            visit.outcome = "cancelled"
            if visit.lifted is None:
                self._visit_over(visit, event)
        elif event.kind == Kind.LIFTED:
            visit.lifted = event.stamp
            self.floor.cells.pop(visit.unit, None)
            self.journal.visit(visit)
        elif event.kind == Kind.ARRIVED:
            visit.arrived = event.stamp
            self.journal.visit(visit)
            if visit.released is None:
                self.part_of(visit.station).arrived(visit)
            else:  # cancelled too late
                self.transports.release(visit.transport_id)
        elif event.kind in ENDS:
            self._visit_over(visit, event)

    def _visit_over(self, visit, event):
        del self._visits[visit.transport_id]
        self.part_of(visit.station).drop_visit(visit)
        visit.ended, visit.outcome = event.stamp, visit.outcome or event.kind.name.lower()
        visit.released = event.stamp if visit.released is None else visit.released
        del visit.station.inbound[visit.visit_id]
        self.journal.visit(visit)
        self.tally.visited(visit)
        visit.station.visits += visit.arrived is not None
        if event.kind == Kind.FAILED:
            self.at(self.now + HOLD, self._unit_free, visit.unit)
        else:
            self._unit_free(visit.unit)

    def _unit_free(self, unit):
        away = any(visit.unit == unit for visit in self._visits.values())
        if unit not in self.inventory.blocked | self._absent and not away:
            self.free_units.add(unit)
            self.picking.unit_free(unit)
            self.replenishing.unit_free()

    # ---------------------------------------------------------------- for the policies

    @property
    def bundles(self):
        """The Bundles at the door, without a place yet, by id."""
        return self.replenishing.bundles

    @property
    def pieces_ordered(self):
        """Pieces that were ordered and are not in a bin yet."""
        return self.replenishing.ordered + self.inventory.expected

    def in_stock(self, order):
        """Whether every piece that an order lacks lies somewhere, promised to nobody.

        A line of more than a bin may hold is begun with a bin's worth: room must be made for more.
        """
        available = self.inventory.available
        return all(available(ln.sku) >= min(ln.missing, CAPACITY) for ln in order.lines)

    def stock_of(self, sku):
        """Pieces of a SKU that are there and promised to nobody, or expected."""
        return self.inventory.available(sku) + self.inventory.incoming(sku)

    def seconds_to(self, station, unit):
        """How long a unit takes from its place to a station, if nobody is in the way [s]."""
        return self.floor.seconds_to(station, unit)

    def cell(self, unit):
        """Where a unit stands; None while it is carried."""
        return self.floor.cells.get(unit)

    def first_cell(self, unit):
        """Where a unit stood as the shift began."""
        return self.floor.units[unit]

    def first_cell_of_robot(self, kiva_id):
        return self.floor.robots.get(kiva_id)

    def cells_apart(self, cell, cells):
        """Metres along the axes between a cell and others."""
        return self.floor.apart(cell, cells)

    def place_rank(self, cells):
        """0 for the storage places nearest to the picking stations, 1 for the farthest."""
        return self.floor.place_rank(cells)

    def stored_units_near(self, cell, count):
        """The nearest units that stand in storage and may be asked for."""
        units = sorted(self.free_units & self.floor.cells.keys())
        apart = self.floor.apart(cell, np.array([self.floor.cells[unit] for unit in units], int))
        return [units[i] for i in np.argsort(apart, kind="stable")[:count]]

    def work(self, unit):
        """Pieces on a unit, promised to nobody, that orders which wait ask for."""
        demand = self.backlog.demand
        return sum(min(b.available, demand.get(b.sku, 0)) for b in self.inventory.of_unit[unit])

    def room(self, unit):
        """Pieces that can be put into a unit's bins."""
        return sum(one.room for one in self.inventory.of_unit[unit])

    def popularity_rank(self, sku):
        """0 for the SKU that is asked for most, near 1 for the least."""
        return self._popularity_rank[sku]

    def turnover_rank(self, unit):
        """0 for the unit whose pieces are asked for most, near 1 for the least."""
        if self.now - self._ranked_at >= RANKS_KEPT:
            share = dict(zip(self.assortment.skus, self.assortment.popularity))
            units = self.inventory.of_unit
            turnover = {u: sum(share.get(b.sku, 0) for b in units[u] if b.quantity) for u in units}
            order = sorted(turnover, key=lambda u: (-turnover[u], u))
            self._ranks = {u: i / len(order) for i, u in enumerate(order)}
            self._ranked_at = self.now
        return self._ranks.get(unit, 1.0)

    def sku_to_refill(self):
        """A SKU drawn by how many of its bins have room for a bundle; None if there is none."""
        ordered = self.replenishing.ordered_of
        weights = np.array(
            [max(self.inventory.roomy[s] - ordered.get(s, 0) / 8, 0) for s in self.assortment.skus]
        )
        sums = np.cumsum(weights)
        if not sums[-1] > 0:
            return None
        at = np.searchsorted(sums, self.rng.random() * sums[-1], side="right")
        return self.assortment.skus[min(at, len(sums) - 1)]

    def shortages(self):
        """Pieces that orders want beyond what is there or ordered, by SKU."""
        wanted = defaultdict(int, self.picking.missing())
        for sku, pieces in self.backlog.demand.items():
            wanted[sku] += pieces
        ordered = self.replenishing.ordered_of
        lacking = {s: n - self.stock_of(s) - ordered.get(s, 0) for s, n in wanted.items()}
        return {sku: pieces for sku, pieces in lacking.items() if pieces > 0}

    # ---------------------------------------------------------------- what is written down

    def state_hash(self):
        """Of everything that happened: runs with the same one were the same to the last event."""
        return self._hash.hexdigest()

    def _moved(self, one, quantity, reason, context):
        station = context.get("station")
        self._digest("move", one.bin_id, one.sku, quantity, reason.value)
        self.journal.move(
            self.now,
            one,
            quantity,
            reason,
            context.get("line"),
            station.name if station else "",
            context.get("visit"),
        )

    def _digest(self, *values):
        self._hash.update(repr((round(self.now, 6), *values)).encode())


class _Hooks:
    """What the fleet asks, answered by the policies."""

    def __init__(self, shift):
        self._shift = shift

    def choose_place(self, shelf_id, cells, distances):
        shift = self._shift
        cell = int(shift.policies.storage.choose(shelf_id, cells, distances, shift))
        shift.floor.cells[shelf_id] = cell
        return cell

    def match_robots(self, tasks, robots, seconds):
        return self._shift.policies.robots.match(tasks, robots, seconds, self._shift)

    def park(self, kiva_id, cell):
        return self._shift.policies.idle.park(kiva_id, cell, self._shift)

    @property
    def charging(self):
        return self._shift.policies.charging


def _ranks_of(assortment):
    order = np.argsort(-assortment.popularity, kind="stable")
    return {assortment.skus[i]: rank / len(order) for rank, i in enumerate(order)}
