# SPDX-License-Identifier: Apache-2.0
"""What the counts of a shift keep, however many orders it has."""

from array import array
from collections.abc import Sized

from warehouse_operations.shift.tally import INTERVAL, WAYS, Tally
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.stations import Visit

ORDERS, MINUTES = 20_000, 60


def complete(tally, count):
    """Completes orders, spread over MINUTES, each carried back by a unit."""
    for number in range(count):
        now = number * MINUTES * INTERVAL / count
        order = Order(number, lines=[], created=now - 90.0)
        order.assigned, order.completed = now - 60.0, now
        tally.completed(order)
        visit = Visit(1, 1, 1, station=None, requested=now - 60.0)
        visit.arrived, visit.released, visit.ended = now - 9.0, now - 5.0, now
        tally.visited(visit)


def test_an_order_that_is_complete_leaves_24_bytes():
    tally = Tally()
    complete(tally, ORDERS)
    kept = {name: value for name, value in vars(tally).items() if isinstance(value, Sized)}
    arrays = {name: value for name, value in kept.items() if isinstance(value, array)}
    assert {len(value) for value in arrays.values()} == {ORDERS}
    assert sum(value.itemsize for value in arrays.values()) == 24
    others = {name: len(value) for name, value in kept.items() if name not in arrays}
    assert max(others.values()) == max(WAYS, MINUTES), others
