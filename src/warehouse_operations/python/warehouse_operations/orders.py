# SPDX-License-Identifier: Apache-2.0
"""Orders of customers, and the bundles of pieces that come to refill the stock."""

from collections import defaultdict
from dataclasses import dataclass, field

from warehouse_operations.message_enums import OrderState


class Line:
    """So many pieces of a SKU; `allotted` of them are reserved on a unit that comes."""

    __slots__ = ("order", "number", "sku", "quantity", "picked", "allotted")

    def __init__(self, order, number, sku, quantity, picked=0):
        self.order, self.number, self.sku, self.quantity = order, number, sku, quantity
        self.picked, self.allotted = picked, 0

    @property
    def open(self):
        """Pieces not picked yet."""
        return self.quantity - self.picked

    @property
    def missing(self):
        """Pieces for which no unit is on its way."""
        return self.quantity - self.picked - self.allotted


class Order:
    """What a customer wants; times are simulated seconds, due 0: at any time."""

    def __init__(self, order_id, lines, created, due=0.0, priority=0, reference=""):
        self.order_id, self.reference = order_id, reference or f"order-{order_id}"
        self.created, self.due, self.priority = created, due, priority
        self.lines = [Line(self, i, sku, n) for i, (sku, n) in enumerate(lines)]
        self.state, self.station = OrderState.OPEN, ""
        self.assigned = self.completed = 0.0
        self.stored = False  # whether a journal has it

    @property
    def urgency(self):
        """Sorts by priority, then by when it is due, then by age."""
        return -self.priority, self.due or float("inf"), self.order_id

    @property
    def pieces(self):
        """How many are not picked yet."""
        return sum(line.open for line in self.lines)

    @property
    def done(self):
        return all(not line.open for line in self.lines)


class Backlog:
    """The orders that no station has yet, by age, with the pieces they ask of each SKU."""

    def __init__(self):
        self.orders = {}
        self.lines = 0  # of all of them
        self.demand = defaultdict(int)  # pieces by SKU
        self._by_sku = defaultdict(dict)

    def __len__(self):
        return len(self.orders)

    def __iter__(self):
        return iter(self.orders.values())

    def add(self, order):
        self.orders[order.order_id] = order
        self.lines += len(order.lines)
        for line in order.lines:
            if line.open:
                self.demand[line.sku] += line.open
                self._by_sku[line.sku][order.order_id] = order

    def remove(self, order):
        del self.orders[order.order_id]
        self.lines -= len(order.lines)
        for line in order.lines:
            if line.open:
                self.demand[line.sku] -= line.open
                self._by_sku[line.sku].pop(order.order_id, None)

    def with_sku(self, sku):
        """The orders that ask for it, by age."""
        return self._by_sku[sku].values() if sku in self._by_sku else ()


@dataclass
class Bundle:
    """Pieces of one SKU that come to be stored together."""

    bundle_id: int
    sku: str
    quantity: int
    created: float = 0.0
    bin: object = field(default=None, repr=False)  # the Bin that it goes to, once chosen
    sequence: int = 0  # of the task for a person, then
