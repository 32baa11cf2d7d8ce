# SPDX-License-Identifier: Apache-2.0
"""The orders of a shift from submission to their end."""

import itertools
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from datetime import timedelta

from warehouse_layout.message_enums import OrderEventKind, OrderState
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.notices import Notices
from warehouse_operations.stock import acceptance
from warehouse_operations.stock.orders import Backlog, Order

TOO_MANY = f"orders of {acceptance.MOST_WAITING} lines wait already; come back when there are fewer"
Lines = Sequence[tuple[str, int]]  # (SKU, pieces)


class OrderBook:
    """The orders that are not over.

    orders: all of them, by id. backlog: those without a station. skus: those that may be ordered.
    on_event: called for each event with (order, kind, sku, quantity, station, unit, text), or None.
    """

    def __init__(self, context: Context, skus: Iterable[str], notices: Notices) -> None:
        self._context, self._notices = context, notices
        self.backlog = Backlog()
        self.orders: dict[int, Order] = {}
        self.on_event: Callable[..., object] | None = None
        self.skus = frozenset(skus)
        self._ids = itertools.count(1)
        self._on_backlog_change: Callable[[], object] = lambda: None
        self._take_away: Callable[[Order], object] = lambda _: None

    @property
    def capacity(self) -> int:
        """The pieces that all bins can hold: no order may ask for more."""
        return self._context.inventory.capacity

    def register(
        self, on_backlog_change: Callable[[], object], take_away: Callable[[Order], object]
    ) -> None:
        """Sets the part that assigns orders to stations.

        on_backlog_change() is called where the backlog has a new order, take_away(order) for one
        that is cancelled while a station has it.
        """
        self._on_backlog_change, self._take_away = on_backlog_change, take_away

    def submit(
        self, lines: Lines, due: float = 0.0, priority: int = 0, reference: str = ""
    ) -> tuple[Order | None, str]:
        """Takes a new order of (SKU, pieces), due at a time [s], 0: at any time.

        Returns (order, the cause of its wait), or (None, the reason of the refusal).
        """
        reason = self._fault_of(lines) or acceptance.fault_of_head(reference, due, priority)
        if reason:
            return None, reason
        if self.backlog.lines + len(lines) > acceptance.MOST_WAITING:
            return None, TOO_MANY
        merged: dict[str, int] = defaultdict(int)
        for sku, pieces in lines:
            merged[sku] += pieces
        order = Order(
            next(self._ids), merged.items(), self._context.clock.now, due, priority, reference
        )
        self.orders[order.order_id] = order
        self._context.tally.orders_received += 1
        self._context.journal.order(order)
        self.publish_event(order, OrderEventKind.RECEIVED)
        lacking = [s for s, n in merged.items() if n > self.unpromised(s)]
        for sku in lacking:
            self.publish_event(
                order, OrderEventKind.SHORT, sku, merged[sku], text="waits for replenishment"
            )
        self.backlog.add(order)
        self._on_backlog_change()
        return order, f"waits for replenishment of {', '.join(lacking)}" if lacking else ""

    def unpromised(self, sku: str) -> int:
        """Returns the number of available pieces of a SKU beyond the backlog's demand."""
        return self._context.inventory.available(sku) - self.backlog.demand.get(sku, 0)

    def _fault_of(self, lines: Lines) -> str:
        return acceptance.fault_of_lines(lines, self.skus, self.capacity)

    def cancel(self, order_id: int) -> tuple[bool, str]:
        """Cancels an order. Returns success and the reason of a refusal."""
        order = self.orders.get(order_id)
        if not order:
            return False, f"order {order_id} is unknown, or over"
        if order.done:
            return False, f"order {order_id} has all its pieces"
        if order.state == OrderState.ASSIGNED:
            self._take_away(order)
        else:
            self.backlog.remove(order)
        return True, self._end_cancelled(order)

    def change(
        self, order_id: int, priority: int | None = None, due: float | None = None
    ) -> tuple[bool, str]:
        """Sets how urgent an order is, and when it is due [s], 0: at any time; None: as it is.

        Returns success and the reason of a refusal.
        """
        order = self.orders.get(order_id)
        if not order:
            return False, f"order {order_id} is unknown, or over"
        priority = order.priority if priority is None else priority
        due = order.due if due is None else due
        if reason := acceptance.fault_of_head(order.reference, due, priority):
            return False, reason
        if order.state == OrderState.OPEN:
            self.backlog.set_urgency(order, priority, due)
        else:
            order.priority, order.due = priority, due
        self._context.journal.order(order)
        moment = f"due at {timedelta(seconds=round(due))}" if due else "due at any time"
        text = f"priority {priority}, {moment}"
        self.publish_event(order, OrderEventKind.CHANGED, text=text)
        self._on_backlog_change()
        return True, text

    def _end_cancelled(self, order: Order, reason: str = "") -> str:
        """Ends an order that is neither in the backlog nor at a station; returns the event's
        text."""
        order.state = OrderState.CANCELLED
        picked = sum(line.picked for line in order.lines)
        text = "; ".join(
            filter(None, (reason, f"{picked} pieces were picked already" if picked else ""))
        )
        self.end(order, OrderEventKind.CANCELLED, text=text)
        return text

    def reopen(self, order: Order) -> None:
        """Puts an order that its station can't finish back into the backlog."""
        order.state = OrderState.OPEN
        self.backlog.add(order)
        self._context.journal.order(order)
        self._on_backlog_change()

    def bring_back(self, order: Order) -> None:
        """Returns a complete order to its station after a piece was taken back."""
        self._context.tally.reopened(order)
        self.orders[order.order_id] = order
        order.state, order.completed = OrderState.ASSIGNED, 0.0
        self._context.journal.order(order)
        self.publish_event(order, OrderEventKind.REOPENED)

    def end(self, order: Order, kind: OrderEventKind, station: str = "", text: str = "") -> None:
        """Counts and drops an order that is complete or cancelled, and publishes that."""
        if kind == OrderEventKind.COMPLETED:
            self._context.tally.completed(order)
        self._context.journal.order(order)
        self.publish_event(order, kind, station=station, text=text)
        del self.orders[order.order_id]

    def resume(self, orders: Sequence[Order], last_order: int) -> None:
        """Adds orders of an earlier run; new ones are numbered from last_order + 1."""
        self._ids = itertools.count(last_order + 1)
        for order in orders:
            self.orders[order.order_id] = order
            fault = self._fault_of([(line.sku, line.quantity) for line in order.lines])
            if order.done:
                order.completed = self._context.clock.now
                order.state = OrderState.COMPLETED
                self.end(order, OrderEventKind.COMPLETED)
            elif fault:
                self._end_cancelled(order, fault)
                self._notices.add(
                    f"order {order.order_id} ({order.reference}) is cancelled: {fault}"
                )
            else:
                self.backlog.add(order)

    def publish_event(
        self,
        order: Order,
        kind: OrderEventKind,
        sku: str = "",
        quantity: int = 0,
        station: str = "",
        unit: int = 0,
        text: str = "",
    ) -> None:
        """Writes an event of an order down, hashes it and hands it to on_event."""
        station = station or order.station
        about = order.order_id, sku, quantity, station, unit
        self._context.update_hash("order", order.order_id, int(kind), *about[1:])
        self._context.journal.event(self._context.clock.now, kind, *about, text)
        if self.on_event:
            self.on_event(order, kind, sku, quantity, station, unit, text)
