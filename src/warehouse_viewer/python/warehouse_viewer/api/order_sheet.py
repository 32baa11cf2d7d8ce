# SPDX-License-Identifier: Apache-2.0
"""Orders as sheets for a spreadsheet, CSV and XLSX: a row for each line of an order."""

import csv
import io
from collections.abc import Iterable, Iterator
from typing import Any

import xlsxwriter

from warehouse_viewer.page.journal import cell

COLUMNS = (
    "order_id",
    "reference",
    "state",
    "station",
    "priority",
    "created",
    "due",
    "completed",
    "sku",
    "quantity",
    "picked",
)
TIMES = ("created", "due", "completed")  # [s], simulated


def rows(orders: Iterable[dict[str, Any]]) -> Iterator[list[Any]]:
    """Yields the COLUMNS of each line of orders as JSON; an unset time is empty."""
    for order in orders:
        head = [order[name] or "" if name in TIMES else order[name] for name in COLUMNS[:-3]]
        for line in order["lines"]:
            yield [*head, *(line[name] for name in COLUMNS[-3:])]


def as_csv(orders: Iterable[dict[str, Any]]) -> bytes:
    """Returns a sheet as CSV, in UTF-8 with a byte order mark, by which spreadsheets know it."""
    text = io.StringIO()
    table = csv.writer(text)
    table.writerow(COLUMNS)
    table.writerows([cell(value) for value in row] for row in rows(orders))
    return text.getvalue().encode("utf-8-sig")


def as_xlsx(orders: Iterable[dict[str, Any]]) -> bytes:
    """Returns a sheet as XLSX: a bold first row that stays in sight and filters; no formulas."""
    data = io.BytesIO()
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}
    with xlsxwriter.Workbook(data, options) as book:
        sheet = book.add_worksheet("Orders")
        sheet.write_row(0, 0, COLUMNS, book.add_format({"bold": True}))
        last = 0
        for last, row in enumerate(rows(orders), 1):
            sheet.write_row(last, 0, row)
        sheet.freeze_panes(1, 0)
        sheet.autofilter(0, 0, max(last, 1), len(COLUMNS) - 1)
        sheet.set_column(0, len(COLUMNS) - 1, 12)
    return data.getvalue()
