# SPDX-License-Identifier: Apache-2.0
"""Describes the orders of a CSV file: when they come, how large they are, what they ask for."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from warehouse_layout.file.csv_table import CsvTable, fields
from warehouse_operations.stock.demand_file import Demand, Due
from warehouse_operations.stock.order_file import (
    NEEDED,
    OPTIONAL,
    DemandError,
    OrderDraft,
    read_csv,
)

DAY = 86_400.0  # [s]
QUANTILES = 21  # of the time until orders are due
CLASSES = {"A": 0.8, "B": 0.95, "C": 1.0}  # share of the lines up to which a class reaches
MOST_EXPONENT = 5.0


@dataclass(frozen=True)
class Orders:
    """The orders of a file, and in which rows SKUs are asked for again.

    repeated: (line of the file, reference, SKU) of rows whose order has that SKU already.
    """

    path: str
    orders: Sequence[OrderDraft]
    rows: int
    repeated: Sequence[tuple[int, str, str]]

    @classmethod
    def read(cls, path: str | Path) -> "Orders":
        """Reads a CSV file (order_file). Raises DemandError."""
        orders = read_csv(path)
        if not orders:
            raise DemandError(f"{path}: there is no order in it")
        table = CsvTable(path, NEEDED, OPTIONAL, DemandError)
        known: set[tuple[str, str]] = set()
        rows, repeated = 0, []
        for line, reference, sku in _rows(table):
            rows += 1
            if (reference, sku) in known:
                repeated.append((line, reference, sku))
            known.add((reference, sku))
        return cls(str(path), orders, rows, repeated)

    @property
    def days(self) -> list[int]:
        """The numbers of the days on which orders come, from 0; without those between them."""
        return sorted({int(order.at // DAY) for order in self.orders})


def _rows(table: CsvTable) -> Iterator[tuple[int, str, str]]:
    for row in table:
        if texts := fields(row):
            yield table.line, texts["reference"], texts["sku"]


def describe(orders: Orders, interval_s: float) -> Demand:
    """Returns the Demand that orders make, in intervals of a length [s]."""
    by_day = Counter(int(order.at // DAY) for order in orders.orders)
    mean = len(orders.orders) / len(by_day)
    lines = Counter(len(order.lines) for order in orders.orders)
    pieces = Counter(n for order in orders.orders for _, n in order.lines)
    asked = Counter(sku for order in orders.orders for sku, _ in order.lines)
    skus = dict(asked.most_common())
    return Demand(
        Path(orders.path).name,
        interval_s,
        _profile(orders, interval_s, len(by_day)),
        _shares(lines),
        _shares(pieces),
        due_of(orders.orders),
        skus,
        len(by_day),
        round(max(by_day.values()) / mean, 4),
        round(len(orders.repeated) / orders.rows, 6),
        round(exponent(list(skus.values())), 4),
        classes(skus),
    )


def _profile(orders: Orders, interval_s: float, days: int) -> tuple[float, ...]:
    """Returns how many orders come in each interval of an average day, up to the last."""
    counts = Counter(int(order.at % DAY // interval_s) for order in orders.orders)
    return tuple(round(counts[i] / days, 4) for i in range(max(counts) + 1))


def _shares(counts: Mapping[int, int]) -> dict[int, float]:
    total = sum(counts.values())
    return {n: round(counts[n] / total, 6) for n in sorted(counts)}


def due_of(orders: Sequence[OrderDraft]) -> Due:
    """Returns the time that orders have until they are due."""
    left = [max(order.due - order.at, 0.0) for order in orders if order.due]
    if not left:
        return Due()
    quantiles = np.quantile(left, np.linspace(0, 1, QUANTILES))
    return Due(round(1 - len(left) / len(orders), 6), tuple(np.round(quantiles, 1).tolist()))


def exponent(lines: Sequence[int]) -> float:
    """Returns the exponent s of Zipf's law, lines proportional to 1 / rank**s, of largest
    likelihood; lines: of each SKU, the most popular first."""
    if len(lines) < 2:
        return 0.0
    weights = np.asarray(lines, float)
    ranks = np.log(np.arange(1, len(lines) + 1))
    mean = float(weights @ ranks / weights.sum())

    def expected(s: float) -> float:
        """Returns the mean logarithm of the rank under Zipf's law."""
        shares = np.exp(-s * ranks)
        return float(shares @ ranks / shares.sum())

    low, high = 0.0, MOST_EXPONENT  # expected() falls with s
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if expected(middle) > mean else (low, middle)
    return (low + high) / 2


def classes(skus: Mapping[str, int]) -> dict[str, dict[str, float]]:
    """Returns the share of the SKUs and of the lines that each class has: A is the fewest SKUs with
    80 % of the lines, B those up to 95 %, C the rest."""
    shares = np.cumsum(list(skus.values())) / sum(skus.values())
    out, begin, lines = {}, 0, 0.0
    for name, reach in CLASSES.items():
        end = min(int(np.searchsorted(shares, reach - 1e-9)) + 1, len(skus))
        end = max(end, begin)
        upto = float(shares[end - 1]) if end else 0.0
        out[name] = {
            "skus": round((end - begin) / len(skus), 4),
            "lines": round(upto - lines, 4) if end > begin else 0.0,
        }
        begin, lines = end, upto
    return out


def sentences(demand: Demand) -> Iterator[str]:
    """Yields sentences for people that summarise a description."""
    hours = demand.seconds / 3600
    days = f"{demand.days:,} days of" if demand.days > 1 else "A day of"
    yield (
        f"{days} {demand.orders_a_day:,.0f} orders in {hours:g} h;"
        f" the peak is {demand.peak_per_hour:,.0f} orders an hour,"
        f" {demand.peak_per_hour / (demand.orders_a_day / hours):.2f} times the mean."
    )
    if demand.days > 1:
        yield (
            f"The busiest day has {demand.busiest:.2f} times the orders of an average one:"
            f" `demand:FILE*{demand.busiest:.2f}` draws days like it."
        )
    yield (
        f"An order has {demand.lines_an_order:.2f} lines, a line {demand.pieces_a_line:.2f} pieces;"
        f" {100 * demand.repeated:.1f} % of the rows ask for a SKU that the order has already."
    )
    a = demand.classes["A"]
    yield (
        f"{len(demand.skus):,} SKUs: {100 * a['skus']:.0f} % of them take"
        f" {100 * a['lines']:.0f} % of the lines (exponent {demand.exponent:.2f})."
    )
    yield _due_sentence(demand.due)


def _due_sentence(due: Due) -> str:
    if not due.seconds:
        return "No order has a due time."
    middle = due.seconds[len(due.seconds) // 2] / 60
    some = f"; {100 * due.none:.0f} % have none" if due.none else ""
    low, high = due.seconds[0] / 60, math.ceil(due.seconds[-1]) / 60
    return f"Orders are due within {low:,.0f} to {high:,.0f} min, half of them {middle:,.0f}{some}."
