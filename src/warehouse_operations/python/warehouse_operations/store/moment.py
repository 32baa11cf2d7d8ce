# SPDX-License-Identifier: Apache-2.0
"""A warehouse as it was at a time of a run, read from its database, which may be in use."""

import json
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import and_, func, or_, select
from sqlalchemy.engine import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from warehouse_layout.message_enums import OrderEventKind
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.inventory import Bin, Reason
from warehouse_operations.stock.order_file import OrderDraft
from warehouse_operations.stock.orders import Order
from warehouse_operations.store import schema
from warehouse_operations.store.engines import DatabaseError, make_engine, path_of, reason, shown


@dataclass(frozen=True)
class VisitThen:
    """A visit under way; times are simulated [s], None: not yet. replenishes: brought for
    bundles."""

    visit_id: int
    transport_id: int
    unit: int
    station: str
    requested: float
    lifted: float | None
    arrived: float | None
    released: float | None
    pieces: int
    replenishes: bool


@dataclass(frozen=True)
class Moment:
    """A warehouse at a time of a run [s].

    began: begin of the run. last: its latest time. site, orders, policies, seed: of the run.
    assigned: the station of each order that has one, by order. ways: mean times of visits so far
    [s]: from the request to the lift, on to the station, and back. ways_back: all of the latter.
    recent: the orders that came lately, at their times.
    """

    time: float
    began: float
    last: float
    site: str
    orders_text: str
    policies: dict[str, Any]
    assortment: Assortment
    bins: list[Bin]
    orders: list[Order]
    last_order: int
    assigned: dict[int, str]
    visits: list[VisitThen]
    ways: tuple[float, float, float]
    ways_back: tuple[float, ...]
    layout: list[Any] | None
    recent: tuple[OrderDraft, ...]


RECENT = 2 * 3600.0  # of the past, whose orders are those to come [s]
USUAL = (20.0, 30.0, 30.0)  # ways before there was a visit [s]


def read(url: Any, at: float | None = None) -> Moment:
    """Reads the last run of a database at a time [s]; None: its latest. Raises DatabaseError."""
    engine = make_engine(url)
    path = path_of(engine)
    if path and not Path(path).is_file():
        raise DatabaseError(f"{shown(url)}: there is no such file")
    try:
        with engine.connect() as connection:
            check_version(connection, url)
            return _moment(connection, url, at)
    except SQLAlchemyError as error:
        raise DatabaseError(f"{shown(url)}: {reason(error)}") from error
    finally:
        engine.dispose()


def check_version(connection: Connection, url: Any) -> None:
    """Raises DatabaseError for a database without a warehouse, or of another version."""
    try:
        version = connection.execute(select(schema.schema_version.c.version)).scalar()
    except SQLAlchemyError as error:
        raise DatabaseError(f"{shown(url)}: there is no warehouse in it") from error
    if version != schema.VERSION:
        raise DatabaseError(
            f"{shown(url)}: the database is of schema version {version}; {schema.VERSION} was "
            "expected (a shift that goes on in an older one brings it up to date)"
        )


def _moment(connection: Connection, url: Any, at: float | None) -> Moment:
    run = connection.execute(select(schema.run).order_by(schema.run.c.id.desc()).limit(1)).first()
    if run is None:
        raise DatabaseError(f"{shown(url)}: no shift was run in it")
    time = run.simulated_s if at is None else at
    if not run.began_s <= time <= run.simulated_s:
        raise DatabaseError(
            f"{shown(url)}: at is {time:g} s; the last shift went from {run.began_s:g} s to "
            f"{run.simulated_s:g} s"
        )
    skus = connection.execute(select(schema.sku).order_by(schema.sku.c.number)).all()
    assortment = Assortment(
        tuple(row.sku for row in skus), np.array([row.popularity for row in skus])
    )
    last = connection.execute(
        select(func.max(schema.orders.c.id)).where(schema.orders.c.run == run.id)
    ).scalar()
    visits = connection.execute(select(schema.visit).where(schema.visit.c.run == run.id)).all()
    orders = _orders(connection, run.id, time)
    return Moment(
        time,
        run.began_s,
        run.simulated_s,
        run.site,
        run.orders,
        json.loads(run.policies),
        assortment,
        _bins(connection, run.id, time),
        orders,
        last or 0,
        _assigned(connection, run.id, time, {order.order_id for order in orders}),
        _under_way(connection, visits, time),
        _ways(visits, time),
        _ways_back(visits, time),
        None if run.layout is None else json.loads(run.layout),
        _recent(connection, run.id, time),
    )


def _before(run: int, time: float) -> Any:
    """Returns the condition on moves until a time of a run [s]."""
    move = schema.move.c
    return or_(move.run < run, and_(move.run == run, move.stamp <= time))


def _bins(connection: Connection, run: int, time: float) -> list[Bin]:
    move = schema.move.c
    sums = select(move.bin, move.sku, func.sum(move.quantity).label("pieces"), func.max(move.id))
    sums = sums.where(_before(run, time)).group_by(move.bin, move.sku)
    held: dict[int, tuple[int, str, int]] = {}  # the last move, SKU and pieces, by bin
    for bin_id, sku, pieces, last in connection.execute(sums):
        if last > held.get(bin_id, (0, "", 0))[0]:
            held[bin_id] = last, sku, int(pieces)
    lies = select(move.bin, func.sum(move.quantity)).where(_before(run, time))
    lies = lies.where(move.reason.in_((Reason.FELL, Reason.PICKED_UP))).group_by(move.bin)
    fallen = {bin_id: -int(pieces) for bin_id, pieces in connection.execute(lies) if pieces < 0}
    out = []
    for row in connection.execute(select(schema.bin_).order_by(schema.bin_.c.id)):
        if not row.capacity:
            continue
        _, sku, pieces = held.get(row.id, (0, row.sku, 0))
        bin_ = Bin(row.id, row.item, row.unit, row.capacity, sku)
        bin_.quantity, bin_.fallen = pieces, fallen.get(row.id)
        out.append(bin_)
    return out


def _orders(connection: Connection, run: int, time: float) -> list[Order]:
    """Returns the orders that were not over, with the pieces picked by then."""
    table, event, move = schema.orders, schema.event.c, schema.move.c
    over = select(event.order_id).where(event.run == run, event.stamp <= time)
    over = over.where(event.kind == int(OrderEventKind.CANCELLED))
    completed = table.c.completed
    query = select(table).where(table.c.run == run, table.c.created <= time)
    query = query.where(or_(completed.is_(None), completed > time), table.c.id.not_in(over))
    rows = connection.execute(query.order_by(table.c.id)).all()
    ids = {row.id for row in rows}
    picked: dict[tuple[int, int], int] = defaultdict(int)
    sums = select(move.order_id, move.line, -func.sum(move.quantity)).where(_before(run, time))
    sums = sums.where(move.order_id.is_not(None)).group_by(move.order_id, move.line)
    for order_id, line, pieces in connection.execute(sums):
        if order_id in ids:
            picked[order_id, line] = int(pieces)
    lines = _lines(connection, ids)
    out = []
    for row in rows:
        asked = [(sku, pieces) for _, sku, pieces in lines[row.id]]
        order = Order(row.id, asked, row.created, row.due, row.priority, row.reference)
        for line in order.lines:
            line.picked = min(max(picked[row.id, line.number], 0), line.quantity)
        out.append(order)
    return out


def _lines(connection: Connection, ids: Iterable[int]) -> dict[int, list[tuple[int, str, int]]]:
    """Returns (number, SKU, pieces) of the lines of orders, by order."""
    line, known = schema.order_line.c, set(ids)
    out: dict[int, list[tuple[int, str, int]]] = defaultdict(list)
    least = min(known, default=0)
    query = select(line.order_id, line.number, line.sku, line.quantity)
    query = query.where(line.order_id >= least).order_by(line.order_id, line.number)
    for order_id, number, sku, pieces in connection.execute(query):
        if order_id in known:
            out[order_id].append((number, sku, pieces))
    return out


def _assigned(connection: Connection, run: int, time: float, ids: set[int]) -> dict[int, str]:
    table = schema.assignment.c
    query = select(table.order_id, table.station).where(table.run == run, table.stamp <= time)
    query = query.where(or_(table.ended.is_(None), table.ended > time)).order_by(table.id)
    return {order_id: name for order_id, name in connection.execute(query) if order_id in ids}


def _under_way(connection: Connection, visits: Iterable[Any], time: float) -> list[VisitThen]:
    move = schema.move.c
    puts = select(move.visit).where(move.visit.is_not(None), move.reason == Reason.PUT.value)
    replenishing = set(connection.execute(puts.distinct()).scalars())

    def by_then(stamp: float | None) -> float | None:
        return stamp if stamp is not None and stamp <= time else None

    return [
        VisitThen(
            row.id,
            row.transport_id,
            row.unit,
            row.station,
            row.requested,
            by_then(row.lifted),
            by_then(row.arrived),
            by_then(row.released),
            row.pieces,
            row.id in replenishing,
        )
        for row in visits
        if row.requested <= time and (row.ended is None or row.ended > time)
    ]


def _ways(visits: Iterable[Any], time: float) -> tuple[float, float, float]:
    over = [row for row in visits if row.ended is not None and row.ended <= time and row.arrived]
    if not over:
        return USUAL
    spans = [
        (row.lifted - row.requested, row.arrived - row.lifted, row.ended - row.released)
        for row in over
        if row.lifted is not None and row.released is not None
    ]
    low, middle, high = np.median(np.array(spans or [USUAL], float), axis=0).tolist()
    return low, middle, high


def _ways_back(visits: Iterable[Any], time: float) -> tuple[float, ...]:
    over = [row for row in visits if row.ended is not None and row.ended <= time]
    return tuple(
        row.ended - row.released
        for row in sorted(over, key=lambda row: row.ended)
        if row.arrived is not None and row.released is not None
    )


def _recent(connection: Connection, run: int, time: float) -> tuple[OrderDraft, ...]:
    table = schema.orders.c
    query = select(table.id, table.created, table.due, table.priority)
    query = query.where(table.run == run, table.created <= time, table.created > time - RECENT)
    rows = connection.execute(query.order_by(table.id)).all()
    lines = _lines(connection, [row.id for row in rows])
    asked = {row.id: tuple((sku, pieces) for _, sku, pieces in lines[row.id]) for row in rows}
    return tuple(OrderDraft(asked[row.id], row.created, row.due, row.priority) for row in rows)


def recent_orders(engine: Engine, time: float) -> tuple[OrderDraft, ...]:
    """Returns the orders that came lately in the last run of a database, at their times [s]."""
    with engine.connect() as connection:
        run = connection.execute(select(func.max(schema.run.c.id))).scalar() or 0
        return _recent(connection, run, time)
