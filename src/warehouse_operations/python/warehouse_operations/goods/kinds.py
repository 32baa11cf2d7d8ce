# SPDX-License-Identifier: Apache-2.0
"""The weights of SKUs and the sizes of their bundles, where a unit is full by weight."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

# An instance without a file of SKUs has RAWSim-O's usual ones, those of its Mu-1000.
SKUS = 1000
WEIGHT_LEAST, WEIGHT_MOST = 2.0, 8.0
BUNDLE_LEAST, BUNDLE_MOST = 4, 12
SPARE = 1.5  # bins on a unit, over the bundles that fill it: some bundles are begun
MOST_BINS = 1000  # on a unit, however much it holds
ROUNDING = 1e-9


@dataclass(frozen=True)
class Kinds:
    """What SKUs weigh and how they come.

    weights: of a piece, by SKU. bundles: pieces of a bundle, by SKU. popularity: by SKU; {}: drawn.
    """

    weights: Mapping[str, float]
    bundles: Mapping[str, int]
    popularity: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def drawn(
        cls,
        weight: tuple[float, float] = (WEIGHT_LEAST, WEIGHT_MOST),
        bundle: tuple[int, int] = (BUNDLE_LEAST, BUNDLE_MOST),
        count: int = SKUS,
    ) -> "Kinds":
        """Draws weights and bundles from ranges; the same ranges give the same SKUs."""
        rng = np.random.default_rng(0)
        skus = [f"sku-{i}" for i in range(1, count + 1)]
        weights = rng.uniform(*weight, count).tolist()
        bundles = rng.integers(bundle[0], bundle[1] + 1, count).tolist()
        return cls(dict(zip(skus, weights)), dict(zip(skus, bundles)))


@dataclass(frozen=True)
class Goods:
    """Kinds of SKUs, and the weight that each unit holds, by id."""

    kinds: Kinds
    limits: Mapping[int, float]

    @cached_property
    def skus(self) -> tuple[str, ...]:
        """The SKUs of which a bundle fits on some unit."""
        most = max(self.limits.values(), default=0.0) + ROUNDING
        return tuple(sku for sku in self.kinds.weights if self._of_bundle(sku) <= most)

    def _of_bundle(self, sku: str) -> float:
        return self.weight(sku) * self.bundle(sku)

    @cached_property
    def bundle_weight(self) -> float:
        """The mean weight of a bundle that fits on a unit."""
        return sum(map(self._of_bundle, self.skus)) / max(len(self.skus), 1)

    @cached_property
    def limit(self) -> float:
        """The weight that all units hold."""
        return max(sum(self.limits.values()), ROUNDING)

    @cached_property
    def mean_weight(self) -> float:
        """The mean weight of a piece."""
        return sum(self.kinds.weights.values()) / len(self.kinds.weights)

    def bins_on(self, unit: int) -> int:
        """Returns how many bins stand for a unit: more than it holds bundles, as some are begun;
        1 if no SKU fits on any unit."""
        if not self.skus:
            return 1
        return min(max(1, math.ceil(SPARE * self.limits[unit] / self.bundle_weight)), MOST_BINS)

    def items(self) -> list[tuple[str, int]]:
        """Returns the bins of all units: (name, unit)."""
        return [
            (f"item{unit}.{i + 1}", unit) for unit in self.limits for i in range(self.bins_on(unit))
        ]

    def weight(self, sku: str) -> float:
        """Returns the weight of a piece; the mean of all for an unknown SKU."""
        return self.kinds.weights.get(sku, self.mean_weight)

    def bundle(self, sku: str) -> int:
        """Returns the pieces of a bundle."""
        return self.kinds.bundles.get(sku, BUNDLE_LEAST)
