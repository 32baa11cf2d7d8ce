# SPDX-License-Identifier: Apache-2.0
"""What people ask a database: orders by reference and SKU, where pieces lie."""

import time

import pytest
from operations_site import site

from warehouse_layout.message_enums import OrderState
from warehouse_operations import Operations
from warehouse_operations.store.database import open_engine
from warehouse_operations.store.queries import find_orders, find_stock


@pytest.fixture(scope="module")
def engine(tmp_path_factory):
    path = tmp_path_factory.mktemp("queries") / "run.db"
    with Operations(site=site(), database=path, orders="none") as ops:
        ops.shift.submit([("sku-1", 1), ("sku-2", 2)], reference="A_1")
        ops.shift.submit([("sku-2", 1)], reference="AB1")
        ops.run(minutes=10)
        ops.shift.submit([("sku-3", 1)], reference="late")
    return open_engine(path)


def test_orders_are_found(engine):
    total, orders = find_orders(engine)
    assert total == 3 and [row.reference for row, _ in orders] == ["late", "AB1", "A_1"]
    assert [(line.sku, line.quantity, line.picked) for line in orders[2][1]] == [
        ("sku-1", 1, 1),
        ("sku-2", 2, 2),
    ]
    assert find_orders(engine, search="sku-2")[0] == 2
    assert find_orders(engine, search="A_")[0] == 1  # no wildcard
    assert find_orders(engine, search="%a" * 20000)[0] == 0  # SQLite refuses such a pattern
    assert find_orders(engine, state=int(OrderState.COMPLETED))[0] == 2
    assert find_orders(engine, order_id=3)[1][0][0].reference == "late"
    total, orders = find_orders(engine, limit=1, offset=1)
    assert (total, orders[0][0].reference) == (3, "AB1")


def test_the_order_that_is_named_comes_before_others_with_a_part_of_its_name(tmp_path):
    path = tmp_path / "run.db"
    with Operations(site=site(), database=path, orders="none") as ops:
        for reference in ("A-1", "a-12", "A-13", "2"):
            ops.shift.submit([("sku-1", 1)], reference=reference)
        ops.run(minutes=1)
    named = lambda text: [  # noqa: E731
        row.reference for row, _ in find_orders(open_engine(path), search=text)[1]
    ]
    assert named("a-1") == ["A-1", "A-13", "a-12"]
    assert named("2") == ["2", "a-12"]  # its reference, and the number of the other
    assert named("3") == ["A-13"]
    assert find_orders(open_engine(path), search="A-1", limit=1)[0] == 3


def test_stock_is_found(engine):
    total, pieces, rows = find_stock(engine, "sku-2")
    assert total == len(rows) and pieces == sum(row.quantity for row in rows)
    assert all(row.sku == "sku-2" for row in rows)
    assert [row.quantity for row in rows] == sorted((r.quantity for r in rows), reverse=True)
    assert find_stock(engine, "sku-none") == (0, 0, [])
    assert find_stock(engine)[0] == len(site().items)


@pytest.mark.parametrize("number", [2**63, 2**64 - 1])
def test_what_no_database_holds_is_not_found(engine, number):
    assert find_orders(engine, order_id=number) == (0, [])
    assert find_orders(engine, limit=number, offset=number) == (3, [])
    assert len(find_orders(engine, limit=number)[1]) == 3
    assert find_stock(engine, limit=number, offset=number)[2] == []
    for text in ("\udcff", "a\0b"):
        assert find_orders(engine, search=text) == (0, [])
        assert find_stock(engine, text) == (0, 0, [])


def test_many_orders_are_no_burden(tmp_path):
    """1,000 orders at once cost the shift little, and 10,000 in the list are searched at once."""
    with Operations(site=site(), database=tmp_path / "run.db", orders="none") as ops:
        ops.run(seconds=1)
        began = time.process_time()
        for i in range(10_000):
            assert ops.shift.submit([("sku-1", 1)], reference=f"R-{i}")[0]
        spent = time.process_time() - began
        ops.shift.commit()
        ops.database.flush()
        began = time.process_time()
        assert find_orders(ops.database.engine, search="R-77", limit=20)[0] == 111
        assert time.process_time() - began < 0.5
    assert spent / 10_000 < 2e-3
