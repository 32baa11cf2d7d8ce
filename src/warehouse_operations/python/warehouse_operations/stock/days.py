# SPDX-License-Identifier: Apache-2.0
"""The orders of a day, recorded or drawn, multiplied by a factor."""

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from warehouse_operations.stock import demand_file
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.demand_file import DrawnDays
from warehouse_operations.stock.order_file import DemandError, OrderDraft, lines_by_sku, read_csv
from warehouse_operations.stock.orders_text import DAY, DayText

HOUR = 3600.0  # [s]
NEAR = 300.0  # longest time between an order and its copy [s]
MOST_NAMED = 20  # SKUs in a message


def assortment_of(day: DayText) -> Assortment:
    """Returns the SKUs of a day's file with their popularity. Raises DemandError."""
    lines = lines_by_sku(day.file) if day.kind == DAY else demand_file.read(day.file).skus
    if not lines:
        raise DemandError(f"{day.file}: there is no order in it")
    return Assortment.of_lines(lines)


def check_stock(file: str, asked: Collection[str], stock: Collection[str]) -> None:
    """Raises DemandError, which names each SKU that the stock lacks."""
    has = set(stock)
    lacking = [sku for sku in asked if sku not in has]
    if lacking:
        named = ", ".join(lacking[:MOST_NAMED])
        more = f" and {len(lacking) - MOST_NAMED} more" if len(lacking) > MOST_NAMED else ""
        count = f"{len(lacking)} SKU{'' if len(lacking) == 1 else 's'}"
        raise DemandError(f"{file}: the stock has none of {count} of {len(asked)}: {named}{more}")


def scaled(
    orders: Sequence[OrderDraft], factor: float, rng: np.random.Generator
) -> list[OrderDraft]:
    """Returns the orders multiplied by a factor: whole copies, and a random part for the rest.

    A copy comes within NEAR of its order, has the same time until it is due, and its own reference.
    """
    whole, part = divmod(factor, 1)
    out = []
    for order in orders:
        copies = int(whole) + int(rng.random() < part)
        for number in range(copies):
            shift = float(rng.uniform(-NEAR, NEAR)) if number else 0.0
            at = max(order.at + shift, 0.0)
            due = order.due + at - order.at if order.due else 0.0
            reference = f"{order.reference}-{number + 1}" if number else order.reference
            out.append(replace(order, at=at, due=due, reference=reference))
    return out


def orders_of(
    day: DayText,
    skus: Collection[str] | None,
    rng: np.random.Generator,
    capacity: float,
) -> list[OrderDraft]:
    """Returns the orders of a day of a CSV file, with those of its first hour before it for a
    run-in. skus: in stock; None: any. Raises DemandError."""
    orders = read_csv(day.file, None, capacity)
    if not orders:
        raise DemandError(f"{day.file}: there is no order in it")
    if skus is not None:
        asked = dict.fromkeys(sku for order in orders for sku, _ in order.lines)
        check_stock(day.file, asked, skus)
    orders, seconds = scaled(orders, day.factor, rng), 60 * day.run_in
    later = [_moved(order, seconds) for order in orders]
    return [*_before(orders, seconds), *later] if seconds else later


def drawn(
    day: DayText,
    skus: Collection[str] | None,
    rng: np.random.Generator,
    now: float = 0.0,
) -> DrawnDays:
    """Returns days that are drawn from a description. Raises DemandError."""
    demand = demand_file.read(day.file)
    if skus is not None:
        check_stock(day.file, demand.skus, skus)
    return DrawnDays(demand, rng, day.factor, now, now + 60 * day.run_in)


def _before(orders: Sequence[OrderDraft], seconds: float) -> list[OrderDraft]:
    """Returns the orders of the first hour with orders, repeated until the day begins."""
    begin = HOUR * (min(order.at for order in orders) // HOUR)
    first = [order for order in orders if begin <= order.at < begin + HOUR]
    out, start, number = [], seconds - HOUR, 1
    while start > -HOUR:
        for order in first:
            moved = _moved(order, start - begin)
            if moved.at >= 0:
                reference = f"{order.reference}-before-{number}"
                out.append(replace(moved, reference=reference[-200:]))
        start, number = start - HOUR, number + 1
    return out


def _moved(order: OrderDraft, seconds: float) -> OrderDraft:
    due = max(order.due + seconds, 1.0) if order.due else 0.0
    return replace(order, at=order.at + seconds, due=due)
