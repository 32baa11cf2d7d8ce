# SPDX-License-Identifier: Apache-2.0
"""Picking: assigns orders to stations, fetches units for their lines, picks piece by piece."""

import math
from collections import defaultdict
from collections.abc import Sequence

from warehouse_layout.message_enums import OrderEventKind, OrderState, StationMode
from warehouse_operations.policies import Policies
from warehouse_operations.policies.view import View
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.order_book import OrderBook
from warehouse_operations.shift.task_reports import TaskNumbers
from warehouse_operations.shift.visits import Visits
from warehouse_operations.stock.candidates import Candidates
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.orders import Line, Order
from warehouse_operations.stock.stations import Pick, Visit, WorkStation

RETRY = 1.0  # after the fleet refused a unit [s]
LOOK = 1.0  # between two looks of stations with a free slot at orders that have come [s]
LATER = 0.1  # delay for stations whose choice exceeds the effort of a step [s]
EFFORT = 200_000  # most order lines that a step examines: about 0.1 s of work


class Picking:
    """The work at picking stations: assigning orders, fetching units, picking pieces."""

    def __init__(
        self,
        context: Context,
        stations: Sequence[WorkStation],
        *,
        policies: Policies,
        view: View,
        order_book: OrderBook,
        visits: Visits,
        task_numbers: TaskNumbers,
    ) -> None:
        self._context, self._clock, self.stations = context, context.clock, stations
        self._inventory, self._policies, self._view = context.inventory, policies, view
        self._order_book, self._visits, self._task_numbers = order_book, visits, task_numbers
        self._backlog = order_book.backlog
        order_book.register(self.on_backlog_change, self.cancel)
        visits.register(self, replenishes=False)
        for station in stations:
            station.on_hands_free.append(self.next_piece)
        # Stations that may take on an order, that lack units, in the order in which they change.
        self._to_assign: dict[WorkStation, None] = dict.fromkeys(stations)
        self._to_fetch: dict[WorkStation, None] = {}
        self._is_to_look, self._next_look = False, -math.inf
        self._early: set[WorkStation] = set()  # stations whose policy waits with the next unit
        self._effort = EFFORT  # left in this step
        self._put_off: dict[WorkStation, None] = {}  # stations that wait for more effort
        # The stations of lines without a unit, by (order, line), by SKU.
        self._missing: dict[str, dict[tuple[int, int], WorkStation]] = defaultdict(dict)

    # Changes that make work.

    def on_backlog_change(self) -> None:
        """Lets stations with a free slot look at the backlog, once in LOOK at most.

        Orders that come in a row are examined together: a look costs time for each order and
        station.
        """
        if self._clock.now >= self._next_look:
            self._check_backlog(None)
        elif not self._is_to_look:
            self._is_to_look = True
            self._clock.schedule(self._next_look, self._check_backlog)

    def _check_backlog(self, _: None) -> None:
        self._is_to_look, self._next_look = False, self._clock.now + LOOK
        for station in self.stations:
            if station.free_slots and station.is_open:
                self._to_assign[station] = None

    def on_unit_free(self, unit: int) -> None:
        """Lets stations fetch a unit that is back in storage, if it holds pieces that they lack."""
        for bin_ in self._inventory.of_unit[unit]:
            if bin_.available and bin_.sku in self._missing:
                for station in self._missing[bin_.sku].values():
                    self._to_fetch[station] = None

    def work(self) -> None:
        """Assigns orders and asks for units where something has changed."""
        while self._to_assign or self._to_fetch:
            for station in sorted(self._to_assign, key=lambda station: -station.free_slots):
                self._assign(station)
            self._to_assign.clear()
            stations, self._to_fetch = self._to_fetch, {}
            for station in stations:
                self._fetch(station)
        self._effort = EFFORT

    # Orders.

    def _assign(self, station: WorkStation) -> None:
        while station.is_open and station.free_slots > 0 and len(self._backlog):
            if self._effort <= 0:
                self._assign_later(station)
                return
            self._effort -= self._backlog.lines
            order = self._policies.orders.choose(station, self._view)
            if order is None:
                return
            self._backlog.remove(order)
            self._take_on(station, order)

    def _assign_later(self, station: WorkStation) -> None:
        if not self._put_off:
            self._clock.schedule(self._clock.now + LATER, self._assign_put_off)
        self._put_off[station] = None

    def _assign_put_off(self, _: None) -> None:
        self._to_assign.update(self._put_off)
        self._put_off = {}

    def restore(self, station: WorkStation, order: Order) -> None:
        """Gives a station an order of the backlog that it had in an earlier run."""
        self._backlog.remove(order)
        self._take_on(station, order)

    def _take_on(self, station: WorkStation, order: Order) -> None:
        order.state, order.station, order.assigned = (
            OrderState.ASSIGNED,
            station.name,
            self._clock.now,
        )
        station.take_on(order)
        self._context.journal.assigned(order)
        self._order_book.publish_event(order, OrderEventKind.ASSIGNED)
        for line in order.lines:
            self.allot(station, line)

    def allot(self, station: WorkStation, line: Line) -> None:
        """Reserves pieces for a line on the units at its station or on their way there."""
        for visit in station.coming_for(replenishes=False):
            for bin_ in self._inventory.of_unit[visit.unit]:
                pieces = min(line.missing, bin_.available) if bin_.sku == line.sku else 0
                if pieces > 0:
                    self._reserve(visit, line, bin_, pieces)
        self._note(station, line)
        here = station.here
        if here and here.picks:
            self.next_piece(station)

    def _reserve(self, visit: Visit, line: Line, bin_: Bin, pieces: int) -> None:
        self._inventory.reserve(bin_, pieces)
        line.allotted += pieces
        visit.picks.append(Pick(line, bin_, pieces, self._task_numbers.number()))

    def _note(self, station: WorkStation, line: Line) -> None:
        """Notes whether units are to be fetched for a line."""
        key = line.order.order_id, line.number
        if line.missing > 0 and line.order.order_id in station.orders:
            station.missing[key] = line
            self._missing[line.sku][key] = station
            self._to_fetch[station] = None
        elif key in station.missing:
            del station.missing[key]
            del self._missing[line.sku][key]

    def _return(self, station: WorkStation, order: Order) -> None:
        """Takes an unfinished order away from its station."""
        station.let_go(order)
        for visit in station.inbound.values():
            for pick in [pick for pick in visit.picks if pick.line.order is order]:
                self.drop(visit, pick)
        for line in order.lines:
            self._note(station, line)
        order.station = ""
        self._to_assign[station] = None
        self._context.journal.unassigned(order, self._clock.now)

    def drop(self, visit: Visit, pick: Pick) -> None:
        """Removes a pick from its visit and gives its pieces back."""
        visit.picks.remove(pick)
        pick.line.allotted -= pick.quantity
        self._inventory.reserve(pick.bin, -pick.quantity)

    def cancel(self, order: Order) -> None:
        """Takes an order away from the station that has it."""
        station = next(s for s in self.stations if s.name == order.station)
        self._return(station, order)
        self.leave_if_done(station)

    def drop_visit(self, visit: Visit) -> None:
        """Drops all picks of a visit; their lines need another unit."""
        lines = [pick.line for pick in visit.picks]
        for pick in list(visit.picks):
            self.drop(visit, pick)
        for line in lines:
            self._note(visit.station, line)
        self._to_fetch[visit.station] = None  # it has room for another unit

    def drop_bin(self, bin_: Bin) -> list[tuple[Visit, Line]]:
        """Drops all picks from a bin; returns the visit and line of each."""
        dropped = [(v, p) for v in self._visits_of(bin_.unit) for p in v.picks if p.bin is bin_]
        for visit, pick in dropped:
            self.drop(visit, pick)
        return [(visit, pick.line) for visit, pick in dropped]

    def serve_otherwise(self, dropped: Sequence[tuple[Visit, Line]]) -> None:
        """Serves the lines that drop_bin returned from other bins."""
        for visit, line in dropped:
            self.allot(visit.station, line)
            self.leave_if_done(visit.station)

    def open(self, station: WorkStation) -> None:
        """Starts the work of a station that was opened, or whose mode was set."""
        self.on_backlog_change()
        self.next_piece(station)

    def close(self, station: WorkStation) -> None:
        """Gives the orders of a station back to the backlog and sends its units away."""
        for visit in station.coming_for(replenishes=False):
            self.drop_visit(visit)
            if not visit.here:
                self._visits.cancel(visit)
        self.leave_if_done(station)
        for order in list(station.orders.values()):
            if not order.done:
                self.give_back(station, order)

    def give_back(self, station: WorkStation, order: Order) -> None:
        """Puts an unfinished order of a station back into the backlog."""
        self._return(station, order)
        self._order_book.reopen(order)

    # Units.

    def _fetch(self, station: WorkStation) -> None:
        limit, policy = self._visits.most, self._policies.units
        is_early = getattr(policy, "is_early", lambda _: False)
        while station.is_open and station.missing and len(station.coming) < limit:
            if is_early(station):
                self._early.add(station)
                return
            candidates = self._candidates(station)
            if not candidates:
                return
            unit = policy.choose(station, candidates, self._view)
            visit = self._visits.request(unit, station)
            if not visit:
                self._clock.schedule(self._clock.now + RETRY, self._retry, station)
                return
            for line in candidates[unit]:
                self.allot(station, line)

    def _retry(self, station: WorkStation) -> None:
        self._to_fetch[station] = None

    def _candidates(self, station: WorkStation) -> Candidates:
        """Returns what each free unit could serve: {unit: {line: pieces}}."""
        free_units = self._visits.free_units
        return Candidates(station.missing.values(), self._inventory, free_units)

    # At the station.

    def on_arrival(self, visit: Visit) -> None:
        """Starts picking from a unit that has arrived, or lets it leave."""
        self._to_assign[visit.station] = None
        self.next_piece(visit.station)
        self.leave_if_done(visit.station)

    def next_piece(self, station: WorkStation) -> None:
        """Starts picking the next pieces, one for each free picker, if a unit is there."""
        visit = station.here
        if not visit or station.mode == StationMode.MANUAL:
            return
        while station.at_work < station.pickers and station.reaching < visit.pieces_to_pick:
            self._reach(station, visit)

    def _reach(self, station: WorkStation, visit: Visit) -> None:
        """Lets a picker begin with a piece."""
        station.at_work += 1
        station.reaching += 1
        line = visit.piece_to_pick(station.reaching - 1).line
        more = station.seconds_a_line if line is not station.line else 0.0
        station.line, now = line, self._clock.now
        whole, first = station.draw_times()
        self._clock.schedule(now + more + first, self._taken, (station, visit))
        taken = now + more + whole
        self._clock.schedule(taken, self._in_tote, (station, now))

    def _taken(self, argument: tuple[WorkStation, Visit]) -> None:
        """Takes a piece out of its bin; the unit may leave if it was the last."""
        station, visit = argument
        station.reaching -= 1
        if visit.here and visit.picks:  # else the order was cancelled meanwhile
            self.take(visit, visit.picks[0], 1)
            self.leave_if_done(station)

    def _in_tote(self, argument: tuple[WorkStation, float]) -> None:
        station, began = argument
        station.at_work -= 1
        station.busy_s += self._clock.now - began
        self.complete(station)
        station.next_work()

    def take(self, visit: Visit, pick: Pick, pieces: int) -> None:
        """Takes pieces of a pick out of the stock."""
        line, station = pick.line, visit.station
        self._inventory.pick(pick.bin, pieces, line=line, station=station, visit=visit)
        pick.quantity -= pieces
        line.allotted -= pieces
        line.picked += pieces
        if pick.quantity:
            pick.sequence = self._task_numbers.number()  # what is left is another task
        else:
            visit.picks.remove(pick)
        visit.pieces += pieces
        station.pieces += pieces
        if station in self._early:
            self._early.remove(station)
            self._to_fetch[station] = None
        self._context.tally.picked(self._clock.now, pieces, line)
        self._context.journal.line(line)
        self._order_book.publish_event(
            line.order, OrderEventKind.PICKED, line.sku, pieces, station.name, visit.unit
        )

    def complete(self, station: WorkStation) -> None:
        """Completes the orders of a station that have all their pieces."""
        for order in [order for order in station.orders.values() if order.done]:
            station.let_go(order)
            order.state, order.completed = OrderState.COMPLETED, self._clock.now
            self._order_book.end(order, OrderEventKind.COMPLETED, station=station.name)
            self._to_assign[station] = None

    def leave_if_done(self, station: WorkStation) -> None:
        """Releases a unit with nothing left to pick, unless it serves an order taken on now."""
        visit = station.here
        if not visit or visit.replenishes or visit.picks:
            return
        self._assign(station)
        if not visit.picks:
            self._visits.release(visit)
            self._to_assign[station] = self._to_fetch[station] = None

    def _visits_of(self, unit: int) -> list[Visit]:
        return [v for s in self.stations for v in s.inbound.values() if v.unit == unit]
