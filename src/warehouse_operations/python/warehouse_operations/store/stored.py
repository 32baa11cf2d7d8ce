# SPDX-License-Identifier: Apache-2.0
"""A warehouse as its database holds it: the start of a shift after the last one ended or was
killed."""

import json
from collections import defaultdict
from collections.abc import Iterable
from typing import Any

import numpy as np
from sqlalchemy import Table, and_, func, or_, select
from sqlalchemy.engine import Connection, Engine

from warehouse_layout.message_enums import OrderState, PickOutcome
from warehouse_operations.shift.tally import INTERVAL
from warehouse_operations.shift.task_reports import Answer, Report
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.inventory import Bin, Reason
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.stored_warehouse import Stored
from warehouse_operations.store import schema


def read(engine: Engine, now: float = 0.0) -> Stored | None:
    """Reads the warehouse of a database; None where it holds no warehouse.

    now: the simulated time at which the next run begins [s].
    """
    with engine.connect() as connection:
        skus = _rows(connection, schema.sku, select(schema.sku).order_by(schema.sku.c.number))
        if not skus:
            return None
        assortment = Assortment(
            tuple(row.sku for row in skus), np.array([row.popularity for row in skus])
        )
        last = connection.execute(select(func.max(schema.orders.c.id))).scalar() or 0
        return Stored(
            assortment,
            *_bins(connection, assortment.skus),
            _orders(connection, now),
            last,
            _layout(connection),
        )


def _layout(connection: Connection) -> list[Any] | None:
    run = schema.run.c
    query = select(run.layout).where(run.layout.is_not(None)).order_by(run.id.desc()).limit(1)
    layout = connection.execute(query).scalar()
    return None if layout is None else json.loads(layout)


def transports_left(engine: Engine) -> tuple[set[int], int | None]:
    """Returns (ids, last): the transports that a killed run left open, and the last one that it is
    known to have requested, or None."""
    visit = schema.visit.c
    last = select(visit.transport_id).order_by(visit.id.desc()).limit(1)
    with engine.connect() as connection:
        still_open = select(visit.transport_id).where(visit.ended.is_(None))
        return set(connection.execute(still_open).scalars()), connection.execute(last).scalar()


def throughput(
    engine: Engine, now: float, since: float
) -> tuple[float, dict[int, int], dict[int, int], dict[int, int]]:
    """Returns (begin, picked, stored, completed) of the runs before one that begins at `now`.

    begin: of the first run. The counts are those of tally.Tally by number of the INTERVAL, from
    `since` on. Times are those of the run that begins [s]."""
    move, order, begin = schema.move.c, schema.orders.c, now
    picked: dict[int, int] = defaultdict(int)
    stored: dict[int, int] = defaultdict(int)
    completed: dict[int, int] = defaultdict(int)
    # A piece that was taken back counts negative, at the time of that.
    of_line, undone = move.order_id.is_not(None), move.reason == Reason.UNDONE.value
    taken_out = and_(undone, move.visit.is_not(None), ~of_line)
    done = (
        (-move.quantity, or_(move.reason == Reason.PICK.value, and_(undone, of_line))),
        (move.quantity, or_(move.reason == Reason.PUT.value, taken_out)),
    )
    with engine.connect() as connection:
        later = _shifts(connection, now)
        for run in connection.execute(select(schema.run)):
            by = later[run.id]
            if run.simulated_s + by <= since:
                continue
            begin = min(begin, max(run.began_s + by, since))
            queries = [
                select(move.stamp, pieces).where(
                    move.run == run.id, of_stations, move.stamp >= since - by
                )
                for pieces, of_stations in done
            ]
            queries.append(
                select(order.completed, 1)
                .where(order.run == run.id)
                .where(order.state == int(OrderState.COMPLETED), order.completed >= since - by)
            )
            for query, count in zip(queries, (picked, stored, completed)):
                for stamp, number in connection.execute(query):
                    count[int((stamp + by) // INTERVAL)] += number
    return begin, picked, stored, completed


def reports(engine: Engine, most: int) -> list[tuple[Report, Answer]]:
    """Returns the last reports of people that had ids, the oldest first."""
    rows = select(schema.report).order_by(schema.report.c.id.desc()).limit(most)
    with engine.connect() as connection:
        newest = list(connection.execute(rows))
    return [(_report(row), Answer(True, row.message, row.done)) for row in reversed(newest)]


def _report(row: Any) -> Report:
    named = row.station, row.order_id, row.item, row.sequence
    return Report(*named, row.quantity, PickOutcome(row.outcome), row.code)


def heat(engine: Engine, now: float) -> list[tuple[float, bytes]]:
    """Returns the stored FloorHeat: pairs (begin, maps as bytes).

    begin: in the time of a run that begins at `now` [s]."""
    with engine.connect() as connection:
        later = _shifts(connection, now)
        rows: list[Any] = connection.execute(select(schema.heat)).all()
    kept = [(row.began_s + later[row.run], row.maps) for row in rows]
    return [(began, maps) for began, maps in kept if began >= 0]


def _rows(connection: Connection, table: Table, query: Any) -> list[Any]:
    """Returns the rows of a query on a table. Raises ValueError for a value of another type than
    its column's, as SQLite allows."""
    rows = connection.execute(query).all()
    kinds = [(column.name, column.type.python_type, column.nullable) for column in table.c]
    for row in rows:
        for name, kind, nullable in kinds:
            value = getattr(row, name)
            fits = isinstance(value, (int, float) if kind is float else kind)
            if not (fits or (nullable and value is None)):
                raise ValueError(f"{value!r:.80} is the {name} of a row of table '{table.name}'")
    return rows


def _bins(connection: Connection, skus: Iterable[str]) -> tuple[list[Bin], dict[str, int], int]:
    """Returns (bins, former, last) of a Stored."""
    skus = set(skus)
    result, former, last, fallen = [], {}, 0, _fallen(connection)
    for row in _rows(connection, schema.bin_, select(schema.bin_).order_by(schema.bin_.c.id)):
        last = row.id
        if row.sku not in skus or not 0 <= row.quantity <= row.capacity:
            raise ValueError(f"bin {row.id} holds {row.quantity} pieces of {row.sku}")
        if not row.capacity:
            former[row.item] = row.id
            continue
        bin_ = Bin(row.id, row.item, row.unit, row.capacity, row.sku)
        bin_.quantity, bin_.fallen = row.quantity, fallen.get(row.id)
        result.append(bin_)
    return result, former, last


def _fallen(connection: Connection) -> dict[int, int]:
    """Returns the pieces that lie on the floor with their bins, by bin."""
    move = schema.move.c
    pieces = func.sum(move.quantity)
    query = select(move.bin, pieces).where(move.reason.in_((Reason.FELL, Reason.PICKED_UP)))
    return {
        bin_id: -n for bin_id, n in connection.execute(query.group_by(move.bin).having(pieces < 0))
    }


def _orders(connection: Connection, now: float) -> list[Order]:
    later = _shifts(connection, now)
    table = schema.orders
    lines: dict[int, list[Any]] = {}
    is_open = table.c.state.in_((int(OrderState.OPEN), int(OrderState.ASSIGNED)))
    query = select(schema.order_line).join(table).where(is_open)
    for row in _rows(connection, schema.order_line, query.order_by(schema.order_line.c.number)):
        lines.setdefault(row.order_id, []).append(row)
    result = []
    for row in _rows(connection, table, select(table).where(is_open).order_by(table.c.id)):
        asked = [(line.sku, line.quantity) for line in lines[row.id]]
        by = later[row.run]
        due = row.due + by if row.due else 0.0
        order = Order(row.id, asked, row.created + by, due, row.priority, row.reference)
        for line, stored in zip(order.lines, lines[row.id]):
            line.picked = stored.picked
        order.stored = True
        result.append(order)
    return result


def _shifts(connection: Connection, now: float) -> dict[int, float]:
    """Returns, by run, the offset from its times to those of a run that begins at `now` [s]. The
    offset is 0 if simulated time went on; if it began again or went back, the next run follows at
    once.
    """
    rows = connection.execute(select(schema.run).order_by(schema.run.c.id.desc()))
    result, begins, by = {}, now, 0.0
    for row in rows:
        by += min(0.0, begins - row.simulated_s)
        result[row.id] = by
        begins = row.began_s
    return result
