# SPDX-License-Identifier: Apache-2.0
"""Takes confirmations of people back while the unit that they are about is still there."""

from warehouse_layout.message_enums import OrderEventKind, OrderState, StationMode
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.order_book import OrderBook
from warehouse_operations.shift.picking import Picking
from warehouse_operations.shift.task_reports import TaskNumbers
from warehouse_operations.stock.inventory import Bin, Reason, StockError
from warehouse_operations.stock.orders import Bundle, Order
from warehouse_operations.stock.stations import Pick, Visit, WorkStation


class TakingBack:
    """Undoes picks and bundles of stations in mode MANUAL; each method returns the reason of a
    refusal, or ""."""

    def __init__(
        self, context: Context, order_book: OrderBook, picking: Picking, task_numbers: TaskNumbers
    ) -> None:
        self._context, self._inventory = context, context.inventory
        self._order_book, self._picking, self._task_numbers = order_book, picking, task_numbers

    def pick(self, visit: Visit, pick: Pick, pieces: int, when: float) -> str:
        """Returns pieces that were picked at a time [s] to their bin; they are the next task."""
        line, station = pick.line, visit.station
        refusal = _away(visit) or _no_room(pick.bin, line.sku, pieces)
        if refusal := refusal or self._have_order(station, line.order):
            return refusal
        context = {"line": line, "station": station, "visit": visit}
        self._inventory.move(pick.bin, line.sku, pieces, Reason.UNDONE, **context)
        self._inventory.reserve(pick.bin, pieces)
        self._context.tally.unpicked(when, pieces, line)
        line.picked -= pieces
        line.allotted += pieces
        self._ask_again(visit, pick, pieces)
        self._context.journal.line(line)
        kind, fields = OrderEventKind.UNPICKED, (line.sku, pieces, station.name, visit.unit)
        self._order_book.publish_event(line.order, kind, *fields)
        return ""

    def put(self, visit: Visit, bundle: Bundle, when: float) -> str:
        """Takes a bundle that was put in at a time [s] out again, to be put in next."""
        bin_, sku, pieces = bundle.bin, bundle.sku, bundle.quantity
        if refusal := _away(visit):
            return refusal
        context = {"station": visit.station, "visit": visit}
        try:
            self._inventory.move(bin_, sku, -pieces, Reason.UNDONE, **context)
        except StockError:
            return f"pieces of {sku} in {bin_.item} are promised to orders by now"
        self._inventory.expect(bin_, sku, pieces)
        self._context.tally.unstored(when, bundle)
        self._count_out(visit, pieces)
        bundle.sequence = self._task_numbers.number()
        visit.puts.appendleft(bundle)
        return ""

    def _ask_again(self, visit: Visit, pick: Pick, pieces: int) -> None:
        """Makes pieces the next ones to be picked, with the rest of their pick."""
        is_left = pick in visit.picks
        if is_left:
            visit.picks.remove(pick)
        pick.quantity = pieces + (pick.quantity if is_left else 0)
        pick.sequence = self._task_numbers.number()
        visit.picks.appendleft(pick)
        self._count_out(visit, pieces)

    def _count_out(self, visit: Visit, pieces: int) -> None:
        visit.pieces -= pieces
        visit.station.pieces -= pieces

    def _have_order(self, station: WorkStation, order: Order) -> str:
        """Assigns an order to its last station again."""
        if order.order_id in station.orders:
            return ""
        if order.state != OrderState.COMPLETED:
            return f"{order.reference} is no longer at {station.name}"
        if not station.is_open:
            return f"{station.name} is closed"
        holder = station.totes.at(order.tote)
        if holder and any(line.picked for line in holder.lines):
            return (
                f"{order.reference} is complete; tote {order.tote} is {holder.reference}'s by now"
            )
        if holder:
            self._picking.give_back(station, holder)
        station.take_on(order, again=True)
        self._order_book.bring_back(order)
        return ""


def _away(visit: Visit) -> str:
    if not visit.here:
        return f"storage unit {visit.unit} has left {visit.station.name}"
    if visit.station.mode != StationMode.MANUAL:
        return f"{visit.station.name} works by itself"
    return ""


def _no_room(bin_: Bin, sku: str, pieces: int) -> str:
    if bin_.room >= pieces and (bin_.empty or bin_.sku == sku):
        return ""
    return f"{bin_.item} has no room for {pieces} of {sku} any more"
