# SPDX-License-Identifier: Apache-2.0
"""The journal that keeps a shift in a database."""

import json
from datetime import UTC, datetime

from sqlalchemy import func, select, update

from warehouse_operations import schema
from warehouse_operations.journal import Journal
from warehouse_operations.message_enums import OrderState
from warehouse_operations.rows import Rows


class DatabaseJournal(Journal):
    """Keeps a shift in a Database."""

    def __init__(self, database, *, seed, orders, policies, site, layout, now=0.0):
        self._database, self._rows = database, Rows()
        with database.engine.connect() as connection:
            self._next = {
                table: (connection.execute(select(func.max(table.c.id))).scalar() or 0) + 1
                for table in (
                    schema.run,
                    schema.assignment,
                    schema.visit,
                    schema.move,
                    schema.event,
                )
            }
            self._heat_slots = set(connection.execute(select(schema.heat.c.slot)).scalars())
            self._bins = set(connection.execute(select(schema.bin_.c.id)).scalars())
            self._units = set(connection.execute(select(schema.unit.c.id)).scalars())
        self.run_id = self._id(schema.run)
        self._first_visit = self._next[schema.visit] - 1
        self._assignments = {}
        self._rows.insert(
            schema.run,
            self.run_id,
            began=_now(),
            ended=None,
            site=site,
            layout=json.dumps(layout),
            seed=seed,
            orders=orders,
            policies=json.dumps(policies),
            began_s=now,
            simulated_s=now,
            kpis=None,
        )

    def begin(self, shift):
        """Writes down a new warehouse: its SKUs, units and bins, still empty."""
        shares = zip(shift.assortment.skus, shift.assortment.popularity)
        for number, (sku, share) in enumerate(shares, 1):
            self._rows.insert(schema.sku, sku, number=number, popularity=float(share))
        self.take_in(shift.inventory.bins.values())

    def take_in(self, bins, moved=()):
        """Writes down bins that are new, still empty, and those that are on another unit now."""
        for unit in dict.fromkeys(one.unit for one in (*bins, *moved)):
            if unit not in self._units:
                self._units.add(unit)
                self._rows.insert(schema.unit, unit, in_service=1)
        for one in bins:
            put = self._rows.update if one.bin_id in self._bins else self._rows.insert
            put(
                schema.bin_,
                one.bin_id,
                item=one.item,
                unit=one.unit,
                sku=one.sku,
                quantity=0,
                reserved=0,
                capacity=one.capacity,
            )
        for one in moved:
            self._rows.update(schema.bin_, one.bin_id, unit=one.unit)

    def gone(self, bins):
        """Bins that are not in the warehouse any more, and were written off."""
        for one in bins:
            self._rows.update(schema.bin_, one.bin_id, capacity=0)

    def resume(self, stored):
        """What an earlier run left under way has ended: its visits, assignments and promises. The
        orders of a Stored warehouse are this run's from now on, and so are their times."""
        with self._database.engine.begin() as connection:
            self._rows.write(connection)  # with this run
            self._rows = Rows()
            connection.execute(
                update(schema.visit)
                .where(schema.visit.c.ended.is_(None))
                .values(ended=schema.visit.c.requested, outcome="interrupted")
            )
            connection.execute(
                update(schema.assignment)
                .where(schema.assignment.c.ended.is_(None))
                .where(
                    schema.assignment.c.order_id.in_(
                        select(schema.orders.c.id).where(
                            schema.orders.c.state == int(OrderState.ASSIGNED)
                        )
                    )
                )
                .values(ended=schema.assignment.c.stamp)
            )
            connection.execute(update(schema.bin_).values(reserved=0))
            rows = Rows()
            for order in stored.orders:
                rows.update(
                    schema.orders,
                    order.order_id,
                    run=self.run_id,
                    created=order.created,
                    due=order.due,
                    state=int(OrderState.OPEN),
                    station="",
                )
            rows.write(connection)

    def move(self, now, one, quantity, reason, line, station, visit):
        self._rows.insert(
            schema.move,
            self._id(schema.move),
            run=self.run_id,
            stamp=now,
            bin=one.bin_id,
            sku=one.sku,
            quantity=quantity,
            reason=reason.value,
            order_id=line.order.order_id if line else None,
            line=line.number if line else None,
            visit=visit.visit_id + self._first_visit if visit else None,
        )
        if visit:
            self.visit(visit, pieces=visit.pieces + abs(quantity))

    def order(self, order):
        values = {
            "state": int(order.state),
            "station": order.station,
            "completed": order.completed or None,
        }
        if order.stored:
            self._rows.update(schema.orders, order.order_id, **values)
            return
        order.stored = True
        self._rows.insert(
            schema.orders,
            order.order_id,
            run=self.run_id,
            reference=order.reference,
            created=order.created,
            due=order.due,
            priority=order.priority,
            **values,
        )
        for line in order.lines:
            self._rows.insert(
                schema.order_line,
                (order.order_id, line.number),
                sku=line.sku,
                quantity=line.quantity,
                picked=line.picked,
            )

    def line(self, line):
        self._rows.update(schema.order_line, (line.order.order_id, line.number), picked=line.picked)

    def assigned(self, order):
        key = self._assignments[order.order_id] = self._id(schema.assignment)
        self._rows.insert(
            schema.assignment,
            key,
            run=self.run_id,
            order_id=order.order_id,
            station=order.station,
            stamp=order.assigned,
            ended=None,
        )
        self.order(order)

    def unassigned(self, order, now):
        self._rows.update(schema.assignment, self._assignments.pop(order.order_id), ended=now)
        self.order(order)

    def visit(self, visit, pieces=None):
        key = visit.visit_id + self._first_visit
        values = {
            "lifted": visit.lifted,
            "arrived": visit.arrived,
            "released": visit.released,
            "ended": visit.ended,
            "outcome": visit.outcome,
            "pieces": visit.pieces if pieces is None else pieces,
        }
        if visit.stored:
            self._rows.update(schema.visit, key, **values)
            return
        visit.stored = True
        self._rows.insert(
            schema.visit,
            key,
            run=self.run_id,
            transport_id=visit.transport_id,
            unit=visit.unit,
            station=visit.station.name,
            requested=visit.requested,
            **values,
        )

    def unit(self, unit, in_service):
        self._rows.update(schema.unit, unit, in_service=int(in_service))

    def event(self, now, kind, order_id, sku, quantity, station, unit, text):
        self._rows.insert(
            schema.event,
            self._id(schema.event),
            run=self.run_id,
            stamp=now,
            kind=int(kind),
            order_id=order_id,
            sku=sku,
            quantity=quantity,
            station=station,
            shelf_id=unit,
            text=text,
        )

    def heat(self, slot, began, maps):
        """A part of the FloorHeat, in place of what was in that slot; `maps` as bytes."""
        put = self._rows.update if slot in self._heat_slots else self._rows.insert
        self._heat_slots.add(slot)
        put(schema.heat, slot, run=self.run_id, began_s=began, maps=maps)

    def commit(self, shift):
        changed = shift.inventory.changed
        for one in sorted(changed, key=lambda one: one.bin_id):
            self._rows.update(
                schema.bin_, one.bin_id, sku=one.sku, quantity=one.quantity, reserved=one.reserved
            )
        changed.clear()
        if self._rows:
            self._rows.update(schema.run, self.run_id, simulated_s=shift.now)
            self._database.put(self._rows)
            self._rows = Rows()

    def flush(self):
        """Waits until everything that was committed is in the database."""
        self._database.flush()

    def end(self, shift, figures):
        """The run is over; its figures are kept with it."""
        self._rows.update(schema.run, self.run_id, ended=_now(), kpis=json.dumps(figures))
        self.commit(shift)

    def _id(self, table):
        key = self._next[table]
        self._next[table] = key + 1
        return key


def _now():
    return datetime.now(UTC).isoformat(timespec="milliseconds")
