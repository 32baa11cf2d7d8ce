# SPDX-License-Identifier: Apache-2.0
"""Two forecasts side by side: as it is, and with changes, run by run with the same chance."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from warehouse_operations.forecast.ahead import Outcome
from warehouse_operations.forecast.bands import SERIES
from warehouse_operations.reports.comparison import Estimate


@dataclass(frozen=True)
class Difference:
    """The effect of changes at the end: the mean over the pairs, and half of its 95 % interval
    (paired t); NaN with too few pairs, as of an Estimate. pairs: how many they are.

    Equal pairs have an interval of no width, which would claim to be sure: how many they are is
    said in its place.
    """

    name: str
    without: float
    mean: float
    half: float
    pairs: int

    def said_of(self, what: str) -> str:
        """Returns the difference in something that is counted."""
        if self.half == 0:
            return f"{self.mean:+,.1f} {what} in each of {self.pairs} runs"
        return f"{self} {what}"

    def __str__(self) -> str:
        if np.isnan(self.half):
            return f"{self.mean:+,.1f}"
        if self.half == 0:
            return f"{self.mean:+,.1f} in all {self.pairs}"
        return f"{self.mean:+,.1f} ± {self.half:,.1f}"


def differences(without: Sequence[Outcome], with_: Sequence[Outcome]) -> list[Difference]:
    """Returns the differences in orders done, open and late, and pieces, of the runs that both
    have."""
    by_number = {outcome.number: outcome for outcome in without}
    pairs = [(by_number[o.number], o) for o in with_ if o.number in by_number]
    out = []
    for name in (*SERIES[:3], "pieces"):
        ends = [[getattr(outcome, name)[-1] for outcome in pair] for pair in pairs]
        before, after = np.array(ends, float).T
        change = Estimate.of(after - before)
        out.append(Difference(name, float(before.mean()), change.mean, change.half, change.count))
    return out


def sentence(without: Sequence[Outcome], with_: Sequence[Outcome]) -> str:
    """Returns the differences in a few words."""
    words = {"done": "orders done", "open": "open", "late": "late", "pieces": "pieces"}
    return ", ".join(each.said_of(words[each.name]) for each in differences(without, with_))
