# SPDX-License-Identifier: Apache-2.0
"""Orders that come as a table: all of them are accepted, or none."""

import pytest
from operations_site import site

from warehouse_operations import Operations
from warehouse_operations.shift import order_table
from warehouse_operations.store.queries import matching

TWO = "reference,sku,quantity,due,priority\nA,sku-1,2,1800,3\nA,sku-2,1,1800,3\nB,sku-3,1,,\n"


def book():
    return Operations(site=site(), physics=False, orders="none").shift.order_book


def test_a_table_of_orders_is_accepted():
    the_book = book()
    answer = order_table.submit(the_book, TWO)
    assert (answer.faults, answer.references, answer.lines, answer.pieces) == ([], ["A", "B"], 3, 4)
    first = the_book.orders[answer.order_ids[0]]
    assert (first.reference, first.due, first.priority, len(first.lines)) == ("A", 1800.0, 3, 2)


def test_a_check_accepts_nothing():
    the_book = book()
    answer = order_table.submit(the_book, TWO, check_only=True)
    assert (answer.order_ids, answer.pieces, the_book.orders) == ([], 4, {})


@pytest.mark.parametrize(
    ("table", "line", "column", "text"),
    [
        (TWO + "C,sku-none,1,,\n", 5, "sku", "sku 'sku-none' is unknown"),
        (TWO + "C,sku-1,0,,\n", 5, "quantity", "quantity is '0'; a whole number from 1"),
        ("reference,sku,quantity\n", 0, "", "there is no order in it"),
        ("reference,sku,quantity,at\nA,sku-1,1,60\n", 0, "at", "orders that are sent come at once"),
        ("name\nA\n", 1, "", "there is no column reference, sku, quantity"),
    ],
)
def test_where_one_is_wrong_none_is_accepted(table, line, column, text):
    the_book = book()
    (fault,) = order_table.submit(the_book, table).faults
    assert (fault.line, fault.column) == (line, column)
    assert fault.text.startswith(text)
    assert not the_book.orders


def test_every_fault_of_a_row_is_named_with_limits_that_a_person_can_use():
    table = TWO + "C,sku-none,none,soon,999\nD,sku-1,3000000000,,\nE,sku-none,0,,\n"
    faults = order_table.submit(book(), table).faults
    assert [(fault.line, fault.column) for fault in faults] == [
        *((5, column) for column in ("sku", "quantity", "due", "priority")),
        (6, "quantity"),
        (7, "quantity"),
    ]
    texts = [fault.text.partition("; ")[2] for fault in faults]
    assert texts[1:] == [
        "a whole number from 1 on was expected",
        "a number from 0 on was expected",
        "a whole number from 0 to 255 was expected",
        "a whole number from 1 to 2,147,483,647 was expected",
        "a whole number from 1 on was expected",
    ]


def test_so_many_orders_as_would_stop_the_shift_are_refused(monkeypatch):
    monkeypatch.setattr(order_table, "MOST_ORDERS", 1)
    assert order_table.submit(book(), TWO).faults[0].text == "2 orders; 1 or fewer were expected"
    monkeypatch.setattr(order_table, "MOST_ORDERS", 2)
    monkeypatch.setattr(order_table.acceptance, "MOST_WAITING", 2)
    assert "wait already" in order_table.submit(book(), TWO).faults[0].text


def test_skus_are_found_by_a_part_of_their_name():
    names = ["sku-10", "sku-2", "a-sku-2", "SKU-20", "bolt"]
    assert matching(names, "sku-2") == ["sku-2", "SKU-20", "a-sku-2"]
    assert matching(["sku-10", "sku-9"], "") == ["sku-9", "sku-10"]
