# SPDX-License-Identifier: Apache-2.0
"""Two forecasts side by side: as it is, and with changes, run by run with the same chance."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

from warehouse_operations.forecast.ahead import Outcome
from warehouse_operations.forecast.bands import SERIES

CONFIDENCE = 0.95
FEWEST = 3  # pairs of an interval


@dataclass(frozen=True)
class Difference:
    """The effect of changes at the end: the mean over the pairs, and half of its 95 % interval
    (paired t); NaN with fewer than FEWEST pairs."""

    name: str
    without: float
    mean: float
    half: float

    def __str__(self) -> str:
        if np.isnan(self.half):
            return f"{self.mean:+.1f}"
        return f"{self.mean:+.1f} ± {self.half:.1f}"


def differences(without: Sequence[Outcome], with_: Sequence[Outcome]) -> list[Difference]:
    """Returns the differences in orders done, open and late, and pieces, of the runs that both
    have."""
    by_number = {outcome.number: outcome for outcome in without}
    pairs = [(by_number[o.number], o) for o in with_ if o.number in by_number]
    out = []
    for name in (*SERIES[:3], "pieces"):
        ends = [[getattr(outcome, name)[-1] for outcome in pair] for pair in pairs]
        before, after = np.array(ends, float).T
        change = after - before
        mean = float(change.mean())
        out.append(Difference(name, float(before.mean()), mean, _half(change)))
    return out


def sentence(without: Sequence[Outcome], with_: Sequence[Outcome]) -> str:
    """Returns the differences in a few words."""
    words = {"done": "orders done", "open": "open", "late": "late", "pieces": "pieces"}
    return ", ".join(f"{each} {words[each.name]}" for each in differences(without, with_))


def _half(change: np.ndarray) -> float:
    if len(change) < FEWEST:
        return float("nan")
    t = float(stats.t.ppf((1 + CONFIDENCE) / 2, len(change) - 1))
    return t * float(change.std(ddof=1)) / len(change) ** 0.5
