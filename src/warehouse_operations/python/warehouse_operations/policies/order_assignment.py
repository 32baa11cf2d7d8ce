# SPDX-License-Identifier: Apache-2.0
"""Policies that choose the next order of a picking station."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View


class Random:
    """Chooses any order in stock."""

    def choose(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order that a station gets, or None."""
        orders = [order for order in view.backlog if view.in_stock(order)]
        return orders[view.rng.integers(len(orders))] if orders else None


class FirstCome:
    """Chooses the oldest order in stock."""

    def choose(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order that a station gets, or None."""
        return next((order for order in view.backlog if view.in_stock(order)), None)


class DueDate:
    """Chooses the most urgent order in stock: by priority, then by due time, then by age."""

    def choose(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order that a station gets, or None."""
        return _most_urgent(view)


class FewestLinesMissing:
    """Chooses the order with the fewest lines that no inbound unit can serve."""

    def choose(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order that a station gets, or None."""
        stock = station.inbound_stock()

        def missing(order: Order) -> int:
            return sum(stock.get(line.sku, 0) < line.open for line in order.lines if line.open)

        def rank(order: Any) -> tuple[int, tuple[int, float, int]]:
            return missing(order), order.urgency

        orders = (order for order in view.backlog if view.in_stock(order))
        return min(orders, key=rank, default=None)


class PileOn:
    """Chooses the order of which the inbound units can serve most; the most urgent of equals.

    fast_lane: the last slot is kept for orders that the unit at the station completes at once.
    """

    def __init__(self, fast_lane: bool = True) -> None:
        self.fast_lane = fast_lane
        # By station whose last look found no order: the stock it looked at, and `Backlog.added`.
        self._in_vain: dict[WorkStation, tuple[Mapping[str, int], int]] = {}

    def choose(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order that a station gets, or None."""
        if self.fast_lane and station.free_slots == 1 and station.capacity > 1:
            return self._completed(station, view)
        served = view.backlog.served_by(station.inbound_stock())
        return self._best(served, view) or _most_urgent(view)

    def _completed(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order that the unit at a station completes at once, or None. Most looks are
        in vain: the next one, at the same stock, needs to see only the orders added since."""
        stock, backlog = station.stock_here(), view.backlog
        last_stock, added = self._in_vain.get(station, (None, 0))
        served = backlog.served_by(stock, added if last_stock == stock else 0)
        order = self._best(served, view, complete=True)
        if order is None:
            self._in_vain[station] = stock, backlog.added
        return order

    @staticmethod
    def _best(served: Mapping[Order, int], view: "View", complete: bool = False) -> Order | None:
        best: Order | None = None
        best_score: tuple[int, bool, int] = (0, True, 0)
        pieces = view.backlog.pieces
        for order, its_pieces in served.items():
            missing = pieces[order] > its_pieces
            if missing and complete:
                continue
            score = -order.priority, missing, -its_pieces
            if best is not None and (
                score > best_score or (score == best_score and order.urgency > best.urgency)
            ):
                continue
            if not missing or view.in_stock(order):  # checked last: it costs most
                best, best_score = order, score
        return best


def _most_urgent(view: "View") -> Order | None:
    return next((order for order in view.backlog.by_urgency() if view.in_stock(order)), None)


NAMES: dict[str, type] = {
    "random": Random,
    "first come": FirstCome,
    "due date": DueDate,
    "fewest lines missing": FewestLinesMissing,
    "pile-on": PileOn,
}
