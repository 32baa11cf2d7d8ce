# SPDX-License-Identifier: Apache-2.0
"""A warehouse as a database has it: what a shift goes on with after it ended or was killed."""

import json
from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from sqlalchemy import func, select

from warehouse_operations import schema
from warehouse_operations.assortment import Assortment
from warehouse_operations.inventory import Bin, Reason
from warehouse_operations.kpis import INTERVAL
from warehouse_operations.message_enums import OrderState
from warehouse_operations.orders import Order


@dataclass(frozen=True)
class Stored:
    """Nothing of it is promised or under way: units stand, orders wait."""

    assortment: Assortment
    bins: list
    former: dict  # ids of bins that are gone, by item
    last_bin: int  # the highest id there was
    orders: list  # those that are not over; their times are those of a run that begins at `now`
    last_order: int  # the highest id there was
    blocked: set  # units out of service
    layout: list | None  # as returning.layout_of told it to the last run; None: an older version's


def read(engine, now=0.0):
    """The Stored of a database; None if no warehouse is in it.

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
        units = connection.execute(select(schema.unit.c.id).where(schema.unit.c.in_service == 0))
        return Stored(
            assortment,
            *_bins(connection, assortment.skus),
            _orders(connection, now),
            last,
            set(units.scalars()),
            _layout(connection),
        )


def _layout(connection):
    run = schema.run.c
    query = select(run.layout).where(run.layout.is_not(None)).order_by(run.id.desc()).limit(1)
    found = connection.execute(query).scalar()
    return None if found is None else json.loads(found)


def transports_left(engine):
    """(ids, last): transports that a run which was killed had open, and the last that is known of
    it; None if it has asked for none."""
    visit = schema.visit.c
    last = select(visit.transport_id).order_by(visit.id.desc()).limit(1)
    with engine.connect() as connection:
        still_open = select(visit.transport_id).where(visit.ended.is_(None))
        return set(connection.execute(still_open).scalars()), connection.execute(last).scalar()


def throughput(engine, now, since):
    """(begin, picked, stored, completed) of the runs before one that begins at `now`: their first
    moment, and how many in each kpis.INTERVAL from `since` on, by its number, as kpis.Tally counts
    them. Times are that run's [s]."""
    move, order, begin = schema.move.c, schema.orders.c, now
    counts = [defaultdict(int) for _ in range(3)]
    with engine.connect() as connection:
        later = _shifts(connection, now)
        for run in connection.execute(select(schema.run)):
            by = later[run.id]
            if run.simulated_s + by <= since:
                continue
            begin = min(begin, max(run.began_s + by, since))
            queries = [
                select(move.stamp, func.abs(move.quantity))
                .where(move.run == run.id, move.reason == reason.value)
                .where(move.stamp >= since - by)
                for reason in (Reason.PICK, Reason.PUT)
            ]
            queries.append(
                select(order.completed, 1)
                .where(order.run == run.id)
                .where(order.state == int(OrderState.COMPLETED), order.completed >= since - by)
            )
            for query, count in zip(queries, counts):
                for stamp, number in connection.execute(query):
                    count[int((stamp + by) // INTERVAL)] += number
    return begin, *counts


def heat(engine, now):
    """[(when it began, by the time of a run that begins at `now` [s], the maps as bytes)]: what was
    kept of the FloorHeat."""
    with engine.connect() as connection:
        later = _shifts(connection, now)
        rows = connection.execute(select(schema.heat)).all()
    kept = [(row.began_s + later[row.run], row.maps) for row in rows]
    return [(began, maps) for began, maps in kept if began >= 0]


def _rows(connection, table, query):
    """Those of a query on a table; raises ValueError for what is not of a column's type, as SQLite
    lets it be."""
    rows = connection.execute(query).all()
    kinds = [(column.name, column.type.python_type, column.nullable) for column in table.c]
    for row in rows:
        for name, kind, nullable in kinds:
            value = getattr(row, name)
            fits = isinstance(value, (int, float) if kind is float else kind)
            if not (fits or (nullable and value is None)):
                raise ValueError(f"{value!r:.80} is the {name} of a row of table '{table.name}'")
    return rows


def _bins(connection, skus):
    """(bins, former, last) of a Stored."""
    skus = set(skus)
    result, former, last, fallen = [], {}, 0, _fallen(connection)
    for row in _rows(connection, schema.bin_, select(schema.bin_).order_by(schema.bin_.c.id)):
        last = row.id
        if row.sku not in skus or not 0 <= row.quantity <= row.capacity:
            raise ValueError(f"bin {row.id} holds {row.quantity} pieces of {row.sku}")
        if not row.capacity:
            former[row.item] = row.id
            continue
        one = Bin(row.id, row.item, row.unit, row.capacity, row.sku)
        one.quantity, one.fallen = row.quantity, fallen.get(row.id)
        result.append(one)
    return result, former, last


def _fallen(connection):
    """The pieces that lie on the floor with their bins, by bin."""
    move = schema.move.c
    pieces = func.sum(move.quantity)
    query = select(move.bin, pieces).where(move.reason.in_((Reason.FELL, Reason.PICKED_UP)))
    return {one: -n for one, n in connection.execute(query.group_by(move.bin).having(pieces < 0))}


def _orders(connection, now):
    later = _shifts(connection, now)
    table, lines = schema.orders, {}
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


def _shifts(connection, now):
    """What is added to a time of each run to make it one of a run that begins at `now`: nothing if
    simulated time has gone on; where it began again, or went back, the next run follows at once."""
    rows = connection.execute(select(schema.run).order_by(schema.run.c.id.desc()))
    result, begins, by = {}, now, 0.0
    for row in rows:
        by += min(0.0, begins - row.simulated_s)
        result[row.id] = by
        begins = row.began_s
    return result
