# SPDX-License-Identifier: Apache-2.0
"""Counts of what happens in a shift."""

from array import array
from collections import defaultdict, deque

from warehouse_operations.stock.orders import Bundle, Line, Order
from warehouse_operations.stock.stations import Visit

INTERVAL = 60.0  # of the series [s]
WAYS = 200  # latest ways of units back into storage


class Tally:
    """Counts what happens in a shift; times are simulated [s]."""

    def __init__(self) -> None:
        self.items_picked = self.lines_picked = self.orders_completed = 0
        self.bundles_stored = self.pieces_stored = self.late_orders = self.orders_received = 0
        self.trips = self.pick_visits = 0  # visits of units: to any station, to picking stations
        # Of each order that is complete, 24 bytes for as long as the shift lasts: the quantiles of
        # the KPIs and the report's charts are those of all orders. A million of them are 24 MB.
        self.turnover_s, self.throughput_s = array("d"), array("d")
        self.completed_s = array("d")  # when it was
        self.picked_in: dict[int, int] = defaultdict(int)  # by INTERVAL
        self.stored_in: dict[int, int] = defaultdict(int)
        self.completed_in: dict[int, int] = defaultdict(int)
        self.late_in: dict[int, int] = defaultdict(int)  # late orders, when they were due
        # From a unit's release until it is stored: traffic shows in it, and no queue does [s].
        self.ways_back: deque[float] = deque(maxlen=WAYS)

    def picked(self, now: float, pieces: int, line: Line) -> None:
        """Counts pieces that were picked for an order line."""
        self.items_picked += pieces
        self.lines_picked += not line.open
        self.picked_in[int(now // INTERVAL)] += pieces

    def stored(self, now: float, bundle: Bundle) -> None:
        """Counts a bundle that was put into its bin."""
        self.bundles_stored += 1
        self.pieces_stored += bundle.quantity
        self.stored_in[int(now // INTERVAL)] += bundle.quantity

    def unpicked(self, when: float, pieces: int, line: Line) -> None:
        """Uncounts pieces that were picked at a time [s]; call it before the line loses them."""
        self.items_picked -= pieces
        self.lines_picked -= not line.open
        self.picked_in[int(when // INTERVAL)] -= pieces

    def unstored(self, when: float, bundle: Bundle) -> None:
        """Uncounts a bundle that was put in at a time [s]."""
        self.bundles_stored -= 1
        self.pieces_stored -= bundle.quantity
        self.stored_in[int(when // INTERVAL)] -= bundle.quantity

    def completed(self, order: Order) -> None:
        """Counts an order that is complete."""
        self.orders_completed += 1
        self._late(order, 1)
        self.turnover_s.append(order.completed - order.created)
        self.throughput_s.append(order.completed - order.assigned)
        self.completed_s.append(order.completed)
        self.completed_in[int(order.completed // INTERVAL)] += 1

    def reopened(self, order: Order) -> None:
        """Uncounts a complete order. Raises ValueError if it was not counted."""
        self.orders_completed -= 1
        self._late(order, -1)
        times = order.completed - order.created, order.completed - order.assigned, order.completed
        counted = self.turnover_s, self.throughput_s, self.completed_s
        at = list(zip(*counted)).index(times)
        for series in counted:
            del series[at]
        self.completed_in[int(order.completed // INTERVAL)] -= 1

    def _late(self, order: Order, sign: int) -> None:
        """Counts an order if it was late."""
        if order.due and order.completed > order.due:
            self.late_orders += sign
            self.late_in[int(order.due // INTERVAL)] += sign

    def visited(self, visit: Visit) -> None:
        """Counts a visit that is over, if its unit reached the station."""
        if visit.arrived is not None:
            if visit.ended is not None and visit.released is not None:
                self.ways_back.append(visit.ended - visit.released)
            self.trips += 1
            self.pick_visits += not visit.replenishes
