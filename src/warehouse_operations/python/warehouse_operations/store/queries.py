# SPDX-License-Identifier: Apache-2.0
"""Searches of a database for orders and stock; they return rows of the schema's tables."""

import re
from collections.abc import Iterable, Sequence
from typing import Any

from sqlalchemy import and_, case, exists, func, or_, select
from sqlalchemy.engine import Engine

from warehouse_layout.message_enums import OrderState
from warehouse_operations.store import schema

MOST_ROWS = 10_000  # in an answer
LONGEST = 1000  # most characters of a search, those of the longest reference
LARGEST = 2**63 - 1  # the largest number that a query may hold


def find_orders(
    engine: Engine,
    order_id: int = 0,
    search: str = "",
    state: int | None = None,
    limit: int = 100,
    offset: int = 0,
    late_at: float | None = None,
) -> tuple[int, list[tuple[Any, list[Any]]]]:
    """Returns the number of matching orders and [(row of orders, rows of its lines)], the newest
    first, limited to MOST_ROWS.

    order_id: 0: any. search: a part of the reference, a whole SKU, or the number of an order; an
    order with that reference or number precedes the others. late_at: only orders that are past
    their due time at this simulated time [s], or were completed after their due time.
    """
    if not (0 <= order_id <= LARGEST and search.isprintable() and len(search) <= LONGEST):
        return 0, []
    orders, lines = schema.orders, schema.order_line
    query = select(orders)
    if order_id:
        query = query.where(orders.c.id == order_id)
    if state is not None:
        query = query.where(orders.c.state == state)
    if late_at is not None:
        query = query.where(_late(orders.c, late_at))
    if search:
        with_sku = exists().where(lines.c.order_id == orders.c.id, lines.c.sku == search)
        part = orders.c.reference.contains(search, autoescape=True)
        named = _is_named(orders.c, search)
        query = query.where(or_(part, with_sku, named)).order_by(case((named, 0), else_=1))
    with engine.connect() as connection:
        matches = query.order_by(None).subquery()
        total: Any = connection.execute(select(func.count()).select_from(matches)).scalar()
        newest = _page(query.order_by(orders.c.id.desc()), limit, offset)
        rows: Sequence[Any] = connection.execute(newest).all()
        of_them = select(lines).where(lines.c.order_id.in_([row.id for row in rows]))
        by_order: dict[int, list[Any]] = {row.id: [] for row in rows}
        matching_lines: Any = connection.execute(of_them.order_by(lines.c.order_id, lines.c.number))
        for line in matching_lines:
            by_order[line.order_id].append(line)
    return total, [(row, by_order[row.id]) for row in rows]


def order_events(engine: Engine, order_id: int, limit: int) -> list[Any]:
    """Returns the first rows of the table event of an order, the oldest first."""
    if not 0 < order_id <= LARGEST:
        return []
    event = schema.event
    query = select(event).where(event.c.order_id == order_id).order_by(event.c.id).limit(limit)
    with engine.connect() as connection:
        return list(connection.execute(query).all())


def _is_named(order: Any, text: str) -> Any:
    """Returns whether a text is the reference or the number of an order."""
    is_reference = func.lower(order.reference) == text.lower()
    is_number = text.isascii() and text.isdecimal() and int(text) <= LARGEST
    return or_(is_reference, order.id == int(text)) if is_number else is_reference


def _page(query: Any, limit: int, offset: int) -> Any:
    return query.limit(min(max(limit, 0), MOST_ROWS)).offset(min(max(offset, 0), LARGEST))


def _late(order: Any, now: float) -> Any:
    waits = order.state.in_((int(OrderState.OPEN), int(OrderState.ASSIGNED)))
    return and_(order.due > 0, or_(order.completed > order.due, and_(waits, order.due < now)))


def find_stock(
    engine: Engine, sku: str = "", limit: int = 100, offset: int = 0
) -> tuple[int, int, list[Any]]:
    """Returns the number of matching bins, the pieces in all of them and their rows, the fullest
    first, limited to MOST_ROWS. sku: "": any."""
    if not sku.isprintable():
        return 0, 0, []
    bins = schema.bin_
    query = select(bins).where(bins.c.capacity > 0)
    if sku:
        query = query.where(bins.c.sku == sku, bins.c.quantity > 0)
    with engine.connect() as connection:
        matches = query.subquery()
        counts = select(func.count(), func.coalesce(func.sum(matches.c.quantity), 0))
        total, pieces = connection.execute(counts.select_from(matches)).one()
        fullest = query.order_by(bins.c.quantity.desc(), bins.c.id)
        return total, pieces, connection.execute(_page(fullest, limit, offset)).all()


def matching(names: Iterable[str], search: str) -> list[str]:
    """Returns the names that contain a text, first those that begin with it, in natural order."""
    text = search.casefold()
    matches = [name for name in names if text in name.casefold()]
    return sorted(matches, key=lambda name: (not name.casefold().startswith(text), _natural(name)))


def _natural(name: str) -> list[tuple[int, str]]:
    """Returns a key that sorts names with numbers as people do."""
    return [
        (int(part), "") if part.isdecimal() else (-1, part)
        for part in re.split(r"(\d+)", name.casefold())
    ]
