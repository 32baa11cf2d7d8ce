# SPDX-License-Identifier: Apache-2.0
"""Proposes a unit for each bin of a SKU, from orders.

Units are filled one by one, the nearest to a station first. Each begins with the remaining SKU that
has the most lines (class A before B before C), and adds the SKU that shares most orders with those
on it: the largest sum of lift-weighted pairs. So a trip serves more lines of an order, and frequent
trips are short.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

from warehouse_layout.file.sku_master import Sku
from warehouse_operations.stock.order_file import OrderDraft

UNIT_KG = 390.0  # largest mass on a unit: a robot's load of 450 kg, less the unit's own 60 kg
MOST_LINES = 60  # longest order whose pairs are counted: in longer ones, pairs mean little


class Lot(NamedTuple):
    """Pieces of a SKU for one bin."""

    sku: str
    pieces: int


class Slot(NamedTuple):
    """A bin: pieces of a SKU on a unit."""

    sku: str
    pieces: int
    unit: int


@dataclass(frozen=True)
class Pairs:
    """The demand for SKUs and for pairs of them. lines: by SKU; together: by SKU and other."""

    lines: Counter[str]
    together: Mapping[str, Counter[str]]

    @classmethod
    def of(cls, orders: Iterable[OrderDraft]) -> "Pairs":
        """Returns the pairs of orders."""
        lines: Counter[str] = Counter()
        together: dict[str, Counter[str]] = defaultdict(Counter)
        for order in orders:
            skus = sorted({sku for sku, _ in order.lines})
            lines.update(skus)
            if len(skus) <= MOST_LINES:
                for a, b in combinations(skus, 2):
                    together[a][b] += 1
                    together[b][a] += 1
        return cls(lines, together)

    def share(self) -> float:
        """Returns the share of lines whose order has another line."""
        joint = sum(1 for counts in self.together.values() for _ in counts.elements())
        return joint / max(sum(self.lines.values()), 1)


def propose(
    lots: Sequence[Lot],
    room: Mapping[int, int],
    nearest: Sequence[int],
    pairs: Pairs,
    skus: Mapping[str, Sku],
) -> list[Slot]:
    """Returns a slot for each lot. room: bins of each unit; nearest: units, the nearest first.

    A SKU lies twice on a unit only as the last remaining one; a unit holds at most UNIT_KG while
    another one has room.
    """
    left: dict[str, list[int]] = defaultdict(list)
    for lot in sorted(lots):
        left[lot.sku].append(lot.pieces)
    slots: list[Slot] = []
    for unit in nearest:
        _fill(unit, room.get(unit, 0), left, pairs, skus, slots)
    return slots


def _fill(
    unit: int,
    bins: int,
    left: dict[str, list[int]],
    pairs: Pairs,
    skus: Mapping[str, Sku],
    slots: list[Slot],
) -> None:
    near: Counter[str] = Counter()  # demand for each SKU together with those on the unit
    here: set[str] = set()
    weight = 0.0
    for _ in range(bins):
        if not left:
            return
        weights = {sku: skus[sku].weight * left[sku][-1] if sku in skus else 0.0 for sku in left}
        fits = [sku for sku in left if weight + weights[sku] <= UNIT_KG]
        fresh = [sku for sku in fits if sku not in here]
        choice = min(
            fresh or fits or [*left],
            key=lambda sku: (-near[sku], *_rank(sku, pairs, skus)),
        )
        weight += weights[choice]
        slots.append(Slot(choice, left[choice].pop(), unit))
        if not left[choice]:
            del left[choice]
        if choice not in here:
            here.add(choice)
            # A partner with few other orders is more specific than one in all orders.
            for other, count in pairs.together.get(choice, {}).items():
                near[other] += count * 1000 // max(pairs.lines[other], 1)


def _rank(sku: str, pairs: Pairs, skus: Mapping[str, Sku]) -> tuple[str, int, str]:
    class_ = skus[sku].class_ if sku in skus else ""
    return class_ or "B", -pairs.lines[sku], sku
