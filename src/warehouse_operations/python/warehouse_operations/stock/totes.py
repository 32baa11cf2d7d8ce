# SPDX-License-Identifier: Apache-2.0
"""The places of the totes at a picking station."""

from collections import deque
from collections.abc import Iterator

from warehouse_operations.stock.orders import Order


class Totes:
    """The places for totes of a station, 1 to `count`; an order keeps its own while it is there."""

    def __init__(self, count: int) -> None:
        self._free = deque(range(1, count + 1))
        self._orders: dict[int, Order] = {}  # by position

    def take(self, order: Order) -> None:
        """Gives an order the place that is free for longest, whose tote has been changed."""
        order.tote = self._free.popleft() if self._free else 0
        if order.tote:
            self._orders[order.tote] = order

    def take_again(self, order: Order) -> None:
        """Gives an order the place back that it had; it must be free. Raises ValueError."""
        if order.tote:
            self._free.remove(order.tote)
            self._orders[order.tote] = order

    def leave(self, order: Order) -> None:
        """Frees the place of an order, which still knows it."""
        if self._orders.pop(order.tote, None):
            self._free.append(order.tote)

    def at(self, position: int) -> Order | None:
        """Returns the order whose tote stands at a position, or None."""
        return self._orders.get(position)

    def __iter__(self) -> Iterator[Order]:
        """Yields the orders by position."""
        return (self._orders[position] for position in sorted(self._orders))
