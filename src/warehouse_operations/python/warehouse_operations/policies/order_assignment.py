# SPDX-License-Identifier: Apache-2.0
"""Which order a picking station works at next."""


class Random:
    def choose(self, station, view):
        orders = [order for order in view.backlog if view.in_stock(order)]
        return orders[view.rng.integers(len(orders))] if orders else None


class FirstCome:
    def choose(self, station, view):
        return next((order for order in view.backlog if view.in_stock(order)), None)


class DueDate:
    def choose(self, station, view):
        return _most_urgent(view)


class FewestLinesMissing:
    """The order with the fewest lines that no unit at the station or on its way can serve."""

    def choose(self, station, view):
        stock = station.inbound_stock()

        def missing(order):
            return sum(stock.get(line.sku, 0) < line.open for line in order.lines if line.open)

        orders = (order for order in view.backlog if view.in_stock(order))
        return min(orders, key=lambda order: (missing(order), order.urgency), default=None)


class PileOn:
    """The order of which the inbound units can serve most; the most urgent of equals.

    fast_lane: the last slot is kept for orders that the unit at the station completes at once.
    """

    def __init__(self, fast_lane=True):
        self.fast_lane = fast_lane

    def choose(self, station, view):
        if self.fast_lane and station.free_slots == 1 and station.capacity > 1:
            return self._best(station.stock_here(), view, complete=True)
        return self._best(station.inbound_stock(), view) or _most_urgent(view)

    @staticmethod
    def _best(stock, view, complete=False):
        best, best_score = None, None
        seen = set()
        for sku in stock:
            for order in view.backlog.with_sku(sku):
                if order.order_id in seen:
                    continue
                seen.add(order.order_id)
                served = sum(min(line.open, stock.get(line.sku, 0)) for line in order.lines)
                missing = order.pieces - served
                if missing and (complete or not view.in_stock(order)):
                    continue
                score = (-order.priority, missing > 0, -served, order.urgency)
                if best is None or score < best_score:
                    best, best_score = order, score
        return best


def _most_urgent(view):
    orders = (order for order in view.backlog if view.in_stock(order))
    return min(orders, key=lambda order: order.urgency, default=None)


NAMES = {
    "random": Random,
    "first come": FirstCome,
    "due date": DueDate,
    "fewest lines missing": FewestLinesMissing,
    "pile-on": PileOn,
}
