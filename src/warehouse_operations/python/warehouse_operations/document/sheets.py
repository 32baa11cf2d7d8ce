# SPDX-License-Identifier: Apache-2.0
"""Tables for a spreadsheet: CSV and XLSX, within a page and beside it."""

import base64
import csv
import io
from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

Rows = Sequence[Sequence[Any]]  # the first are the headings
CSV_TYPE = "text/csv"
XLSX_TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
WRITTEN = datetime(2000, 1, 1)  # the same figures make the same file
WIDEST = 40  # of a column [characters]


def links(tables: Mapping[str, Rows], name: str = "figures") -> str:
    """Returns HTML links to files that the page itself holds: a workbook, and each table as CSV."""
    files = [
        _link(f"{title}.csv", to_csv(rows).encode(), CSV_TYPE) for title, rows in tables.items()
    ]
    if workbook := to_xlsx(tables):
        files.insert(0, _link(f"{name}.xlsx", workbook, XLSX_TYPE))
    return f'<p class="export">For a spreadsheet: {" ".join(files)}</p>'


def to_csv(rows: Rows) -> str:
    """Returns a table as CSV."""
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()


def to_xlsx(tables: Mapping[str, Rows]) -> bytes:
    """Returns a workbook with a sheet for each table; b"" where XlsxWriter is not installed."""
    try:
        import xlsxwriter  # noqa: PLC0415 (a wheel goes without)
    except ImportError:
        return b""
    out = io.BytesIO()
    # Texts that begin with = or are addresses stay texts.
    plain = {"strings_to_formulas": False, "strings_to_urls": False, "in_memory": True}
    with xlsxwriter.Workbook(out, plain | {"nan_inf_to_errors": True}) as book:
        book.set_properties({"created": WRITTEN})
        head = book.add_format({"bold": True, "bottom": 1})
        for title, rows in tables.items():
            _fill(book.add_worksheet(title), rows, head)
    return out.getvalue()


def write_xlsx(path: Path, tables: Mapping[str, Rows]) -> None:
    """Writes a workbook, if XlsxWriter is installed."""
    if workbook := to_xlsx(tables):
        path.write_bytes(workbook)


def _fill(sheet: Any, rows: Rows, head: Any) -> None:
    for number, row in enumerate(rows):
        sheet.write_row(number, 0, row, head if not number else None)
    for column, cells in enumerate(zip(*rows)):
        sheet.set_column(column, column, min(max(len(str(cell)) for cell in cells) + 2, WIDEST))
    sheet.freeze_panes(1, 0)
    if rows:
        sheet.autofilter(0, 0, len(rows) - 1, len(rows[0]) - 1)


def _link(name: str, content: bytes, kind: str) -> str:
    text = base64.b64encode(content).decode()
    return f'<a download="{name}" href="data:{kind};base64,{text}">{name}</a>'
