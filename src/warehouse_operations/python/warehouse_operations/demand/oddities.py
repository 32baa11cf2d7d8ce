# SPDX-License-Identifier: Apache-2.0
"""Oddities of a file of orders, in sentences: what to check before trusting the file."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from warehouse_operations.demand.description import DAY, Orders
from warehouse_operations.stock.order_file import OrderDraft

NAMED = 3  # references in a sentence
MANY = 0.05  # share of the orders that come in the same second
GAP = 3600.0  # pause between two orders of a day that is odd [s]
LARGE = 20.0  # times the median pieces or lines
FEW_DAYS = 7


def oddities(orders: Orders) -> list[str]:
    """Returns a sentence for each oddity."""
    checks: Sequence[Callable[[Orders], Iterator[str]]] = (
        _due_before,
        _at_once,
        _gaps,
        _large,
        _repeated,
        _without_due,
        _same_orders,
        _days,
    )
    return [sentence for check in checks for sentence in check(orders)]


def _named(orders: Sequence[OrderDraft]) -> str:
    names = ", ".join(order.reference for order in orders[:NAMED])
    return names + (" …" if len(orders) > NAMED else "")


def _due_before(orders: Orders) -> Iterator[str]:
    early = [order for order in orders.orders if order.due and order.due <= order.at]
    if early:
        yield f"{len(early)} orders are due when they come, or before: {_named(early)}."


def _at_once(orders: Orders) -> Iterator[str]:
    at, count = Counter(order.at for order in orders.orders).most_common(1)[0]
    if count > max(MANY * len(orders.orders), 10):
        share = 100 * count / len(orders.orders)
        yield (
            f"{count} orders ({share:.0f} %) come in the same moment, at {at:g} s: a batch, or a"
            " column `at` that was not filled."
        )


def _gaps(orders: Orders) -> Iterator[str]:
    for day in orders.days:
        times = np.sort([order.at for order in orders.orders if order.at // DAY == day])
        waits = np.diff(times)
        if len(waits) and waits.max() > GAP and len(orders.days) < FEW_DAYS:
            begin = times[int(waits.argmax())]
            yield (
                f"No order comes for {waits.max() / 60:,.0f} min from {begin % DAY / 3600:.1f} h"
                f"{f' of day {day + 1}' if len(orders.days) > 1 else ''}."
            )


def _large(orders: Orders) -> Iterator[str]:
    for what, sizes in (
        ("pieces", [sum(n for _, n in order.lines) for order in orders.orders]),
        ("lines", [len(order.lines) for order in orders.orders]),
    ):
        middle = float(np.median(sizes))
        large = [order for order, size in zip(orders.orders, sizes) if size > LARGE * middle]
        if large:
            yield (
                f"{len(large)} orders have more than {LARGE:g} times the usual {middle:g} {what},"
                f" up to {max(sizes):,}: {_named(large)}."
            )


def _repeated(orders: Orders) -> Iterator[str]:
    if orders.repeated:
        line, reference, sku = orders.repeated[0]
        yield (
            f"{len(orders.repeated)} rows ask for a SKU that their order has already, and are added"
            f" to its line: line {line} ({reference}, {sku}) is the first."
        )


def _without_due(orders: Orders) -> Iterator[str]:
    count = sum(not order.due for order in orders.orders)
    if 0 < count < len(orders.orders):
        yield f"{count} of {len(orders.orders)} orders have no due time."
    elif count:
        yield "No order has a due time: two hours are taken for it where lateness is judged."


def _same_orders(orders: Orders) -> Iterator[str]:
    same = Counter((order.at, order.lines) for order in orders.orders)
    count = sum(number - 1 for number in same.values() if number > 1)
    if count:
        yield f"{count} orders repeat another one of the same moment, line by line."


def _days(orders: Orders) -> Iterator[str]:
    days = orders.days
    if len(days) > 1 and (empty := days[-1] - days[0] + 1 - len(days)):
        yield f"{empty} days between the first and the last have no order; they are left out."
