# SPDX-License-Identifier: Apache-2.0
"""A shift over ideal robots: every piece and order exists once, whatever happens."""

import os
import random
import signal
import subprocess
import sys
import time
from array import array
from dataclasses import replace

import numpy as np
import pytest
from operations_site import site
from paths import HELPERS
from postgres import server
from sqlalchemy import text

from kiva_plugin_cpp import World
from warehouse_layout.message_enums import OrderEventKind, OrderState, StationMode
from warehouse_operations import Operations
from warehouse_operations.stock import demand
from warehouse_operations.stock.inventory import Reason
from warehouse_operations.stock.settings import Settings
from warehouse_operations.store import check, queries, stored
from warehouse_operations.store.database import DatabaseError, open_engine
from warehouse_operations.store.returning import SiteError

PICK, REPLENISH = "pick1", "replenish3"


def shift_on(database=None, **options):
    return Operations(site=site(), physics=False, database=database, **options)


def events_of(ops):
    """What is told of orders from now on: (order id, kind, sku, quantity, station, unit, text)."""
    events = []
    ops.shift.on_order_event = lambda order, *rest: events.append((order.order_id, *rest))
    return events


def promised(ops):
    """Pieces that bins promise, and pieces that order lines were promised."""
    lines = [line for order in ops.shift.orders.values() for line in order.lines]
    bins = ops.shift.inventory.bins.values()
    return sum(bin_.reserved for bin_ in bins), sum(line.allotted for line in lines)


def test_an_hour_balances_to_the_piece_and_repeats_to_the_last_event(tmp_path):
    hashes = []
    for name, seed in (("a.db", 1), ("b.db", 1), ("c.db", 2)):
        with shift_on(tmp_path / name, seed=seed) as ops:
            ops.run(hours=1)
            hashes.append(ops.kpis()["state_hash"])
            tally = ops.shift.tally
            pieces = ops.shift.inventory.total
            assert promised(ops)[0] == promised(ops)[1]
        engine = open_engine(tmp_path / name)
        assert check.faults(engine) == []
        summary = check.summary(engine)
        assert (summary["pieces"], summary["completed"]) == (pieces, tally.orders_completed)
    assert hashes[0] == hashes[1] != hashes[2]
    assert tally.items_picked > 600 and tally.bundles_stored > 50


WRONG = {
    "its moves add up to": "UPDATE bin SET quantity = quantity + 1 WHERE id = 3",
    "instead of 0": "INSERT INTO move SELECT 10000000, run, stamp, bin, 'sku-2', 1, reason, NULL,"
    " NULL, NULL FROM move WHERE sku <> 'sku-2' LIMIT 1",
    "are reserved, it has room for": "UPDATE bin SET capacity = quantity - 1 WHERE id = 3",
    "it would have held": "UPDATE move SET quantity = 1 - quantity WHERE id = 1",
    "are picked; moves say": "UPDATE order_line SET picked = 0",
    "that belongs to no order line": "UPDATE move SET order_id = NULL, line = NULL WHERE id ="
    " (SELECT MAX(id) FROM move WHERE reason = 'pick')",
    "of order {}": "UPDATE order_line SET sku = 'sku-1' WHERE sku <> 'sku-1'",
    "of its pieces were not picked": "UPDATE order_line SET quantity = quantity + 1",
    "it was completed": "UPDATE orders SET state = 1 WHERE state = 2",
    "its moves add up to {}": "UPDATE visit SET pieces = pieces + 1 WHERE id = 1",
    "is on {} visits at once": "UPDATE visit SET unit = 1, ended = NULL",
}


@pytest.mark.parametrize("sentence", WRONG)
def test_what_does_not_balance_is_told(tmp_path, sentence):
    with shift_on(tmp_path / "run.db") as ops:
        ops.run(minutes=10)
    engine = open_engine(tmp_path / "run.db")
    assert check.faults(engine) == []
    with engine.begin() as connection:
        connection.execute(text(WRONG[sentence]))
    expected = sentence.partition("{}")[0].strip()
    assert any(expected in fault for fault in check.faults(engine))


def test_the_database_itself_refuses_promises_beyond_the_stock(tmp_path):
    with shift_on(tmp_path / "run.db") as ops:
        ops.run(minutes=1)
    with (
        pytest.raises(Exception, match="reserved_in_stock"),
        open_engine(tmp_path / "run.db").begin() as connection,
    ):
        connection.execute(text("UPDATE bin SET reserved = quantity + 1"))


WORKER = """
import sys
sys.path.insert(0, sys.argv[1])
from kiva_plugin_cpp import World
from operations_site import site
from warehouse_operations import Operations
ops = Operations(site=site(), physics=False, database=sys.argv[2], orders="fill:40")
while True:
    print("running", flush=True)
    ops.run(seconds=20)
    ops.database.flush()
"""


def test_killed_at_any_moment_nothing_is_lost_or_done_twice(tmp_path):
    database, chance = str(tmp_path / "run.db"), random.Random(4)
    known = set()
    for writes in range(5):
        worker = subprocess.Popen(
            [sys.executable, "-c", WORKER, str(HELPERS), database],
            stdout=subprocess.PIPE,
        )
        for _ in range(1 + writes):
            worker.stdout.readline()
        time.sleep(chance.uniform(0.05, 0.5))
        os.kill(worker.pid, signal.SIGKILL)
        worker.wait()
        worker.stdout.close()
        engine = open_engine(database)
        assert check.faults(engine) == []
        with engine.connect() as connection:
            orders = set(connection.execute(text("SELECT id FROM orders")).scalars())
        assert known <= orders
        known = orders
    with open_engine(database).connect() as connection:
        before = connection.execute(text("SELECT COUNT(*) FROM orders WHERE state < 2")).scalar()
    assert before >= 30
    with shift_on(database, orders="none") as ops:
        ops.run(hours=3)
        assert not ops.shift.orders
        assert ops.shift.tally.orders_completed == before
    assert check.faults(open_engine(database)) == []


def test_times_of_orders_go_on_in_the_next_run(tmp_path):
    with shift_on(tmp_path / "run.db", orders="none") as ops:
        ops.run(seconds=100)
        for station in ops.shift.stations:
            ops.shift.set_station(station.name, False, StationMode.AUTOMATIC)
        ops.shift.submit([("sku-1", 1)], due=400.0, reference="mine")
        ops.run(seconds=50)
    with shift_on(tmp_path / "run.db", orders="none") as ops:
        (order,) = ops.shift.orders.values()
        assert (order.reference, order.created, order.due) == ("mine", -50.0, 250.0)
        engine = open_engine(tmp_path / "run.db")
        assert is_late(engine, 249.0) == []
        assert is_late(engine, 251.0) == ["mine"]
        for station in ops.shift.stations:
            ops.shift.set_station(station.name, True, StationMode.AUTOMATIC)
        ops.run(seconds=240)
        assert order.state == OrderState.COMPLETED
        ops.shift.journal.flush()
        assert is_late(engine, 500.0) == []


def is_late(engine, now):
    _, late = queries.find_orders(engine, late_at=now)
    return [row.reference for row, _ in late]


def test_what_was_done_is_known_to_the_next_run(tmp_path):
    with shift_on(tmp_path / "run.db") as ops:
        ops.run(minutes=30)
        tally, end = ops.shift.tally, ops.shift.now
    engine = open_engine(tmp_path / "run.db")
    of_tally = [dict(c) for c in (tally.picked_in, tally.stored_in, tally.completed_in)]
    assert sum(of_tally[0].values()) > 100
    begin, *counts = stored.throughput(engine, end + 20, since=0.0)
    assert (begin, [dict(c) for c in counts]) == (0.0, of_tally)  # time has gone on
    begin, *counts = stored.throughput(engine, 600.0, since=0.0)  # it went back by 20 minutes
    assert begin == 0.0
    later = {i - 20: n for i, n in of_tally[0].items() if i >= 20}
    assert dict(counts[0]) == later
    begin, *counts = stored.throughput(engine, end + 7200, since=end + 3600)
    assert begin == end + 7200 and not any(counts)


def test_a_database_of_another_warehouse_is_refused(tmp_path):
    with shift_on(tmp_path / "run.db"):
        pass
    with pytest.raises(SiteError, match=r"is of another warehouse: the station pick1 at \("):
        Operations(site=site(blocks=3), database=tmp_path / "run.db")
    with pytest.raises(SiteError, match=r"of its \d+ bins, \d+ are not here and \d+ are on other"):
        Operations(site=site(bins=4), database=tmp_path / "run.db")


def without(there, gone):
    """A Site in which storage units are gone."""
    units = {unit: cell for unit, cell in there.units.items() if unit not in gone}
    return replace(there, units=units, items=[(i, u) for i, u in there.items if u not in gone])


def stock(engine):
    with engine.connect() as connection:
        return connection.execute(text("SELECT SUM(quantity) FROM bin")).scalar()


@pytest.mark.parametrize("layout_is_known", [True, False])
def test_storage_units_that_are_gone_are_written_off_and_new_ones_taken_in(
    tmp_path, layout_is_known
):
    path, whole = tmp_path / "run.db", site()
    with Operations(site=whole, database=path, orders="fill:40") as ops:
        ops.run(minutes=7)
        lost = sum(bin_.quantity for unit in (3, 8) for bin_ in ops.shift.inventory.of_unit[unit])
    engine = open_engine(path)
    if not layout_is_known:
        with engine.begin() as connection:
            connection.execute(text("UPDATE run SET layout = NULL"))
    pieces = stock(engine)
    with Operations(site=without(whole, {3, 8}), database=path, orders="none") as ops:
        (notice,) = ops.shift.notices
        assert notice == (f"10 bins of storage units 3, 8 are gone: {lost} pieces are written off")
        assert ops.shift.inventory.total == pieces - lost
        assert ops.shift.inventory.capacity == 24 * (len(whole.items) - 10)
        ops.run(minutes=30)
    assert check.faults(engine) == []
    gone = text("SELECT -SUM(quantity) FROM move WHERE reason = 'gone'")
    with engine.connect() as connection:
        assert connection.execute(gone).scalar() == lost
    with Operations(site=without(whole, {3, 8}), database=path) as ops:
        assert not list(ops.shift.notices)
    more = {**without(whole, {3}).units, 999: whole.units[3]}
    larger = replace(whole, units=more, items=[*without(whole, {3}).items, ("item999", 999)])
    with Operations(site=larger, database=path, seed=2) as ops:
        (notice,) = ops.shift.notices
        assert notice == "6 bins of storage units 8, 999 are new, and still empty"
        assert not any(ops.shift.inventory.of_unit[8][i].quantity for i in range(5))
        ops.run(hours=3)
        assert any(bin_.quantity for bin_ in ops.shift.inventory.of_unit[8])
    assert check.faults(engine) == []


FILLED = {"name": "at once", "fills": True}


@pytest.mark.parametrize("batches", ["at once", FILLED, "together"], ids=str)
def test_a_sku_that_lost_all_its_bins_finds_another(tmp_path, batches):
    path, whole = tmp_path / "run.db", site()
    with Operations(site=whole, database=path, orders="none") as ops:
        homes = {}
        for bin_ in ops.shift.inventory.bins.values():
            homes.setdefault(bin_.sku, set()).add(bin_.unit)
    sku, units = min(homes.items(), key=lambda pair: len(pair[1]))
    policies = {"batches": batches}
    with Operations(
        site=without(whole, units), database=path, orders="fill:60", policies=policies
    ) as ops:
        order, _ = ops.shift.submit([(sku, 2)])
        ops.run(hours=6)
        assert order.state == OrderState.COMPLETED
    assert check.faults(open_engine(path)) == []


def test_an_item_on_another_unit_keeps_its_pieces(tmp_path):
    path, whole = tmp_path / "run.db", site()
    with Operations(site=whole, database=path, orders="none") as ops:
        (bin_,) = [bin_ for bin_ in ops.shift.inventory.bins.values() if bin_.item == "item7"]
        pieces = bin_.quantity
    items = [(item, 11 if item == "item7" else unit) for item, unit in whole.items]
    with Operations(site=replace(whole, items=items), database=path, orders="none") as ops:
        (notice,) = ops.shift.notices
        assert notice == "item7 of storage unit 11 is on another storage unit than before"
        (bin_,) = [bin_ for bin_ in ops.shift.inventory.of_unit[11] if bin_.item == "item7"]
        assert bin_.quantity == pieces
    with Operations(site=replace(whole, items=items), database=path, orders="none") as ops:
        assert not list(ops.shift.notices)
    assert check.faults(open_engine(path)) == []


def test_a_bin_that_is_gone_from_the_floor_is_written_off(tmp_path):
    path, whole = tmp_path / "run.db", site()
    with Operations(site=whole, database=path, orders="none") as ops:
        ops.shift.fallen.update(["item7"])
        ops.run(seconds=1)
    items = [(item, unit) for item, unit in whole.items if item != "item7"]
    with Operations(site=replace(whole, items=items), database=path, orders="none") as ops:
        assert "item7 of storage unit 2 is gone: " in next(iter(ops.shift.notices))
    engine = open_engine(path)
    with Operations(site=whole, database=path, orders="none") as ops:
        (bin_,) = [bin_ for bin_ in ops.shift.inventory.of_unit[2] if bin_.item == "item7"]
        assert (bin_.quantity, bin_.fallen) == (0, None)
    assert check.faults(engine) == []


def test_an_older_database_is_brought_up_to_date_and_a_newer_one_refused(tmp_path):
    from warehouse_operations.store import schema

    engine = open_engine(tmp_path / "run.db")
    steps = {schema.VERSION: lambda c: c.execute(text("ALTER TABLE unit ADD COLUMN colour TEXT"))}
    with engine.begin() as connection:
        schema.prepare(connection, schema.VERSION + 1, steps)
        assert connection.execute(text("SELECT colour FROM unit")).all() == []
    with pytest.raises(DatabaseError, match=rf"schema version {schema.VERSION + 1}"):
        open_engine(tmp_path / "run.db")


def test_an_order_is_picked_told_and_complete():
    ops = shift_on(orders="none")
    events = events_of(ops)
    order, message = ops.shift.submit([("sku-1", 2), ("sku-2", 1)], reference="A-1")
    ops.run(minutes=10)
    assert message == "" and order.state == OrderState.COMPLETED
    kinds = [kind for _, kind, *_ in events]
    assert kinds == [0, 1, 2, 2, 2, 3]
    assert sum(quantity for _, kind, _, quantity, *_ in events if kind == 2) == 3


@pytest.mark.parametrize(
    "lines, message",
    [
        ([("sku-none", 1)], "there is no SKU 'sku-none'"),
        ([("sku-1", 0)], "0 pieces of sku-1; 1 or more was expected"),
        ([], "an order has one line or more"),
        (
            [("sku-1", 2**31 - 1)],
            "an order of 2147483647 pieces; all bins of the warehouse together hold 16320",
        ),
        (
            [("sku-1", 1)] * 100_000,
            "an order of 100000 lines; 1000 or fewer were expected",
        ),
        ([("s" * 10**6, 1)], f"there is no SKU '{'s' * 80}…'"),
    ],
)
def test_orders_that_can_not_be_are_refused(lines, message):
    ops = shift_on(orders="none")
    assert ops.shift.submit(lines) == (None, message)
    assert not ops.shift.orders


@pytest.mark.parametrize(
    "fields, message",
    [
        ({"reference": "x" * 201}, "the reference has 201 characters; 200 or fewer were expected"),
        ({"reference": "a\0b"}, "the reference 'a\\x00b' has characters that can't be printed"),
        ({"reference": "\udcff"}, "the reference '\\udcff' has characters"),
        ({"due": float("nan")}, "due is nan; 0 (at any time) to 1e+10 s was expected"),
        ({"due": -1.0}, "due is -1; 0"),
        ({"due": float("inf")}, "due is inf; 0"),
        ({"priority": 256}, "priority is 256; 0 to 255 was expected"),
    ],
)
def test_orders_that_no_database_could_keep_are_refused(fields, message):
    ops = shift_on(orders="none")
    order, why = ops.shift.submit([("sku-1", 1)], **fields)
    assert order is None and why.replace("\\\\", "\\").startswith(message)


def test_orders_for_all_that_there_could_be_cost_little():
    """Whatever is asked for, it is refilled in portions, and other orders do not suffer."""
    ops = shift_on(orders="none")
    skus, capacity = ops.shift.assortment.skus, ops.shift.inventory.capacity
    ops.run(seconds=1)
    for sku in skus[1:]:
        assert ops.shift.submit([(sku, capacity)])[0]
    began = time.process_time()
    ops.run(minutes=10)
    assert time.process_time() - began < 20
    assert ops.shift.view.pieces_ordered < 200 * len(skus)
    for order_id in list(ops.shift.orders):
        assert ops.shift.cancel_order(order_id)[0]
    modest, _ = ops.shift.submit([(skus[0], 1)])
    ops.run(minutes=10)
    assert modest.state == OrderState.COMPLETED


def test_a_flood_of_orders_is_refused_and_keeps_steps_short():
    ops = shift_on(orders="none")
    skus = ops.shift.assortment.skus
    ops.run(seconds=1)
    lines = [(sku, 1) for sku in skus[:100]]
    answers = [ops.shift.submit(lines) for _ in range(1100)]
    assert [order is not None for order, _ in answers] == [True] * 1000 + [False] * 100
    assert answers[-1][1] == ("orders of 100000 lines wait already; come back when there are fewer")
    steps = []
    for _ in range(28):
        began = time.process_time()
        ops.run(seconds=1)
        steps.append(time.process_time() - began)
    assert max(steps) < 3


def test_a_database_with_an_order_that_can_not_be_opens_and_says_so(tmp_path):
    with shift_on(tmp_path / "run.db", orders="none") as ops:
        ops.shift.submit([("sku-1", 1), ("sku-2", 1)], reference="evil")
        ops.shift.submit([("sku-3", 1)], reference="good")
    with open_engine(tmp_path / "run.db").begin() as connection:
        connection.execute(
            text("UPDATE order_line SET quantity = 2147483647 WHERE order_id = 1 AND number = 0")
        )
    with shift_on(tmp_path / "run.db", orders="none") as ops:
        assert [order.reference for order in ops.shift.orders.values()] == ["good"]
        (notice,) = ops.shift.notices
        assert notice.startswith("order 1 (evil) is cancelled: an order of 2147483648 pieces; all")
        ops.run(minutes=10)
        assert not ops.shift.orders
    engine = open_engine(tmp_path / "run.db")
    assert check.faults(engine) == []
    _, ((row, _),) = queries.find_orders(engine, search="evil")
    assert row.state == OrderState.CANCELLED


def test_the_orders_of_a_file_come_in_parts(tmp_path, monkeypatch):
    monkeypatch.setattr(demand, "MOST_WAITING", 5000)
    path = tmp_path / "orders.csv"
    rows = (f"A-{i},sku-{i % 9 + 1},1\n" for i in range(6_000))
    path.write_text("reference,sku,quantity\n" + "".join(rows))
    with Operations(site=site(), orders=str(path), database=tmp_path / "run.db") as ops:
        ops.run(seconds=2)
        assert 2000 <= len(ops.shift.orders) <= 4000
        ops.run(minutes=2)
        assert ops.shift.backlog.lines == 5_000 and not list(ops.shift.notices)


def test_more_than_there_is_waits_for_new_stock_and_nothing_else_suffers():
    ops = shift_on(orders="none")
    events = events_of(ops)
    there = ops.shift.inventory.available("sku-1")
    greedy, message = ops.shift.submit([("sku-1", there + 5)])
    assert message == "waits for replenishment of sku-1"
    assert events[-1][1] == OrderEventKind.SHORT
    modest, _ = ops.shift.submit([("sku-2", 1)])
    ops.run(minutes=15)
    assert modest.state == OrderState.COMPLETED
    ops.run(hours=4)
    assert greedy.state == OrderState.COMPLETED


def test_cancelled_orders_give_back_what_they_were_promised():
    ops = shift_on(orders="fill:30")
    ops.run(minutes=5)
    ops.shift.demand.waiting = 0
    for order_id in list(ops.shift.orders):
        done = ops.shift.orders[order_id].done
        assert ops.shift.cancel_order(order_id)[0] is not done
    ops.run(minutes=20)
    assert not ops.shift.orders and promised(ops) == (0, 0)
    assert ops.shift.cancel_order(1)[0] is False
    away = {visit.unit for s in ops.shift.stations for visit in s.inbound.values()}
    assert len(ops.shift.free_units | away) == len(ops.site.units)


def test_an_order_that_is_made_urgent_comes_before_older_ones(tmp_path):
    path = tmp_path / "shift.db"
    ops = shift_on(path, orders="fill:60")
    ops.run(minutes=5)
    events = events_of(ops)
    urgent = list(ops.shift.backlog)[-1]
    said = "priority 9, due at 0:30:00"
    assert ops.shift.change_order(urgent.order_id, 9, 1800.0) == (True, said)
    assert events == [(urgent.order_id, 8, "", 0, "", 0, said)]
    assert next(ops.shift.backlog.by_urgency()) is urgent
    assert [order.order_id for order in ops.shift.backlog] == sorted(ops.shift.backlog.orders)
    there = next(o for o in ops.shift.orders.values() if o.station and not o.done)
    assert ops.shift.change_order(there.order_id, None, 0.0)[0] and there.due == 0
    likely, units = ops.shift.likely_completion(there.order_id)
    assert likely > ops.shift.now and set(units) <= ops.shift.inventory.of_unit.keys()
    # What others took less time for says nothing about an order that has waited for longer.
    waiting = next(iter(ops.shift.backlog))
    age = ops.shift.now - waiting.created
    ops.shift.tally.turnover_s[:] = array("d", [age / 2] * 20 + [age + 30, age + 60, age + 90])
    assert ops.shift.likely_completion(waiting.order_id) == (ops.shift.now + 60, [])
    ops.shift.tally.turnover_s.pop()
    assert ops.shift.likely_completion(waiting.order_id) == (0.0, [])
    ops.run(minutes=5)
    assert urgent.station and urgent.priority == 9
    ops.close()
    engine = open_engine(f"sqlite:///{path}")
    _, [(row, _)] = queries.find_orders(engine, urgent.order_id)
    assert (row.priority, row.due) == (9, 1800.0)
    kinds = [event.kind for event in queries.order_events(engine, urgent.order_id, 500)]
    assert kinds[:3] == [0, 8, 1]
    engine.dispose()


def test_what_can_not_be_changed_is_refused():
    ops = shift_on(orders="none")
    order, _ = ops.shift.submit([("sku-1", 1)])
    assert ops.shift.change_order(99, 1, None) == (False, "order 99 is unknown, or over")
    refused = ops.shift.change_order(order.order_id, 256, None)
    assert refused == (False, "priority is 256; 0 to 255 was expected")
    assert not ops.shift.change_order(order.order_id, None, float("nan"))[0]
    assert (order.priority, order.due) == (0, 0.0)
    assert ops.shift.likely_completion(99) == (0.0, [])


def test_a_station_closes_while_units_are_on_the_way():
    ops = shift_on(orders="fill:30")
    ops.run(minutes=5)
    station = ops.shift.station(PICK)
    assert len(station.coming) > 1 and station.orders
    assert ops.shift.set_station(PICK, False, StationMode.AUTOMATIC) == (True, "")
    ops.run(minutes=10)
    assert not station.inbound and not station.orders and promised(ops)[0] == promised(ops)[1]
    pieces = station.pieces
    ops.run(minutes=10)
    assert station.pieces == pieces
    ops.shift.set_station(PICK, True, StationMode.AUTOMATIC)
    ops.run(minutes=10)
    assert station.pieces > pieces + 30
    ops.shift.demand.waiting = 0
    ops.run(hours=2)
    assert not ops.shift.orders


def test_a_unit_that_is_gone_is_not_asked_for():
    ops = shift_on(orders="fill")
    ops.run(minutes=5)
    on_the_way = [visit.unit for s in ops.shift.stations for visit in s.inbound.values()]
    ops.shift.update_units(set(ops.site.units) - set(on_the_way))
    ops.run(minutes=10)
    for station in ops.shift.stations:
        assert not {visit.unit for visit in station.inbound.values()} & set(on_the_way)
    assert promised(ops)[0] == promised(ops)[1]


def by_hand(ops):
    ops.shift.set_station(PICK, True, StationMode.MANUAL)
    station = ops.shift.station(PICK)
    ops.shift.set_station("pick2", False, StationMode.AUTOMATIC)
    ops.run(minutes=10)
    return station, station.here.picks[0]


def test_a_person_confirms_what_was_picked():
    ops = shift_on(orders="fill:30")
    station, pick = by_hand(ops)
    assert station.pieces == 0
    sku, asked = (
        pick.line.sku,
        sum(p.quantity for p in station.here.picks if p.line.sku == pick.line.sku),
    )
    assert ops.shift.confirm_pick(PICK, sku, asked + 1)[0] is False
    assert ops.shift.confirm_pick(PICK, "sku-none", 1)[0] is False
    assert ops.shift.confirm_pick("pick2", sku, 1) == (False, "pick2 works by itself")
    stock = ops.shift.inventory.total
    assert ops.shift.confirm_pick(PICK, sku, asked) == (True, "")
    assert (station.pieces, ops.shift.inventory.total) == (asked, stock - asked)


@pytest.mark.parametrize("damaged", [False, True])
def test_what_is_not_there_is_written_off_and_brought_from_elsewhere(tmp_path, damaged):
    ops = shift_on(tmp_path / "run.db", orders="fill:30")
    station, pick = by_hand(ops)
    events = events_of(ops)
    bin_, order, stock = pick.bin, pick.line.order, pick.bin.quantity
    assert ops.shift.report_short(PICK, pick.line.sku, stock + 1)[0] is False
    assert ops.shift.report_short(PICK, pick.line.sku, stock, damaged) == (True, "")
    assert bin_.quantity == 0 and promised(ops)[0] == promised(ops)[1]
    assert events[0][1] == OrderEventKind.SHORT
    assert events[0][-1] == ("damaged" if damaged else "short")
    ops.shift.set_station(PICK, True, StationMode.AUTOMATIC)
    ops.run(hours=1)
    assert order.state == OrderState.COMPLETED
    ops.close()
    assert check.faults(open_engine(tmp_path / "run.db")) == []


def test_a_person_puts_new_stock_in():
    ops = shift_on(orders="none")
    ops.shift.set_station(REPLENISH, True, StationMode.MANUAL)
    ops.run(minutes=10)
    visit = ops.shift.station(REPLENISH).here
    bundle, before = visit.puts[0], visit.puts[0].bin.quantity
    assert ops.shift.confirm_pick(REPLENISH, bundle.sku, bundle.quantity + 1)[0] is False
    assert ops.shift.confirm_pick(REPLENISH, bundle.sku, bundle.quantity) == (True, "")
    assert bundle.bin.quantity == before + bundle.quantity


def test_a_server_keeps_what_a_file_keeps(tmp_path):
    with server() as url:
        for minutes in (20, 10):
            with shift_on(url) as ops:
                ops.run(minutes=minutes)
        engine = open_engine(url)
        assert check.faults(engine) == []
        with engine.begin() as connection:
            runs = connection.execute(text("SELECT id, simulated_s FROM run ORDER BY id")).all()
            assert runs == [(1, 1200.0), (2, 600.0)]
            connection.execute(text("UPDATE bin SET quantity = quantity + 1 WHERE id = 3"))
        assert len(check.faults(engine)) == 1
        engine.dispose()


def test_a_database_that_can_not_be_reached_is_told(tmp_path):
    with pytest.raises(DatabaseError, match="connection to server"):
        shift_on("postgresql://none@127.0.0.1:1/none")
    with pytest.raises(DatabaseError, match="unable to open database file"):
        shift_on(tmp_path / "no" / "such" / "folder.db")
    with pytest.raises(DatabaseError, match="oracle-of-delphi"):
        shift_on("oracle-of-delphi://x/y")


def test_the_worlds_own_robots_work_and_repeat(tmp_path):
    """Physics: the same seed gives the same shift and the same state of the world."""
    hashes = []
    for name in ("a.db", "b.db"):
        with Operations(World.preset("small"), database=tmp_path / name) as ops:
            ops.run(minutes=10)
            figures = ops.kpis()
            hashes.append((figures["state_hash"], ops.fleet.state_hash()))
        assert check.faults(open_engine(tmp_path / name)) == []
        assert figures["items_picked"] > 60 and figures["collisions"] == 0
    assert hashes[0] == hashes[1]


def test_policies_decide_for_simulated_robots():
    """Robots go back to where they parked, and units to where they stood."""
    chosen = {"idle": "park", "storage": "fixed", "robots": "balanced", "replenishment": "never"}
    ops = Operations(World.preset("small"), orders="none", policies=chosen)
    parked = np.column_stack([ops.fleet.world.fleet.x, ops.fleet.world.fleet.y])
    for i in range(1, 9):
        ops.shift.submit([(f"sku-{i}", 1)])
    ops.run(minutes=8)
    assert not ops.shift.orders and len(ops.shift.free_units) == len(ops.site.units)
    now = np.column_stack([ops.fleet.world.fleet.x, ops.fleet.world.fleet.y])
    assert np.allclose(now, parked, atol=0.05)
    assert ops.shift.floor.cells == ops.site.units
    lanes = {station.name: station.cells for station in ops.site.plan.stations}
    passed = ops.fleet.passages().ravel()
    assert sum(passed[cells].min() for cells in lanes.values()) == ops.kpis()["trips"] > 0
    assert ops.fleet.waiting_map().sum() > 0
    ops.close()


@pytest.mark.parametrize("seed", [2, 7, 15, 16])
def test_when_no_more_orders_come_all_are_completed(seed):
    ops = shift_on(orders="fill:40", seed=seed)
    ops.run(minutes=40 + 20 * (seed % 4))
    ops.shift.demand.waiting = 0
    ops.run(hours=2)
    assert not ops.shift.orders and promised(ops) == (0, 0)


def test_a_sku_that_is_sold_out_keeps_a_bin_to_be_refilled_in():
    ops = shift_on(orders="none")
    inventory = ops.shift.inventory
    own = [bin_ for bin_ in inventory.bins.values() if bin_.sku == "sku-26"]
    for bin_ in own:
        inventory.move(bin_, bin_.sku, -bin_.quantity, Reason.DAMAGED)
    for bin_ in own[1:]:
        inventory.expect(bin_, "sku-1", 1)
    assert not inventory.takes(own[0], "sku-1", 1) and inventory.takes(own[0], "sku-26", 12)


def one_station(settings, seconds, replenishing=1):
    """Returns a shift at whose only station work is never short of units."""
    place = replace(site(robots=20, picking=1, replenishing=replenishing), settings=settings)
    ops = Operations(site=place, physics=False)
    ops.run(seconds=seconds)
    return ops


def test_several_pickers_share_the_pieces_of_a_unit():
    alone = one_station(Settings(piece_s=20.0), 3600)
    three = one_station(Settings(piece_s=20.0, pickers=3), 3600)
    bound = [ops.kpis()["item_upper_bound_per_hour"] for ops in (alone, three)]
    picked = [ops.kpis()["items_picked"] for ops in (alone, three)]
    assert 0.8 * bound[0] < picked[0] <= bound[0]
    assert 1.5 * picked[0] < picked[1] <= bound[1]
    assert three.kpis()["station_idle_fraction"] >= 0


def test_the_first_piece_of_a_line_takes_longer():
    ops = one_station(Settings(piece_s=5.0, line_s=30.0), 3600)
    (station,) = ops.shift.picking.stations
    lines = ops.kpis()["lines_picked"]
    assert 35 * lines < station.busy_s < 35 * (lines + 12) + 5 * station.pieces


def test_a_station_keeps_its_hours():
    settings = Settings(hours=((0.25, 0.5), (0.75, 1.0)))
    ops = one_station(settings, 0.25 * 3600)
    (station,) = ops.shift.picking.stations
    assert not station.pieces
    ops.run(seconds=0.25 * 3600)
    morning = station.pieces
    assert morning > 20
    ops.run(seconds=0.25 * 3600)
    assert station.pieces <= morning + 1, "what was in a hand goes into its tote"
    ops.run(seconds=0.25 * 3600)
    assert station.pieces > morning + 20
    assert station.open_seconds(3600) == pytest.approx(1800)
    assert 0 < station.busy_fraction(3600) <= 1


def test_stock_is_put_in_where_orders_are_picked():
    """The only stations pick and replenish: an hour of both, to the piece."""
    both = Settings(by_station={"pick1": {"replenishes": True}})
    ops = one_station(both, 3600, replenishing=0)
    (station,) = ops.shift.picking.stations
    assert station in ops.shift.replenishing.stations
    kpis = ops.kpis()
    assert kpis["items_picked"] > 100 and kpis["bundles_stored"] > 0
    visits = [v for v in station.inbound.values() if v.replenishes]
    assert all(not visit.picks for visit in visits)
    ops.shift.set_station("pick1", False, StationMode.AUTOMATIC)
    ops.run(seconds=300)
    assert not station.inbound and promised(ops) == (0, 0)
