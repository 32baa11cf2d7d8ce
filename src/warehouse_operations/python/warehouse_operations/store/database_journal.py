# SPDX-License-Identifier: Apache-2.0
"""The journal that keeps a shift in a database."""

import json
from collections.abc import Collection, Iterable
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import func, select, update

from warehouse_layout.message_enums import OrderEventKind, OrderState
from warehouse_operations.shift.journal import Journal
from warehouse_operations.shift.task_reports import Answer, Report
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.inventory import Bin, Reason
from warehouse_operations.stock.orders import Line, Order
from warehouse_operations.stock.stations import Visit
from warehouse_operations.stock.stored_warehouse import Stored
from warehouse_operations.store import schema
from warehouse_operations.store.rows import Rows


class DatabaseJournal(Journal):
    """Keeps a shift in a Database."""

    def __init__(
        self,
        database: Any,
        *,
        seed: int,
        orders: str,
        policies: dict[str, Any],
        site: str,
        layout: Any,
        now: float = 0.0,
    ) -> None:
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
                    schema.report,
                )
            }
            self._heat_slots = set(connection.execute(select(schema.heat.c.slot)).scalars())
            self._bins = set(connection.execute(select(schema.bin_.c.id)).scalars())
            self._units = set(connection.execute(select(schema.unit.c.id)).scalars())
        self.run_id = self._id(schema.run)
        self._first_visit = self._next[schema.visit] - 1
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

    def begin(self, assortment: Assortment, bins: Collection[Bin]) -> None:
        """Writes a new warehouse: its SKUs, units and bins, still empty."""
        shares = zip(assortment.skus, assortment.popularity)
        for number, (sku, share) in enumerate(shares, 1):
            self._rows.insert(schema.sku, sku, number=number, popularity=float(share))
        self.take_in(bins)

    def take_in(self, bins: Iterable[Bin], moved: Iterable[Bin] = ()) -> None:
        """Writes new bins, still empty, and those on another unit than before."""
        for unit in dict.fromkeys(bin_.unit for bin_ in (*bins, *moved)):
            if unit not in self._units:
                self._units.add(unit)
                self._rows.insert(schema.unit, unit, in_service=1)
        for bin_ in bins:
            put = self._rows.update if bin_.bin_id in self._bins else self._rows.insert
            put(
                schema.bin_,
                bin_.bin_id,
                item=bin_.item,
                unit=bin_.unit,
                sku=bin_.sku,
                quantity=0,
                reserved=0,
                capacity=bin_.capacity,
            )
        for bin_ in moved:
            self._rows.update(schema.bin_, bin_.bin_id, unit=bin_.unit)

    def gone(self, bins: Iterable[Bin]) -> None:
        """Writes the removal of bins that have left the warehouse and were written off."""
        for bin_ in bins:
            self._rows.update(schema.bin_, bin_.bin_id, capacity=0)

    def resume(self, stored: Stored) -> None:
        """Ends the open visits, assignments and promises of an earlier run. This run takes over the
        orders of a Stored warehouse, with their times."""
        with self._database.engine.begin() as connection:
            self._rows.write(connection)  # the row of this run
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

    def move(
        self,
        now: float,
        bin_: Bin,
        quantity: int,
        reason: Reason,
        line: Line | None,
        station: str,
        visit: Visit | None,
    ) -> None:
        """Writes pieces that went into a Bin, or out of it if negative."""
        self._rows.insert(
            schema.move,
            self._id(schema.move),
            run=self.run_id,
            stamp=now,
            bin=bin_.bin_id,
            sku=bin_.sku,
            quantity=quantity,
            reason=reason.value,
            order_id=line.order.order_id if line else None,
            line=line.number if line else None,
            visit=visit.visit_id + self._first_visit if visit else None,
        )
        if visit:
            pieces = -abs(quantity) if reason == Reason.UNDONE else abs(quantity)
            self.visit(visit, pieces=visit.pieces + pieces)

    def order(self, order: Order) -> None:
        """Writes a new Order, or the new state of a known one."""
        values = {
            "state": int(order.state),
            "station": order.station,
            "completed": order.completed or None,
            "due": order.due,
            "priority": order.priority,
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

    def line(self, line: Line) -> None:
        """Writes how many pieces of an order's Line are picked."""
        self._rows.update(schema.order_line, (line.order.order_id, line.number), picked=line.picked)

    def assigned(self, order: Order) -> None:
        """Writes the assignment of an Order to its station."""
        order.assignment = self._id(schema.assignment)
        self._rows.insert(
            schema.assignment,
            order.assignment,
            run=self.run_id,
            order_id=order.order_id,
            station=order.station,
            stamp=order.assigned,
            ended=None,
        )
        self.order(order)

    def unassigned(self, order: Order, now: float) -> None:
        """Writes that a station gave an Order back unfinished."""
        self._rows.update(schema.assignment, order.assignment, ended=now)
        self.order(order)

    def visit(self, visit: Visit, pieces: int | None = None) -> None:
        """Writes a new Visit, or the new state of a known one."""
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

    def event(
        self,
        now: float,
        kind: OrderEventKind,
        order_id: int,
        sku: str,
        quantity: int,
        station: str,
        unit: int,
        text: str,
    ) -> None:
        """Writes an event of an order."""
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

    def report(self, now: float, report: Report, answer: Answer) -> None:
        """Writes a person's Report that has an id, and the Answer that it got."""
        self._rows.insert(
            schema.report,
            self._id(schema.report),
            run=self.run_id,
            stamp=now,
            code=report.id,
            station=report.station,
            order_id=report.order_id,
            item=report.item,
            sequence=report.sequence,
            quantity=report.quantity,
            outcome=int(report.outcome),
            done=answer.quantity,
            message=answer.message,
        )

    def heat(self, slot: int, began: float, maps: bytes) -> None:
        """Writes a part of the FloorHeat, in place of the one in that slot."""
        put = self._rows.update if slot in self._heat_slots else self._rows.insert
        self._heat_slots.add(slot)
        put(schema.heat, slot, run=self.run_id, began_s=began, maps=maps)

    def commit(self, now: float, bins: Collection[Bin]) -> None:
        """Passes all rows since the last call to the database as one commit."""
        for bin_ in sorted(bins, key=lambda bin_: bin_.bin_id):
            values = {"sku": bin_.sku, "quantity": bin_.quantity, "reserved": bin_.reserved}
            self._rows.update(schema.bin_, bin_.bin_id, **values)
        if self._rows:
            self._rows.update(schema.run, self.run_id, simulated_s=now)
            self._database.put(self._rows)
            self._rows = Rows()

    def flush(self) -> None:
        """Waits until all commits are in the database."""
        self._database.flush()

    def end(self, now: float, bins: Collection[Bin], figures: dict[str, Any]) -> None:
        """Writes the end of the run, with its figures."""
        self._rows.update(schema.run, self.run_id, ended=_now(), kpis=json.dumps(figures))
        self.commit(now, bins)

    def _id(self, table: Any) -> int:
        key = self._next[table]
        self._next[table] = key + 1
        return key


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
