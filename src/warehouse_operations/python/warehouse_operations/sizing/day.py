# SPDX-License-Identifier: Apache-2.0
"""A day for which a warehouse is sized: with its peak, instead of a constant rate of orders."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from warehouse_operations.stock import demand_file, orders_text
from warehouse_operations.stock.order_file import DemandError, read_csv
from warehouse_operations.stock.orders_text import DAY, DEMAND, DayText

RUN_IN = 60  # minutes before the day, with the orders of its first hour
HOUR = 3600.0  # [s]
MOST_HOURS = 48


@dataclass(frozen=True)
class Day:
    """A day: its orders text, the orders of each hour and the pieces of an order on the average."""

    text: DayText
    by_hour: Sequence[float]
    pieces_per_order: float

    @classmethod
    def read(cls, text: str) -> "Day":
        """Reads `FILE.csv`, `FILE.demand.yaml`, `day:…` or `demand:…`, each with `*1.3` or without.
        Raises DemandError."""
        day = orders_text.day_of(text)
        if day is None:
            kind = DAY if text.partition("*")[0].strip().endswith(".csv") else DEMAND
            day = orders_text.day_of(f"{kind}:{text}")
        assert day is not None
        return cls._of_orders(day) if day.kind == DAY else cls._of_description(day)

    @classmethod
    def _of_orders(cls, day: DayText) -> "Day":
        orders = read_csv(day.file)
        if not orders:
            raise DemandError(f"{day.file}: there is no order in it")
        counts = Counter(int(order.at // HOUR) for order in orders)
        if max(counts) >= MOST_HOURS:
            raise DemandError(
                f"{day.file}: its orders come within {max(counts) + 1} hours; describe them by"
                " `demand` first, and size for a day that is drawn from it"
            )
        pieces = sum(n for order in orders for _, n in order.lines) / len(orders)
        by_hour = [day.factor * counts[hour] for hour in range(max(counts) + 1)]
        return cls(day, by_hour, pieces)

    @classmethod
    def _of_description(cls, day: DayText) -> "Day":
        demand = demand_file.read(day.file)
        by_hour = [0.0] * math.ceil(demand.seconds / HOUR)
        for i, orders in enumerate(demand.orders):
            by_hour[int(i * demand.interval_s // HOUR)] += day.factor * orders
        return cls(day, by_hour, demand.lines_an_order * demand.pieces_a_line)

    @property
    def hours(self) -> float:
        """The length of the day [h]."""
        return float(len(self.by_hour))

    @property
    def orders(self) -> float:
        """Orders of the day, on the average."""
        return sum(self.by_hour)

    @property
    def peak(self) -> float:
        """Orders of the busiest hour."""
        return max(self.by_hour)

    @property
    def orders_per_hour(self) -> float:
        """Orders an hour, over the hours with orders."""
        return self.orders / sum(count > 0 for count in self.by_hour)

    @property
    def whole_text(self) -> str:
        """The orders text of a shift that has the day after its run-in."""
        return str(replace(self.text, run_in=float(RUN_IN)))

    def __str__(self) -> str:
        return (
            f"the day of {self.text.file.rpartition('/')[2]}"
            f"{f' times {self.text.factor:g}' if self.text.factor != 1 else ''}"
            f" ({self.orders:,.0f} orders, {self.peak:,.0f} in the busiest hour)"
        )
