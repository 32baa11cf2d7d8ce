# SPDX-License-Identifier: Apache-2.0
"""A description of demand, `NAME.demand.yaml`, and the days that are drawn from it.

    demand: 1
    of: orders.csv               # what it was made of
    interval_s: 3600
    orders: [120.0, 180.0]       # that come in each interval of a day, on the average
    lines: {1: 0.6, 2: 0.4}      # share of the orders by their count of lines
    pieces: {1: 0.9, 2: 0.1}     # share of the lines by their count of pieces
    due: {none: 0.2, seconds: [600, 7200]}  # orders without, and quantiles of the others' time
    skus: {red: 420, blue: 13}   # lines that ask for each

The rest (days, busiest, repeated, exponent, classes) is for readers.
"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from warehouse_operations.stock.acceptance import MOST_LINES
from warehouse_operations.stock.lined_yaml import LinedYaml, Place, shown
from warehouse_operations.stock.order_file import DemandError, OrderDraft
from warehouse_operations.stock.orders import Backlog

VERSION = 1
TRIES = 20  # most SKUs drawn for a line before one is in stock
MOST_INTERVALS = 24 * 60
MOST_ORDERS = 1e6  # of an interval
KEYS = {"demand", "of", "interval_s", "orders", "lines", "pieces", "due", "skus"}
FOR_READERS = {"days", "busiest", "repeated", "exponent", "classes"}


@dataclass(frozen=True)
class Due:
    """The time from an order's arrival until it is due. none: share of the orders without a due
    time.

    seconds: quantiles of the others' times, evenly spaced from the least to the largest [s].
    """

    none: float = 1.0
    seconds: tuple[float, ...] = ()

    def draw(self, now: float, rng: np.random.Generator) -> float:
        """Draws the due time of an order that comes now [s]; 0: at any time."""
        chance, place = rng.random(2)
        if chance < self.none or not self.seconds:
            return 0.0
        at = place * (len(self.seconds) - 1)
        return now + float(np.interp(at, range(len(self.seconds)), self.seconds))


@dataclass(frozen=True)
class Demand:
    """The demand of a day: see the head of this module."""

    of: str
    interval_s: float
    orders: tuple[float, ...]
    lines: Mapping[int, float]
    pieces: Mapping[int, float]
    due: Due
    skus: Mapping[str, int]
    days: int = 1
    busiest: float = 1.0  # orders of the busiest day over those of an average day
    repeated: float = 0.0  # share of the rows that repeat a SKU of their order
    exponent: float = 0.0  # of the popularity over the rank
    classes: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        """The length of a day [s]."""
        return self.interval_s * len(self.orders)

    @property
    def orders_a_day(self) -> float:
        """Orders of a day, on the average."""
        return sum(self.orders)

    @property
    def peak_per_hour(self) -> float:
        """Orders an hour in the busiest interval."""
        return max(self.orders) * 3600 / self.interval_s

    @property
    def lines_an_order(self) -> float:
        """Lines of an order, on the average."""
        return _mean(self.lines)

    @property
    def pieces_a_line(self) -> float:
        """Pieces of a line, on the average."""
        return _mean(self.pieces)


def _mean(shares: Mapping[int, float]) -> float:
    return sum(n * share for n, share in shares.items()) / sum(shares.values())


def write(demand: Demand, path: str | Path) -> None:
    """Writes a description. Raises DemandError where the file can't be written."""
    content = {"demand": VERSION} | asdict(demand)
    content |= {"orders": list(demand.orders), "due": _due_json(demand.due)}
    content["skus"] = content.pop("skus")  # the longest comes last
    lines = [f"{key}: {_flow(value)}" for key, value in content.items() if key != "skus"]
    skus = yaml.safe_dump({"skus": dict(demand.skus)}, sort_keys=False, allow_unicode=True)
    try:
        Path(path).write_text("\n".join([*lines, skus]), encoding="utf-8")
    except OSError as error:
        raise DemandError(f"{path}: {error.strerror}") from error


def _flow(value: Any) -> str:
    text = yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=96)
    return text.strip().removesuffix("\n...")


def _due_json(due: Due) -> dict[str, Any]:
    return {"none": due.none, "seconds": list(due.seconds)}


def read(path: str | Path) -> Demand:
    """Reads a description. Raises DemandError, which names file, line and field."""
    return _Reader(LinedYaml(path, DemandError)).read()


class _Reader:
    """Reads a description, and names its faults."""

    def __init__(self, file: LinedYaml) -> None:
        self._file, self._content = file, file.content

    def read(self) -> Demand:
        """Returns the description. Raises DemandError."""
        content = self._content
        if not isinstance(content, dict):
            raise self._file.fault((), "a description of demand was expected: `demand` makes one")
        for key in content:
            if key not in KEYS | FOR_READERS:
                raise self._file.fault(
                    (key,), f"is unknown; {', '.join(sorted(KEYS))} were expected"
                )
        for key in sorted(KEYS - {"of", "demand"}):
            if key not in content:
                raise self._file.fault((), f"{key} is missing")
        interval = self._number(("interval_s",), content["interval_s"], 1, 86_400)
        return Demand(
            str(content.get("of", "")),
            interval,
            self._orders(content["orders"]),
            self._shares("lines", MOST_LINES),
            self._shares("pieces", 1e9),
            self._due(content["due"]),
            self._skus(content["skus"]),
            **{key: content[key] for key in FOR_READERS & content.keys()},
        )

    def _number(self, place: Place, value: Any, least: float, most: float) -> float:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not is_number or not least <= value <= most:
            raise self._file.fault(
                place, f"is {shown(value)}; a number from {least:g} to {most:g} was expected"
            )
        return float(value)

    def _orders(self, value: Any) -> tuple[float, ...]:
        if not isinstance(value, list) or not 0 < len(value) <= MOST_INTERVALS:
            raise self._file.fault(("orders",), "has to be a list, a number for each interval")
        numbers = enumerate(value)
        orders = tuple(self._number(("orders", i), number, 0, MOST_ORDERS) for i, number in numbers)
        if not sum(orders):
            raise self._file.fault(("orders",), "are 0 all day; there is nothing to draw")
        return orders

    def _shares(self, key: str, most: float) -> dict[int, float]:
        value = self._content[key]
        if not isinstance(value, dict) or not value:
            raise self._file.fault((key,), "has to be a share for each count, as {1: 0.6, 2: 0.4}")
        shares = {}
        for count, share in value.items():
            if not isinstance(count, int) or not 0 < count <= most:
                raise self._file.fault((key,), f"has {shown(count)}; a whole number was expected")
            shares[count] = self._number((key, str(count)), share, 0, 1e9)
        if not sum(shares.values()):
            raise self._file.fault((key,), "are all 0")
        return shares

    def _due(self, value: Any) -> Due:
        if not isinstance(value, dict) or not value.keys() <= {"none", "seconds"}:
            raise self._file.fault(("due",), "has to be {none: SHARE, seconds: [QUANTILES]}")
        seconds = value.get("seconds", [])
        if not isinstance(seconds, list):
            raise self._file.fault(("due", "seconds"), "has to be a list of quantiles")
        place: Place = ("due", "seconds")
        quantiles = [self._number((*place, i), number, 0, 1e9) for i, number in enumerate(seconds)]
        if quantiles != sorted(quantiles):
            raise self._file.fault(place, "has to ascend")
        none = self._number(("due", "none"), value.get("none", 0.0), 0, 1)
        return Due(none, tuple(quantiles))

    def _skus(self, value: Any) -> dict[str, int]:
        if not isinstance(value, dict) or not value:
            raise self._file.fault(("skus",), "has to be the lines that ask for each SKU")
        return {
            str(sku): int(self._number(("skus", str(sku)), lines, 1, 1e12))
            for sku, lines in value.items()
        }


class DrawnDays:
    """Orders of days that are drawn from a description, one day after the other.

    They form a Poisson process, whose rate in each interval is that of an average day times a
    factor. An order's lines depend on its number and the seed alone, as in order_mix. first: begin
    of the first day [s]; before it, orders come at the rate of its first hour.
    """

    bundles_per_hour = 0.0

    def __init__(
        self,
        demand: Demand,
        rng: np.random.Generator,
        factor: float = 1.0,
        now: float = 0.0,
        first: float = 0.0,
    ) -> None:
        self.demand, self._first = demand, first
        self._rates = factor * np.asarray(demand.orders) / demand.interval_s  # orders a second
        self._skus, self._sums = tuple(demand.skus), np.cumsum(list(demand.skus.values()))
        self._lines, self._pieces = _sums(demand.lines), _sums(demand.pieces)
        self._seed, self._count = int(rng.integers(2**63)), 0
        self._times, self._next = rng, now
        self._wait()

    def draw_anew(self, rng: np.random.Generator, now: float) -> None:
        """Draws what comes after a time [s] by another generator."""
        self._seed, self._count = int(rng.integers(2**63)), 0
        self._times, self._next = rng, now
        self._wait()

    def next_time(self) -> float:
        """Returns when the next order comes [s]."""
        return self._next

    def due(self, now: float, backlog: Backlog, in_stock: Callable[[str], int]) -> Any:
        """Yields the orders that come now."""
        while self._next <= now:
            order = self.order(self._next, in_stock)
            self._wait()
            if order:
                yield order

    def order(self, now: float, in_stock: Callable[[str], int]) -> OrderDraft | None:
        """Draws an order of SKUs in stock, by in_stock(sku) [pieces]; None if none of the drawn
        SKUs is."""
        rng = np.random.default_rng((self._seed, self._count))
        self._count += 1
        due = self.demand.due.draw(now, rng)
        count = min(_draw(self._lines, rng), len(self._skus))
        lines: dict[str, int] = {}
        for _ in range(count * TRIES):
            at = np.searchsorted(self._sums, rng.random() * self._sums[-1], side="right")
            sku, pieces = self._skus[min(int(at), len(self._skus) - 1)], _draw(self._pieces, rng)
            if sku not in lines and in_stock(sku) >= pieces:
                lines[sku] = pieces
                if len(lines) == count:
                    break
        return OrderDraft(tuple(lines.items()), now, due) if lines else None

    def rate(self, time: float) -> float:
        """Returns the mean rate of orders at a time [1/s]."""
        interval, since = self.demand.interval_s, time - self._first
        if since < 0:  # the first hour, before the day
            hour = max(round(3600 / interval), 1)
            return float(self._rates[:hour].mean())
        return float(self._rates[int(since // interval) % len(self._rates)])

    def _wait(self) -> None:
        """Draws the time of the next order by thinning candidates of the highest rate (Lewis and
        Shedler, 1979)."""
        highest = float(self._rates.max())
        while True:
            self._next += self._times.exponential(1 / highest)
            if self._times.random() * highest < self.rate(self._next):
                return


def _sums(shares: Mapping[int, float]) -> tuple[tuple[int, ...], np.ndarray]:
    return tuple(shares), np.cumsum(list(shares.values()))


def _draw(sums: tuple[tuple[int, ...], np.ndarray], rng: np.random.Generator) -> int:
    counts, shares = sums
    at = int(np.searchsorted(shares, rng.random() * shares[-1], side="right"))
    return counts[min(at, len(counts) - 1)]
