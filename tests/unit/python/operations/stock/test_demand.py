# SPDX-License-Identifier: Apache-2.0
"""Where orders come from: published shares, files with their wrong rows told."""

from collections import Counter

import numpy as np
import pytest

from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.demand import Customers, Poisson, make_demand
from warehouse_operations.stock.order_file import DemandError, OrderDraft, parse_csv, read_csv

GOOD = "reference,sku,quantity,at,due,priority\n"


@pytest.fixture
def assortment():
    return Assortment.draw(1000, np.random.default_rng(1))


def test_orders_have_the_published_shares(assortment):
    customers = Customers(assortment, np.random.default_rng(2))
    orders = [customers.order(0.0, lambda sku: 100) for _ in range(4000)]
    lines = Counter(len(order.lines) for order in orders)
    shares = [lines[n] / len(orders) for n in (1, 2, 3, 4)]
    assert shares == pytest.approx([0.554, 0.350, 0.088, 0.009], abs=0.03)
    pieces = [n for order in orders for _, n in order.lines]
    assert set(pieces) == {1, 2} or set(pieces) == {1, 2, 3}
    assert np.mean(pieces) == pytest.approx(1.05, abs=0.03)
    assert np.mean([order.due == 1800 for order in orders]) == pytest.approx(0.2, abs=0.02)
    asked = Counter(sku for order in orders for sku, _ in order.lines)
    top = sum(count for _, count in asked.most_common(200)) / sum(asked.values())
    assert 0.5 < top < 0.62


def test_nothing_is_ordered_that_is_not_there(assortment):
    customers = Customers(assortment, np.random.default_rng(2))
    assert customers.order(0.0, lambda sku: 0) is None
    only = customers.order(0.0, lambda sku: 9 * (sku in assortment.skus[:300]))
    assert {sku for sku, _ in only.lines} <= set(assortment.skus[:300])


def test_poisson_comes_as_often_as_asked(assortment):
    demand = make_demand("poisson:600", assortment, (2, 1), np.random.default_rng(3))
    assert isinstance(demand, Poisson) and demand.bundles_per_hour == 45
    came = list(demand.due(10 * 3600.0, [], lambda sku: 9))
    assert len(came) == pytest.approx(6000, rel=0.05)
    assert make_demand("poisson", assortment, (2, 1), np.random.default_rng(3)).per_hour == 320


def test_a_file_of_orders(tmp_path):
    path = tmp_path / "orders.csv"
    path.write_text(GOOD + "A,sku-1,2,5,60,1\nB,sku-1,1,,,\nA,sku-2,1,5,60,1\nA,sku-1,1,5,60,1\n")
    assert read_csv(path) == [
        OrderDraft((("sku-1", 3), ("sku-2", 1)), 5.0, 60.0, 1, "A"),
        OrderDraft((("sku-1", 1),), 0.0, 0.0, 0, "B"),
    ]


@pytest.mark.parametrize(
    "text, message",
    [
        ("reference,sku\n", ":1: there is no column quantity"),
        (GOOD + "A,sku-1,1,,,\nA,sku-9,1,,,\n", ":3: sku 'sku-9' is unknown"),
        (GOOD + "A,sku-1,0,,,\n", ":2: quantity is '0'; a whole number from 1"),
        (GOOD + "A,sku-1,1.5,,,\n", ":2: quantity is '1.5'; a whole number"),
        (GOOD + "A,sku-1,1,soon,,\n", ":2: at is 'soon'; a number from 0"),
        (GOOD + "A,sku-1,1,,,300\n", ":2: priority is '300'; a whole number from 0 to 255"),
        (GOOD + ",sku-1,1,,,\n", ":2: reference is empty"),
        (GOOD + "A,sku-1,1,,,,7\n", ":2: there are more fields than columns"),
        (GOOD + "A,sku-1,1,0,,\nA,sku-2,1,9,,\n", ":3: at, due or priority differ"),
    ],
)
def test_wrong_rows_are_told_with_their_line(tmp_path, text, message):
    path = tmp_path / "orders.csv"
    path.write_text(text)
    with pytest.raises(DemandError) as error:
        read_csv(path, {"sku-1", "sku-2"})
    assert f"{path}{message}" in str(error.value)


COLUMNS, ROWS = "reference;sku;quantity;at\r\n", "Müller;sku-1;2;1,5\r\n;;;\r\n"


@pytest.mark.parametrize(
    "data",
    [
        (COLUMNS + ROWS).encode("utf-8-sig"),
        ('"Reference";"SKU";Quantity;At\r\n' + ROWS).encode(),
        (COLUMNS + ROWS).replace(",", ".").replace(";", "\t").encode(),
        (COLUMNS + ROWS).replace(",", ".").replace(";", ",").encode("utf-8-sig"),
    ],
)
def test_files_as_spreadsheets_write_them(tmp_path, data):
    path = tmp_path / "orders.csv"
    path.write_bytes(data)
    assert read_csv(path) == [OrderDraft((("sku-1", 2),), 1.5, 0.0, 0, "Müller")]


@pytest.mark.parametrize(
    "data, message",
    [
        ((COLUMNS + ROWS).encode("utf-16"), ": is in UTF-16, or not text; save it as CSV in UTF-8"),
        ((COLUMNS + ROWS).encode("utf-16-be"), ": is in UTF-16, or not text"),
        ((COLUMNS + ROWS).encode("cp1252"), ":2: byte 0xfc is not UTF-8; save it as CSV in UTF-8"),
        (b"", ":1: there is no column reference, sku, quantity; the first line has to name"),
        (b"a;b\n", "those in it are: a, b"),
        (b"sku,sku,reference,quantity\n", ":1: there are two columns sku"),
        (GOOD.encode() + b"A,sku-1,2147483647,,,\nA,sku-1,2147483647,,,\n", ":2: A: an order of"),
        (GOOD.encode() + b"x" * 201 + b",sku-1,1,,,\n", ":2: the reference has 201 characters"),
        (GOOD.encode() + b"A\1B,sku-1,1,,,\n", "can't be printed"),
        (GOOD.encode() + b"A,sku-1,1,nan,,\n", ":2: at is 'nan'; a number from 0"),
        (GOOD.encode() + b"A,sku-1," + b"9" * 9999 + b",,,\n", ":2: quantity is '999"),
        (GOOD.encode() + b"A," + b"s" * 200_000 + b",1,,,\n", ":1: field larger than"),
    ],
)
def test_files_that_are_none_of_orders(tmp_path, data, message):
    path = tmp_path / "orders.csv"
    path.write_bytes(data)
    with pytest.raises(DemandError) as error:
        read_csv(path, capacity=1000)
    assert message in str(error.value) and len(str(error.value)) < 400


def test_files_that_are_too_large(tmp_path):
    path = tmp_path / "orders.csv"
    with path.open("w") as file:
        file.write(GOOD)
        file.truncate(100 * 2**20)
    with pytest.raises(DemandError, match="has 100 MB; 64 MB or less were expected"):
        read_csv(path)
    path.write_text(GOOD + "".join(f"A,sku-{i},1,,,\n" for i in range(100_000)))
    with pytest.raises(DemandError, match=":1002: A has more than 1000 lines"):
        read_csv(path)
    with pytest.raises(DemandError, match=f"{tmp_path}: is not a file"):
        read_csv(tmp_path)


@pytest.mark.parametrize(
    "text",
    [
        "fill:99999999999",
        "poisson:1e12",
        "fill:0",
        "fill:x",
        "poisson:-1",
        "poisson:inf",
        "full",
        "x.txt",
    ],
)
def test_what_is_no_demand_is_told(assortment, text):
    with pytest.raises(DemandError, match=f"orders are '{text}'"):
        make_demand(text, assortment, (1, 1), np.random.default_rng(1))


def test_a_text_tells_the_line_and_the_column_of_each_fault():
    text = "reference,sku,quantity\nA,sku-1,2\nB,sku-9,1\nC,sku-1,none\nD,sku-1,1,2\n"
    _, faults = parse_csv(text, {"sku-1"})
    assert [(fault.line, fault.column) for fault in faults] == [
        (3, "sku"),
        (4, "quantity"),
        (5, ""),
    ]
    assert "sku-9" in faults[0].text and not faults[0].text.startswith("orders")


def test_a_text_without_its_columns_says_so():
    orders, faults = parse_csv("name,number\nA,2\n")
    assert orders == [] and (faults[0].line, faults[0].column) == (1, "")
    assert faults[0].text.startswith("there is no column reference, sku, quantity")
