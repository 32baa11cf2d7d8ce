# SPDX-License-Identifier: Apache-2.0
"""What is told of a shift while it goes on: changes, late orders, the heat of the floor."""

import numpy as np
import pytest
from operations_site import site

from warehouse_layout.message_enums import StationMode
from warehouse_operations import Operations
from warehouse_operations.fleets.floor_heat import GAP, SLICES, TRAFFIC, WAITING, WINDOW, FloorHeat
from warehouse_operations.shift.changes import ChangeJournal
from warehouse_operations.store import check
from warehouse_operations.store.database import open_engine
from warehouse_operations.store.queries import find_orders

REPLENISH = "replenish3"


def test_changes_are_those_that_the_database_keeps(tmp_path):
    """A client that takes every change in has what the database has in the end."""
    with Operations(
        site=site(), physics=False, database=tmp_path / "a.db", orders="fill:40"
    ) as ops:
        shift = ops.shift
        changes = shift.journal = ChangeJournal(shift.journal)
        stock = {bin_.item: bin_.quantity for bin_ in shift.inventory.bins.values()}
        orders = {}
        for _ in range(60):
            ops.run(minutes=1)
            for order in changes.take_orders():
                picked = tuple(line.picked for line in order.lines)
                orders[order.order_id] = int(order.state), order.station, picked
            stock.update((bin_.item, bin_.quantity) for bin_ in changes.take_bins())
        assert (changes.take_orders(), changes.take_bins()) == ([], [])
    engine = open_engine(tmp_path / "a.db")
    total, rows = find_orders(engine, limit=10_000)
    kept = {row.id: (row.state, row.station, tuple(ln.picked for ln in ls)) for row, ls in rows}
    first = min(orders)  # those before were there when it began
    assert total > 200 and {n: o for n, o in kept.items() if n >= first} == orders
    with engine.connect() as connection:
        rows = connection.exec_driver_sql("SELECT item, quantity FROM bin").all()
    assert dict(map(tuple, rows)) == stock


def test_late_orders_are_found(tmp_path):
    with Operations(site=site(), physics=False, database=tmp_path / "a.db", orders="none") as ops:
        for reference, due in (("soon", 1.0), ("later", 9000.0), ("at any time", 0.0)):
            ops.shift.submit([("sku-1", 1)], due, reference=reference)
        ops.run(minutes=20)
        ops.shift.submit([("sku-2", 1)], ops.shift.now - 1, reference="waits")
        ops.shift.commit()
        ops.shift.journal.flush()

        def late(now):
            return [row.reference for row, _ in find_orders(ops.database.engine, late_at=now)[1]]

        assert all(row.completed for row, _ in find_orders(ops.database.engine)[1][1:])
        assert late(ops.shift.now) == ["waits", "soon"]
        assert late(ops.shift.now - 2) == ["soon"]


@pytest.mark.parametrize("damaged", [False, True])
def test_what_does_not_come_to_be_put_in_stays_out_of_the_stock(tmp_path, damaged):
    with Operations(site=site(), physics=False, database=tmp_path / "a.db", orders="none") as ops:
        shift = ops.shift
        shift.set_station(REPLENISH, True, StationMode.MANUAL)
        ops.run(minutes=10)
        visit = shift.station(REPLENISH).here
        bundle = visit.puts[0]
        stock, bin_, quantity = bundle.bin.quantity, bundle.bin, bundle.quantity
        assert shift.report_short(REPLENISH, bundle.sku, quantity + 1, damaged)[0] is False
        assert shift.report_short(REPLENISH, "sku-none", 1, damaged)[0] is False
        assert shift.report_short("nowhere", bundle.sku, 1, damaged)[0] is False
        assert shift.report_short(REPLENISH, bundle.sku, 1, damaged) == (True, "")
        assert shift.confirm_pick(REPLENISH, bundle.sku, quantity - 1) == (True, "")
        assert bin_.quantity == stock + quantity - 1
        while visit.here:  # nothing of the others has come
            last = visit.puts[0]
            assert shift.report_short(REPLENISH, last.sku, last.quantity, damaged) == (True, "")
        ops.run(minutes=5)
        assert shift.inventory.expected == sum(
            b.quantity for s in shift.stations for v in s.coming for b in v.puts
        )
    assert check.faults(open_engine(tmp_path / "a.db")) == []


def test_heat_is_where_robots_drove_and_waited_within_the_last_hour():
    plan = site().plan
    heat, at = FloorHeat(plan, now=100.0), plan.cell_of
    waits = np.array([False, True])
    heat.update(100.0, [0.0, 5.0], [0.0, 3.0], waits)
    heat.update(101.0, [1.0, 5.0], [0.0, 3.0], waits)
    heat.update(101.5, [0.0, 5.4], [0.0, 3.0], waits)
    heat.update(104.0, [-50.0, 5.0], [0.0, 3.0], ~waits)  # off the floor
    traffic, waiting = heat.maps()
    assert {i: traffic[i] for i in np.flatnonzero(traffic)} == {at(1, 0): 1, at(0, 0): 1}
    assert {i: waiting[i] for i in np.flatnonzero(waiting)} == {at(5, 3): 1.5}
    assert heat.seconds(104.0) == 4.0
    again = FloorHeat(plan, now=110.0)
    again.restore([(began, maps) for _, began, maps in heat.kept(SLICES)])
    assert np.array_equal(again.maps(), heat.maps())
    assert again.seconds(110.0) == 10.0
    heat.update(100.0 + WINDOW, [0.0, 5.0], [0.0, 3.0], waits)
    assert heat.maps()[WAITING].sum() == GAP  # since long ago nothing was heard
    assert heat.maps()[TRAFFIC][at(0, 0)] == 1
    assert WINDOW * (1 - 1 / SLICES) <= heat.seconds(100.0 + WINDOW) <= WINDOW
