# SPDX-License-Identifier: Apache-2.0
"""The assortment of a warehouse: SKUs, their popularity, and the initial stock."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from warehouse_operations.stock.inventory import Bin

SKUS = 1000
BINS_A_SKU = 4  # fewest bins per SKU, on the average: a small warehouse has fewer SKUs
CAPACITY = 24  # pieces a bin
INITIAL_LEVEL = 0.7


@dataclass(frozen=True)
class Assortment:
    """SKUs and their shares of the demand, (n,), with a sum of 1."""

    skus: tuple
    popularity: np.ndarray

    @classmethod
    def draw(cls, count: int, rng: np.random.Generator) -> "Assortment":
        """Gamma(1) distributed weights: the top fifth of many SKUs takes about 52 to 58 %."""
        weights = rng.gamma(1.0, size=count)
        return cls(tuple(f"sku-{i}" for i in range(1, count + 1)), weights / weights.sum())

    @classmethod
    def of_lines(cls, lines: Mapping[str, int]) -> "Assortment":
        """Returns the SKUs of order lines, each with a popularity proportional to its lines."""
        counts = np.array(list(lines.values()), float)
        return cls(tuple(lines), counts / counts.sum())


def listed(
    items: Sequence[tuple[str, int]],
    stock: Sequence[tuple[str, str, int]],
    rng: np.random.Generator,
) -> tuple["Assortment", list[tuple[Bin, int]]]:
    """Returns the result of stocked() for the stock in a file: (item, SKU, pieces) of each bin.

    items: as for stocked(); items outside the stock have no bin. A bin has room for CAPACITY
    pieces, or for a larger content. The popularity of SKUs is drawn.
    """
    drawn = Assortment.draw(len({sku for _, sku, _ in stock}), rng)
    assortment = Assortment(tuple(dict.fromkeys(sku for _, sku, _ in stock)), drawn.popularity)
    unit_of = dict(items)
    result: list[tuple[Bin, int]] = []
    for item, sku, pieces in stock:
        if item in unit_of:
            bin_ = Bin(len(result) + 1, item, unit_of[item], max(CAPACITY, pieces), sku)
            result.append((bin_, pieces))
    return assortment, result


def stocked(
    items: Sequence[tuple[str, int]],
    rng: np.random.Generator,
    skus: int | None = None,
    capacity: int = CAPACITY,
    level: float = INITIAL_LEVEL,
    own: Assortment | None = None,
) -> tuple["Assortment", list[tuple[Bin, int]]]:
    """Returns an Assortment and Bins with pieces of it: (assortment, [(bin, pieces)]).

    items: (name, unit) of each bin. Each SKU has a bin; the others are shared out by popularity.
    own: the SKUs, one a bin at most; None: they are drawn.
    """
    count = min(skus or SKUS, max(len(items) // (1 if skus else BINS_A_SKU), 1))
    assortment = own or Assortment.draw(count, rng)
    count = len(assortment.skus)
    skus_of = np.concatenate(
        [
            np.arange(min(count, len(items))),
            rng.choice(count, size=max(len(items) - count, 0), p=assortment.popularity),
        ]
    )
    rng.shuffle(skus_of)
    spread = min(level, 1 - level)
    fill = np.round(capacity * rng.uniform(level - spread, level + spread, len(items)))
    result = []
    for i, ((item, unit), sku, pieces) in enumerate(zip(items, skus_of, fill)):
        bin_ = Bin(i + 1, item, unit, capacity, assortment.skus[sku])
        result.append((bin_, int(pieces)))
    return assortment, result
