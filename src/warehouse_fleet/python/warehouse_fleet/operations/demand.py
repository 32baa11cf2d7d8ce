# SPDX-License-Identifier: Apache-2.0
"""Where orders and bundles come from: `fill`, `fill:N`, `poisson:PER_HOUR`, a CSV file, or `none`.

A CSV file has a first line with names of columns and then an order line a row:

    reference,sku,quantity,at,due,priority
    A-17,sku-3,2,0,1800,0
    A-17,sku-9,1,0,1800,0

Rows of one reference are one order. `at` [s of the shift] is when it comes (0), `due` when it is to
be complete (0: at any time), `priority` 0 to 255; these three may be left out.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from warehouse_fleet.operations.inventory import ROOMY

FILL = 200  # orders that wait at any time
POISSON = 160.0  # orders a picking station and hour
BUNDLES = 45.0  # bundles a replenishing station and hour, with poisson
LINES, LINE_SHARES = (1, 2, 3, 4), np.array([0.554, 0.350, 0.088, 0.009])
PIECES_MEAN, PIECES_DEVIATION, PIECES_LEAST, PIECES_MOST = 1.0, 0.3, 1, 3
DUE_SOON, DUE_SOON_SHARE, DUE_LATER = 30 * 60.0, 0.2, 2 * 3600.0
BUNDLE_LEAST, BUNDLE_MOST = 4, ROOMY


class DemandError(ValueError):
    """What was asked for can't be had: the text names what, or the file and line."""


@dataclass(frozen=True)
class Wanted:
    """An order before it is one."""

    lines: tuple  # of (sku, pieces)
    at: float = 0.0
    due: float = 0.0
    priority: int = 0
    reference: str = ""


class Customers:
    """Draws orders from an assortment; the same generator state gives the same orders."""

    def __init__(self, assortment, rng):
        self.assortment, self._rng = assortment, rng

    def order(self, now, in_stock):
        """A Wanted of SKUs that in_stock(sku) has pieces of; None if there are none."""
        rng = self._rng
        count = int(rng.choice(LINES, p=LINE_SHARES / LINE_SHARES.sum()))
        lines = {}
        for _ in range(count * 20):
            sku = self.assortment.skus[self._draw()]
            pieces = round(rng.normal(PIECES_MEAN, PIECES_DEVIATION))
            pieces = min(max(pieces, PIECES_LEAST), PIECES_MOST)
            if sku not in lines and in_stock(sku) >= pieces:
                lines[sku] = pieces
                if len(lines) == count:
                    break
        if not lines:
            return None
        due = DUE_SOON if rng.random() < DUE_SOON_SHARE else DUE_LATER
        return Wanted(tuple(lines.items()), now, now + due)

    def _draw(self):
        if not hasattr(self, "_sums"):
            self._sums = np.cumsum(self.assortment.popularity)
        at = np.searchsorted(self._sums, self._rng.random() * self._sums[-1], side="right")
        return int(min(at, len(self._sums) - 1))


class Fill:
    """So many orders wait at any time."""

    def __init__(self, customers, waiting=FILL):
        self.customers, self.waiting = customers, waiting
        self.bundles_per_hour = 0.0

    def next_time(self):
        return float("inf")

    def due(self, now, backlog, in_stock):
        """The orders that come now."""
        for _ in range(self.waiting - len(backlog)):
            wanted = self.customers.order(now, in_stock)
            if wanted is None:
                return
            yield wanted


class Poisson:
    """Orders come by chance, so many an hour on the average; bundles likewise."""

    def __init__(self, customers, per_hour, bundles_per_hour, rng, now=0.0):
        self.customers, self.per_hour, self._rng = customers, per_hour, rng
        self.bundles_per_hour = bundles_per_hour
        self._next = now
        self._wait()

    def next_time(self):
        return self._next

    def due(self, now, backlog, in_stock):
        while self._next <= now:
            wanted = self.customers.order(self._next, in_stock)
            self._wait()
            if wanted:
                yield wanted

    def _wait(self):
        self._next += self._rng.exponential(3600.0 / self.per_hour)


class FromFile:
    """The orders of a CSV file."""

    bundles_per_hour = 0.0

    def __init__(self, wanted):
        self._wanted = sorted(wanted, key=lambda one: one.at)[::-1]

    def next_time(self):
        return self._wanted[-1].at if self._wanted else float("inf")

    def due(self, now, backlog, in_stock):
        while self.next_time() <= now:
            yield self._wanted.pop()


def make_demand(text, assortment, stations, rng, now=0.0):
    """What the orders' text of operations.launch and simulate means; raises DemandError.

    stations: (picking, replenishing), how many. now: when it begins [s].
    """
    customers = Customers(assortment, rng)
    name, _, value = str(text).partition(":")
    if text == "none":
        return FromFile([])
    if name == "fill":
        return Fill(customers, int(_number(text, value, FILL, whole=True)))
    if name == "poisson":
        per_hour = _number(text, value, POISSON * stations[0])
        return Poisson(customers, per_hour, BUNDLES * stations[1], rng, now)
    if str(text).endswith(".csv"):
        return FromFile(read_csv(text, set(assortment.skus)))
    raise DemandError(
        f"orders are '{text}'; fill, fill:N, poisson:PER_HOUR, FILE.csv or none was expected"
    )


def _number(text, value, default, whole=False):
    if not value:
        return default
    try:
        number = int(value) if whole else float(value)
    except ValueError:
        number = 0
    if not 0 < number < float("inf"):
        raise DemandError(f"orders are '{text}'; a number above 0 was expected after the colon")
    return number


def read_csv(path, skus=None):
    """The Wanted of a file; raises DemandError that names each wrong row's line.

    skus: those that are known; None: any.
    """
    rows, wrong = {}, []
    try:
        with Path(path).open(newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            lacking = [
                c for c in ("reference", "sku", "quantity") if c not in (reader.fieldnames or ())
            ]
            if lacking:
                raise DemandError(f"{path}:1: there is no column {', '.join(lacking)}")
            for row in reader:
                try:
                    _add(rows, row, skus)
                except ValueError as error:
                    wrong.append(f"{path}:{reader.line_num}: {error}")
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise DemandError(f"{path}: {getattr(error, 'strerror', None) or error}") from error
    if wrong:
        raise DemandError("\n".join(wrong[:20]))
    return [
        Wanted(tuple(lines.items()), *rest, reference) for reference, (lines, rest) in rows.items()
    ]


def _add(rows, row, skus):
    if None in row:
        raise ValueError("there are more fields than columns")
    reference = (row["reference"] or "").strip()
    if not reference:
        raise ValueError("reference is empty")
    sku = (row["sku"] or "").strip()
    if not sku or (skus is not None and sku not in skus):
        raise ValueError(f"sku '{sku}' is unknown")
    quantity = _field(row, "quantity", int, 1, 2**31)
    rest = (
        _field(row, "at", float, 0, 1e9),
        _field(row, "due", float, 0, 1e9),
        _field(row, "priority", int, 0, 255),
    )
    lines, first = rows.setdefault(reference, ({}, rest))
    if rest != first:
        raise ValueError(f"at, due or priority differ from the first row of {reference}")
    lines[sku] = lines.get(sku, 0) + quantity


def _field(row, name, kind, least, most):
    text = (row.get(name) or "").strip()
    if not text and name != "quantity":
        return kind(0)
    try:
        value = kind(text)
    except ValueError:
        value = None
    if value is None or not least <= value <= most:
        what = "a whole number" if kind is int else "a number"
        raise ValueError(f"{name} is '{text}'; {what} from {least} to {most:g} was expected")
    return value
