# SPDX-License-Identifier: Apache-2.0
"""The stock of a layout: rows become items on units, and wrong ones are named."""

import pytest

from warehouse_layout.file import layout_file, stock_file
from warehouse_layout.file.stock_file import StockFileError, StockRow
from warehouse_layout.place import placement

HEAD = "sku,quantity,storage_unit\n"


def test_rows_are_bins_on_units(tmp_path):
    path = tmp_path / "stock.csv"
    path.write_text(HEAD + "bolt,20,1\n\nnut,0,storage_unit3\n")
    assert stock_file.read(path, units=3) == [StockRow("bolt", 20, 1), StockRow("nut", 0, 3)]
    path.write_text("storage_unit;sku;quantity;note\n2;Müller;7;x\n")
    assert stock_file.read(path, units=3) == [StockRow("Müller", 7, 2)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (HEAD + "bolt,x,1\n", ":2: column quantity is 'x'; a whole number from 0 to 100000"),
        (HEAD + "bolt,-1,1\n", ":2: column quantity is '-1'"),
        (
            HEAD + "bolt,1,1\nnut,1,4\n",
            ":3: column storage_unit is '4'; a whole number from 1 to 3",
        ),
        (HEAD + "bolt,1,storage_unit\n", ":2: column storage_unit is ''"),
        (HEAD + ",1,1\n", ":2: column sku is ''; 1 to 100 characters"),
        (HEAD + "bolt,1,1,9\n", ":2: there are more fields than columns"),
        (HEAD + "bolt,1,1\n" * 100, "column storage_unit: unit 1 has more than"),
        ("sku,quantity\nbolt,1\n", ":1: there is no column storage_unit; the first line has to"),
        (HEAD.strip() + ",sku\n", ":1: there are two columns sku"),
        ("\0\1", "is in UTF-16, or not text"),
    ],
)
def test_wrong_rows_are_told_with_line_and_column(text, message, tmp_path):
    path = tmp_path / "stock.csv"
    path.write_text(text)
    with pytest.raises(StockFileError) as error:
        stock_file.read(path, units=3)
    assert str(error.value).startswith(str(path)) and message in str(error.value)


def test_items_lie_apart_on_the_units_of_their_rows(tmp_path):
    (tmp_path / "s.csv").write_text(HEAD + "a,1,2\nb,1,1\nc,1,2\nd,1,2\n")
    path = tmp_path / "one.layout.yaml"
    path.write_text(
        "layout: 1\nfloor: |\n  ....\n  .ss.\n  ....\nstorage_units: 1.0\nstock: s.csv\n"
    )
    laid = placement.place(layout_file.read(path))
    assert laid.item_unit.tolist() == [1, 0, 1, 1]
    on_second = laid.item_place[laid.item_unit == 1]
    assert len({tuple(at) for at in on_second}) == 3
