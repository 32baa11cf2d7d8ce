# SPDX-License-Identifier: Apache-2.0
"""The orders and bins that have changed, for clients that follow a shift live."""

from collections.abc import Collection
from typing import Any

from warehouse_operations.shift.journal import Journal
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.orders import Line, Order


class ChangeJournal:
    """Passes the records of a shift on to another Journal, and collects the changed orders and
    bins."""

    def __init__(self, journal: Journal) -> None:
        self._journal = journal
        self._orders: dict[int, Order] = {}
        self._bins: dict[int, Bin] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._journal, name)

    def order(self, order: Order) -> None:
        """Records a new Order, or the new state of a known one."""
        self._note(order)
        self._journal.order(order)

    def line(self, line: Line) -> None:
        """Records how many pieces of an order's Line are picked."""
        self._note(line.order)
        self._journal.line(line)

    def assigned(self, order: Order) -> None:
        """Records the assignment of an Order to its station."""
        self._note(order)
        self._journal.assigned(order)

    def unassigned(self, order: Order, now: float) -> None:
        """Records that a station gave an Order back unfinished."""
        self._note(order)
        self._journal.unassigned(order, now)

    def commit(self, now: float, bins: Collection[Bin]) -> None:
        """Marks everything recorded since the last call as one consistent state."""
        self._bins.update((bin_.bin_id, bin_) for bin_ in bins)
        self._journal.commit(now, bins)

    def take_orders(self) -> list[Order]:
        """Returns the Orders that have changed since the last call."""
        orders, self._orders = self._orders, {}
        return list(orders.values())

    def take_bins(self) -> list[Bin]:
        """Returns the Bins that have changed and were committed since the last call."""
        bins, self._bins = self._bins, {}
        return list(bins.values())

    def _note(self, order: Order) -> None:
        self._orders[order.order_id] = order
