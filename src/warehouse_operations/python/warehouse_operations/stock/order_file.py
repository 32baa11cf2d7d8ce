# SPDX-License-Identifier: Apache-2.0
"""Orders from a CSV file, as a text editor or a spreadsheet writes it.

The first line has names of columns, each further one is an order line:

    reference,sku,quantity,at,due,priority
    A-17,sku-3,2,0,1800,0
    A-17,sku-9,1,0,1800,0

Rows of one reference are one order. `at` [s of the shift] is when it comes (0), `due` when it is to
be complete (0: at any time), `priority` 0 to 255; these three may be left out. Instead of seconds
`at` and `due` may be dates, `2025-03-01 08:15:00`: the shift begins at the first midnight then.
Fields end at commas, semicolons or tabs; the text is UTF-8, with a byte order mark or without.
"""

import os
import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any, NamedTuple

from warehouse_layout.file.csv_table import CsvTable, fields, shown
from warehouse_operations.stock import acceptance

NEEDED, OPTIONAL = ("reference", "sku", "quantity"), ("at", "due", "priority")
MOST_FAULTS = 20
MOST_SECONDS, DAY = 1e9, 86_400.0  # of a time of the shift [s]
LARGE = 1e6  # limit above which a message doesn't name it
TEXT = "orders"  # name in messages of a text in place of a file


class DemandError(ValueError):
    """Raised for invalid orders; names the fault, with its file and line if it has these."""


class Fault(NamedTuple):
    """A fault in a line, counted from 1, and a column; 0 and "": in the whole file."""

    line: int
    column: str
    text: str


class _FieldError(ValueError):
    """Raised for a wrong field of a row."""

    def __init__(self, column: str, text: str) -> None:
        super().__init__(text)
        self.column = column


@dataclass(frozen=True)
class OrderDraft:
    """An order that is not submitted yet, with the time of the shift at which it comes [s]."""

    lines: tuple[tuple[str, int], ...]  # of (sku, pieces)
    at: float = 0.0
    due: float = 0.0
    priority: int = 0
    reference: str = ""


def read_csv(
    path: str | os.PathLike[str],
    skus: Collection[str] | None = None,
    capacity: float = float("inf"),
) -> list[OrderDraft]:
    """Returns the orders of a file. Raises DemandError, which names the line of each wrong row.

    skus: the known SKUs; None: any. capacity: pieces that all bins of the warehouse can hold.
    """
    table = CsvTable(path, NEEDED, OPTIONAL, DemandError)
    orders, faults = _read(table, skus, capacity)
    if faults:
        raise DemandError("\n".join(f"{path}:{fault.line}: {fault.text}" for fault in faults))
    return orders


def lines_by_sku(path: str | os.PathLike[str]) -> Counter[str]:
    """Returns the number of lines by SKU of a file. Raises DemandError."""
    return Counter(sku for order in read_csv(path) for sku, _ in order.lines)


def parse_csv(
    text: str, skus: Collection[str] | None = None, capacity: float = float("inf")
) -> tuple[list[OrderDraft], list[Fault]]:
    """Returns the orders of a text in place of a file, and its first MOST_FAULTS faults; see
    read_csv."""
    try:
        table = CsvTable(TEXT, NEEDED, OPTIONAL, DemandError, text)
        return _read(table, skus, capacity)
    except DemandError as error:
        match = re.match(rf"{TEXT}:(?:(\d+):)? ", str(error))
        start, line = (match.end(), int(match[1] or 0)) if match else (0, 0)
        return [], [Fault(line, "", str(error)[start:])]


def _read(
    table: CsvTable, skus: Collection[str] | None, capacity: float
) -> tuple[list[OrderDraft], list[Fault]]:
    faults: list[Fault] = []
    orders = _Orders(skus, capacity)
    for row in table:
        errors: list[ValueError]
        try:
            errors = [*orders.add(row, table.decimal_comma)]
        except ValueError as error:
            errors = [error]
        faults += [Fault(table.line, getattr(e, "column", ""), str(e)) for e in errors]
        if len(faults) >= MOST_FAULTS:
            break
    return orders.drafts(), faults[:MOST_FAULTS]


class _Orders:
    """Collects rows to orders, by reference."""

    def __init__(self, skus: Collection[str] | None, capacity: float) -> None:
        self._skus, self._capacity = skus, capacity
        self._rows: dict[str, tuple[dict[str, int], tuple[float, float, int]]] = {}
        self._pieces: Counter[str] = Counter()
        self._unknown: set[str] = set()  # SKUs that a fault has named
        self._dated = False  # whether times are dates

    def add(self, row: Mapping[Any, Any], decimal_comma: bool) -> list[_FieldError]:
        """Adds a row; returns the faults of its fields. Raises ValueError with a fault of the row
        as a whole."""
        row = fields(row)
        if not row:
            return []
        if decimal_comma:
            row |= {name: row.get(name, "").replace(",", ".") for name in ("at", "due")}
        faults: list[_FieldError] = []
        values = [
            _tried(read, row, faults)
            for read in (self._reference, self._sku, _quantity, self._at, self._due, _priority)
        ]
        if not faults and None not in values:
            reference, sku, quantity, *rest = values
            self._take(reference, sku, quantity, tuple(rest))
        return faults

    def _take(
        self, reference: str, sku: str, quantity: int, rest: tuple[float, float, int]
    ) -> None:
        lines, first = self._rows.setdefault(reference, ({}, rest))
        if rest != first:
            raise ValueError(f"at, due or priority differ from the first row of {reference}")
        lines[sku] = lines.get(sku, 0) + quantity
        self._pieces[reference] += quantity
        if len(lines) > acceptance.MOST_LINES:
            raise ValueError(f"{reference} has more than {acceptance.MOST_LINES} lines")
        if fault := acceptance.fault_of_pieces(self._pieces[reference], self._capacity):
            raise _FieldError("quantity", f"{reference}: {fault}")

    def _reference(self, row: Mapping[str, str]) -> str:
        reference = row["reference"]
        if not reference:
            raise _FieldError("reference", "reference is empty")
        if fault := acceptance.fault_of_head(reference):
            raise _FieldError("reference", fault)
        return reference

    def _sku(self, row: Mapping[str, str]) -> str | None:
        """Returns a known SKU; None for an unknown one that was named before."""
        sku = row["sku"]
        if sku and (self._skus is None or sku in self._skus):
            return sku
        if sku and sku in self._unknown:
            return None
        self._unknown.add(sku)
        raise _FieldError("sku", f"sku '{shown(sku)}' is unknown: the stock has none of it")

    def _at(self, row: Mapping[str, str]) -> float:
        return self._time(row, "at")

    def _due(self, row: Mapping[str, str]) -> float:
        return self._time(row, "due")

    def _time(self, row: Mapping[str, str], name: str) -> float:
        """Returns a time [s]: of the shift, or of a date, since 1970."""
        text = row.get(name, "")
        date = _date(text)
        if text and date is None and not self._dated:
            return float(_field(row, name, float, 0, MOST_SECONDS))
        if not text and (name == "due" or not self._dated):
            return 0.0
        if date is None or (self._rows and not self._dated):
            raise _FieldError(
                name, f"{name} is '{shown(text)}'; dates in all rows, or in none, were expected"
            )
        self._dated = True
        return date

    def drafts(self) -> list[OrderDraft]:
        """Returns the orders, in the order of their first rows."""
        orders = [
            OrderDraft(tuple(lines.items()), *rest, reference)
            for reference, (lines, rest) in self._rows.items()
        ]
        if not self._dated or not orders:
            return orders
        begin = DAY * (min(order.at for order in orders) // DAY)
        return [
            replace(order, at=order.at - begin, due=max(order.due - begin, 1.0) if order.due else 0)
            for order in orders
        ]


def _tried(
    read: Callable[[Mapping[str, str]], Any], row: Mapping[str, str], faults: list[_FieldError]
) -> Any:
    """Returns the value read from a row; None, and adds a fault, where it is invalid."""
    try:
        return read(row)
    except _FieldError as error:
        faults.append(error)
        return None


def _quantity(row: Mapping[str, str]) -> Any:
    return _field(row, "quantity", int, 1, 2**31 - 1)


def _priority(row: Mapping[str, str]) -> Any:
    return _field(row, "priority", int, 0, 255)


def _date(text: str) -> float | None:
    """Returns a date in ISO form as seconds since 1970; None for other texts."""
    if not re.match(r"\d{4}-\d\d-\d\d", text):
        return None
    try:
        date = datetime.fromisoformat(text)
    except ValueError:
        return None
    # Local times: the offset to UTC would move orders into other hours of the day.
    return date.replace(tzinfo=UTC).timestamp()


def _field(
    row: Mapping[str, str], name: str, kind: Callable[[Any], Any], least: float, most: float
) -> Any:
    text = row.get(name, "")
    if not text and name != "quantity":
        return kind(0)
    try:
        value = kind(text)
    except ValueError:
        value = None
    if value is None or not least <= value <= most:
        what = "a whole number" if kind is int else "a number"
        # A limit far above any order does not help after a typing error.
        is_near = most < LARGE or (value is not None and value > most)
        limit = f"to {most:,.0f}" if is_near else "on"
        raise _FieldError(
            name, f"{name} is '{shown(text)}'; {what} from {least} {limit} was expected"
        )
    return value
