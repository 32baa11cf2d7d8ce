# SPDX-License-Identifier: Apache-2.0
"""A warehouse as a database has it: what a shift goes on with after it ended or was killed."""

from dataclasses import dataclass

import numpy as np
from sqlalchemy import func, select

from warehouse_fleet.operations import schema
from warehouse_fleet.operations.assortment import Assortment
from warehouse_fleet.operations.inventory import Bin
from warehouse_fleet.operations.orders import Order, OrderState


@dataclass(frozen=True)
class Stored:
    """Nothing of it is promised or under way: units stand, orders wait."""

    assortment: Assortment
    bins: list
    orders: list  # those that are not over; their times are those of a run that begins at `now`
    last_order: int  # the highest id there was
    blocked: set  # units out of service


def read(engine, now=0.0):
    """The Stored of a database; None if no warehouse is in it.

    now: the simulated time at which the next run begins [s].
    """
    with engine.connect() as connection:
        skus = connection.execute(select(schema.sku).order_by(schema.sku.c.number)).all()
        if not skus:
            return None
        assortment = Assortment(
            tuple(row.sku for row in skus), np.array([row.popularity for row in skus])
        )
        last = connection.execute(select(func.max(schema.orders.c.id))).scalar() or 0
        units = connection.execute(select(schema.unit.c.id).where(schema.unit.c.in_service == 0))
        return Stored(
            assortment, _bins(connection), _orders(connection, now), last, set(units.scalars())
        )


def transports_left(engine):
    """(ids, last): transports that a run which was killed had open, and the last that is known of
    it; None if it has asked for none."""
    visit = schema.visit.c
    last = select(visit.transport_id).order_by(visit.id.desc()).limit(1)
    with engine.connect() as connection:
        still_open = select(visit.transport_id).where(visit.ended.is_(None))
        return set(connection.execute(still_open).scalars()), connection.execute(last).scalar()


def _bins(connection):
    result = []
    for row in connection.execute(select(schema.bin_).order_by(schema.bin_.c.id)):
        one = Bin(row.id, row.item, row.unit, row.capacity, row.sku)
        one.quantity = row.quantity
        result.append(one)
    return result


def _orders(connection, now):
    later = _shifts(connection, now)
    table, lines = schema.orders, {}
    is_open = table.c.state.in_((int(OrderState.OPEN), int(OrderState.ASSIGNED)))
    query = select(schema.order_line).join(table).where(is_open)
    for row in connection.execute(query.order_by(schema.order_line.c.number)):
        lines.setdefault(row.order_id, []).append(row)
    result = []
    for row in connection.execute(select(table).where(is_open).order_by(table.c.id)):
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
    """What is added to a time of each run to make it one of a run that begins at `now`."""
    rows = connection.execute(select(schema.run).order_by(schema.run.c.id.desc()))
    result, begins, by = {}, now, 0.0
    for row in rows:
        by += begins - row.simulated_s
        result[row.id] = by
        begins = row.began_s
    return result
