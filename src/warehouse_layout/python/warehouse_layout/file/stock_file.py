# SPDX-License-Identifier: Apache-2.0
"""The initial stock of a warehouse, from a CSV file: a row an item, which is a bin of one SKU.

    sku,quantity,storage_unit
    bolt-m8,20,1
    nut-m8,0,storage_unit7

A storage unit goes by its number or its name, from 1 to how many stand in the warehouse.
"""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from warehouse_layout.file.csv_table import CsvTable, fields, shown
from warehouse_layout.file.items import CAPACITY
from warehouse_layout.file.request import LIMITS

COLUMNS = ("sku", "quantity", "storage_unit")
MOST_PIECES, LONGEST_SKU = 100_000, 100
UNIT = "storage_unit"


class StockFileError(ValueError):
    """Says what is wrong in a stock file, with its name, the line and the column."""


@dataclass(frozen=True)
class StockRow:
    """Pieces of one SKU in a bin on a storage unit, numbered from 1."""

    sku: str
    quantity: int
    unit: int


def read(path: str | Path, units: int) -> list[StockRow]:
    """Reads the stock of a warehouse with `units` storage units. Raises StockFileError."""
    table = CsvTable(path, COLUMNS, error=StockFileError)
    rows: list[StockRow] = []
    bins: Counter[int] = Counter()
    for texts in table:
        try:
            row = _row(fields(texts), units)
            if row is None:
                continue
            bins[row.unit] += 1
            if bins[row.unit] > CAPACITY:
                raise ValueError(f"column {UNIT}: unit {row.unit} has more than {CAPACITY} rows")
        except ValueError as error:
            raise StockFileError(f"{path}:{table.line}: {error}") from error
        rows.append(row)
        if len(rows) > LIMITS["items"]:
            raise StockFileError(f"{path}:{table.line}: more than {LIMITS['items']} rows")
    return rows


def _row(texts: dict[str, str], units: int) -> StockRow | None:
    if not texts:
        return None
    sku = texts["sku"]
    if not sku or not sku.isprintable() or len(sku) > LONGEST_SKU:
        raise ValueError(
            f"column sku is '{shown(sku)}'; 1 to {LONGEST_SKU} characters were expected"
        )
    quantity = _number("quantity", texts["quantity"], 0, MOST_PIECES)
    unit = _number(UNIT, texts[UNIT].removeprefix(UNIT), 1, units)
    return StockRow(sku, quantity, unit)


def _number(column: str, text: str, least: int, most: int) -> int:
    # int() would take 1_000 and digits of other scripts.
    right = text.isascii() and text.isdigit() and len(text) <= 9 and least <= int(text) <= most
    if not right:
        expected = f"a whole number from {least} to {most} was expected"
        if column == UNIT:
            expected = f"{expected}, the storage units of the warehouse"
        raise ValueError(f"column {column} is '{shown(text)}'; {expected}")
    return int(text)
