# SPDX-License-Identifier: Apache-2.0
"""The sizes of drawn orders: lines, pieces a line, and times until they are due."""

from dataclasses import dataclass, field
from functools import cached_property
from statistics import NormalDist

import numpy as np

MOST = 1000  # largest bound of a spread


@dataclass(frozen=True)
class Spread:
    """Whole numbers from `least` to `most`, normally distributed: others are drawn again.

    Raises ValueError unless 1 <= least <= most <= MOST.
    """

    mean: float
    deviation: float
    least: int
    most: int

    def __post_init__(self) -> None:
        if not 1 <= self.least <= self.most <= MOST:
            raise ValueError(
                f"from {self.least} to {self.most}; 1 to {MOST}, ascending, was expected"
            )

    @cached_property
    def sums(self) -> np.ndarray:
        """The cumulative shares of the numbers from least to most."""
        values = np.arange(self.least, self.most + 1)
        if not self.deviation:
            shares = (values == min(max(round(self.mean), self.least), self.most)).astype(float)
        else:
            normal = NormalDist(self.mean, self.deviation)
            shares = np.array([normal.cdf(v + 0.5) - normal.cdf(v - 0.5) for v in values.tolist()])
        if not shares.sum() > 0:  # the mean is far from the bounds
            shares = (values == values[np.argmin(np.abs(values - self.mean))]).astype(float)
        return np.cumsum(shares / shares.sum())

    def draw(self, rng: np.random.Generator) -> int:
        """Returns a number."""
        at = int(np.searchsorted(self.sums, rng.random(), side="right"))
        return min(self.least + at, self.most)


@dataclass(frozen=True)
class OrderSizes:
    """The sizes of orders, with RAWSim-O's defaults; times until they are due [s]."""

    lines: Spread = field(default_factory=lambda: Spread(1.0, 1.0, 1, 4))
    pieces: Spread = field(default_factory=lambda: Spread(1.0, 0.3, 1, 3))
    due_soon: float = 1800.0
    share_soon: float = 0.2  # of the orders that are due soon
    due_later: float = 7200.0
