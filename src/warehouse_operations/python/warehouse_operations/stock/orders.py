# SPDX-License-Identifier: Apache-2.0
"""Customers' orders, and the bundles that refill the stock."""

import bisect
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from warehouse_layout.message_enums import OrderState


class Line:
    """A number of pieces of one SKU; `allotted` of them are reserved on units on their way."""

    __slots__ = ("order", "number", "sku", "quantity", "picked", "allotted")

    def __init__(
        self, order: "Order", number: int, sku: str, quantity: int, picked: int = 0
    ) -> None:
        self.order, self.number, self.sku, self.quantity = order, number, sku, quantity
        self.picked, self.allotted = picked, 0

    @property
    def open(self) -> int:
        """The number of pieces not picked yet."""
        return self.quantity - self.picked

    @property
    def missing(self) -> int:
        """The number of pieces for which no unit is on its way."""
        return self.quantity - self.picked - self.allotted


class Order:
    """The order of a customer; times are simulated [s]. due 0: no due time.

    lines: (SKU, pieces) of each line. tote: its place at its present or last station; 0: without.
    """

    def __init__(
        self,
        order_id: int,
        lines: Iterable[tuple[str, int]],
        created: float,
        due: float = 0.0,
        priority: int = 0,
        reference: str = "",
    ) -> None:
        self.order_id, self.reference = order_id, reference or f"order-{order_id}"
        self.created, self.due, self.priority = created, due, priority
        self.lines = [Line(self, i, sku, n) for i, (sku, n) in enumerate(lines)]
        self.state, self.station = OrderState.OPEN, ""
        self.assigned = self.completed = 0.0
        self.tote = 0
        self.stored = False  # whether a journal has recorded it
        self.assignment = 0  # the number under which a journal has its last assignment; 0: none

    @property
    def urgency(self) -> tuple[int, float, int]:
        """A sort key: by priority, due time and age."""
        return -self.priority, self.due or float("inf"), self.order_id

    @property
    def names(self) -> tuple[str, str]:
        """What it may be called by: its reference, and its number."""
        return self.reference, str(self.order_id)

    @property
    def pieces(self) -> int:
        """The number of pieces not picked yet."""
        return sum(line.open for line in self.lines)

    @property
    def done(self) -> bool:
        """Whether all pieces are picked."""
        return all(not line.open for line in self.lines)


class Backlog:
    """The orders without a station, by age, with their demand for pieces of each SKU. `added`: the
    number of orders added so far."""

    def __init__(self) -> None:
        self.orders: dict[int, Order] = {}  # by id
        self.pieces: dict[Order, int] = {}  # not picked yet; cached for choices
        self.lines = 0  # of all of them
        self.demand: dict[str, int] = defaultdict(int)  # pieces by SKU
        self._by_sku: dict[str, dict[Line, int]] = defaultdict(dict)  # open pieces by line
        self._urgencies: list[tuple[int, float, int]] = []  # of all of them, ascending
        self.added = 0
        self._numbers: dict[Order, int] = {}  # `added` at each
        self._last_added: dict[str, int] = {}  # the same at the last with an open line of a SKU

    def __len__(self) -> int:
        return len(self.orders)

    def __iter__(self) -> Iterator[Order]:
        return iter(self.orders.values())

    def add(self, order: Order) -> None:
        """Adds an order, with the demand of its open lines."""
        self.added += 1
        self._numbers[order] = self.added
        self.orders[order.order_id] = order
        self.pieces[order] = order.pieces
        bisect.insort(self._urgencies, order.urgency)
        self.lines += len(order.lines)
        for line in order.lines:
            if line.open:
                self.demand[line.sku] += line.open
                self._by_sku[line.sku][line] = line.open
                self._last_added[line.sku] = self.added

    def remove(self, order: Order) -> None:
        """Removes an order and its demand. Raises KeyError."""
        del self.orders[order.order_id], self.pieces[order], self._numbers[order]
        del self._urgencies[bisect.bisect_left(self._urgencies, order.urgency)]
        self.lines -= len(order.lines)
        for line in order.lines:
            if line.open:
                self.demand[line.sku] -= line.open
                del self._by_sku[line.sku][line]

    def set_urgency(self, order: Order, priority: int, due: float) -> None:
        """Changes the urgency of an order in the backlog; it keeps its age. Raises KeyError."""
        if order.order_id not in self.orders:
            raise KeyError(order.order_id)
        del self._urgencies[bisect.bisect_left(self._urgencies, order.urgency)]
        order.priority, order.due = priority, due
        bisect.insort(self._urgencies, order.urgency)

    def by_urgency(self) -> Iterator[Order]:
        """Returns an iterator over the orders, the most urgent first; the backlog must not change
        meanwhile."""
        return (self.orders[order_id] for _, _, order_id in self._urgencies)

    def lines_of(self, sku: str) -> Mapping[Line, int]:
        """Returns the lines of a SKU, by age of their orders, with their open pieces."""
        return self._by_sku.get(sku, {})

    def served_by(self, stock: Mapping[str, int], since: int = 0) -> dict[Order, int]:
        """Returns the number of pieces in a stock for each order with any.

        stock: pieces by SKU, which count for each of two lines of an order with the same SKU.
        since: only for orders added after this number of them.
        """
        served: dict[Order, int] = {}
        numbers, last_added = self._numbers, self._last_added
        for sku, pieces in stock.items():
            if last_added.get(sku, 0) <= since:
                continue
            for line, open_pieces in reversed(self._by_sku[sku].items()):  # the last added first
                order = line.order
                if numbers[order] <= since:
                    break
                served_so_far = served.get(order, 0)
                served[order] = served_so_far + (open_pieces if open_pieces < pieces else pieces)
        return served


@dataclass
class Bundle:
    """Pieces of one SKU that arrive together and are stored in one bin."""

    bundle_id: int
    sku: str
    quantity: int
    created: float = 0.0
    bin: Any = field(default=None, repr=False)  # its future Bin; None: not chosen yet
    sequence: int = 0  # of the task for a person, once there is a bin
