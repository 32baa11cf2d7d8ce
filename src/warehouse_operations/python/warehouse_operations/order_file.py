# SPDX-License-Identifier: Apache-2.0
"""Orders from a CSV file, as a text editor or a spreadsheet writes it.

The first line has names of columns, each further one is an order line:

    reference,sku,quantity,at,due,priority
    A-17,sku-3,2,0,1800,0
    A-17,sku-9,1,0,1800,0

Rows of one reference are one order. `at` [s of the shift] is when it comes (0), `due` when it is to
be complete (0: at any time), `priority` 0 to 255; these three may be left out. Fields end at
commas, semicolons or tabs; the text is UTF-8, with a byte order mark or without.
"""

import codecs
import csv
import io
import os
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from warehouse_operations import acceptance
from warehouse_operations.acceptance import shown

NEEDED, OPTIONAL = ("reference", "sku", "quantity"), ("at", "due", "priority")
SEPARATORS = ",;\t"
MOST_BYTES, MOST_ROWS, MOST_FAULTS = 64 * 2**20, 500_000, 20
UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
SAVE_AS = "save it as CSV in UTF-8 (in spreadsheets: 'CSV UTF-8')"


class DemandError(ValueError):
    """Raised for orders that can't be taken; names what is wrong, or the file and line."""


@dataclass(frozen=True)
class Wanted:
    """An order to be submitted at a time of the shift; times are [s]."""

    lines: tuple[tuple[str, int], ...]  # of (sku, pieces)
    at: float = 0.0
    due: float = 0.0
    priority: int = 0
    reference: str = ""


def read_csv(
    path: str | os.PathLike[str],
    skus: Collection[str] | None = None,
    capacity: float = float("inf"),
) -> list[Wanted]:
    """Returns the orders of a file. Raises DemandError, which names the line of each wrong row.

    skus: the known SKUs; None: any. capacity: pieces that all bins of the warehouse can hold.
    """
    text = _text(path)
    reader = _reader(path, text)
    wrong: list[str] = []
    orders = _Orders(skus, capacity)
    try:
        for count, row in enumerate(reader):
            if count == MOST_ROWS:
                raise DemandError(f"{path}: more than {MOST_ROWS} rows; split the file")
            try:
                orders.add(row, reader.decimal_comma)
            except ValueError as error:
                wrong.append(f"{path}:{reader.line_num}: {error}")
            if len(wrong) == MOST_FAULTS:
                break
    except csv.Error as error:
        raise DemandError(f"{path}:{reader.line_num}: {error}") from error
    if wrong:
        raise DemandError("\n".join(wrong))
    return orders.wanted()


def _text(path: str | os.PathLike[str]) -> str:
    path = Path(path)
    try:
        if path.exists() and not path.is_file():
            raise DemandError(f"{path}: is no file")
        if (size := path.stat().st_size) > MOST_BYTES:
            raise DemandError(
                f"{path}: has {size >> 20} MB; {MOST_BYTES >> 20} MB or less were expected; "
                "split the file"
            )
        data = path.read_bytes()
    except OSError as error:
        raise DemandError(f"{path}: {error.strerror}") from error
    if data.startswith(UTF_16) or b"\0" in data[:200]:
        raise DemandError(f"{path}: is in UTF-16, or no text; {SAVE_AS}")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        byte = data[error.start]
        raise DemandError(f"{path}:{line}: byte {byte:#x} is not UTF-8; {SAVE_AS}") from error


class _Rows(csv.DictReader):
    decimal_comma = False  # 1,5 is one and a half


def _reader(path: str | os.PathLike[str], text: str) -> _Rows:
    """Returns a reader of the rows, by names of columns. Raises DemandError if one is missing."""
    first = text.partition("\n")[0].lower()

    def known(separator: str) -> list[str]:
        return [c for c in (*NEEDED, *OPTIONAL) if c in _names(first.split(separator))]

    separator = max(SEPARATORS, key=lambda one: (len(known(one)), first.count(one)))
    rows = _Rows(io.StringIO(text, newline=""), delimiter=separator)
    rows.decimal_comma = separator == ";"
    names = rows.fieldnames = _names(rows.fieldnames or ())
    lacking = [name for name in NEEDED if name not in names]
    if lacking:
        found = shown(", ".join(filter(None, names))) or "none"
        raise DemandError(
            f"{path}:1: there is no column {', '.join(lacking)}; the first line has to name the "
            f"columns, those in it are: {found}"
        )
    twice = [name for name in (*NEEDED, *OPTIONAL) if names.count(name) > 1]
    if twice:
        raise DemandError(f"{path}:1: there are two columns {twice[0]}")
    return rows


def _names(fields: Iterable[str]) -> list[str]:
    return [field.strip().strip('"').lower() for field in fields]


class _Orders:
    """Collects rows to orders, by reference."""

    def __init__(self, skus: Collection[str] | None, capacity: float) -> None:
        self._skus, self._capacity = skus, capacity
        self._rows: dict[str, tuple[dict[str, int], tuple[float, float, int]]] = {}
        self._pieces: Counter[str] = Counter()

    def add(self, row: Mapping[Any, Any], decimal_comma: bool) -> None:
        """Adds a row. Raises ValueError, which says what is wrong with it."""
        if None in row:
            raise ValueError("there are more fields than columns")
        row = {name: (text or "").strip() for name, text in row.items()}
        if not any(row.values()):
            return
        reference, sku = row["reference"], row["sku"]
        if not reference:
            raise ValueError("reference is empty")
        if fault := acceptance.fault_of_head(reference):
            raise ValueError(fault)
        if not sku or (self._skus is not None and sku not in self._skus):
            raise ValueError(f"sku '{shown(sku)}' is unknown")
        quantity = _field(row, "quantity", int, 1, 2**31 - 1)
        if decimal_comma:
            row |= {name: row.get(name, "").replace(",", ".") for name in ("at", "due")}
        rest = (
            _field(row, "at", float, 0, 1e9),
            _field(row, "due", float, 0, 1e9),
            _field(row, "priority", int, 0, 255),
        )
        lines, first = self._rows.setdefault(reference, ({}, rest))
        if rest != first:
            raise ValueError(f"at, due or priority differ from the first row of {reference}")
        lines[sku] = lines.get(sku, 0) + quantity
        self._pieces[reference] += quantity
        if len(lines) > acceptance.MOST_LINES:
            raise ValueError(f"{reference} has more than {acceptance.MOST_LINES} lines")
        if fault := acceptance.fault_of_pieces(self._pieces[reference], self._capacity):
            raise ValueError(f"{reference}: {fault}")

    def wanted(self) -> list[Wanted]:
        """Returns the orders, in the order of their first rows."""
        return [
            Wanted(tuple(lines.items()), *rest, reference)
            for reference, (lines, rest) in self._rows.items()
        ]


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
        raise ValueError(f"{name} is '{shown(text)}'; {what} from {least} to {most:g} was expected")
    return value
