# SPDX-License-Identifier: Apache-2.0
"""Differences between configurations: after the warm-up, seed by seed, with Holm's correction.

Intervals are widened as p-values are corrected, so that both agree. Fewer than comparison.LEAST
runs have no verdict.

The warm-up is the part that MSER-5 cuts from the pieces picked a minute, the longest of all
configurations for each of them. All differences that are shown together are corrected together.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isnan

import numpy as np

from warehouse_operations.reports.comparison import Difference, Group, difference_of, holm
from warehouse_operations.reports.warm_up import mser5
from warehouse_operations.runs.run_files import Run

# Names of figures, with their words, factor and digits.
COMPARED: tuple[tuple[str, str, float, int], ...] = (
    ("pieces_per_hour", "pieces an hour", 1, 0),
    ("metres_per_piece", "metres driven for a piece", 1, 1),
    ("turnover_s", "minutes from an order's arrival to its completion, median", 1 / 60, 1),
)


@dataclass(frozen=True)
class Verdict:
    """The difference of a group from the first in a figure, with corrected p-value and interval."""

    group: Group
    first: Group
    figure: str
    words: str
    difference: Difference
    p_value: float

    @property
    def bounds(self) -> tuple[float, float]:
        """The confidence interval of the difference, over the mean of the first."""
        difference = self.difference
        return difference.relative - _half(difference), difference.relative + _half(difference)

    def __str__(self) -> str:
        difference, (low, high) = self.difference, self.bounds
        bounds = "all alike" if isnan(low) else f"95 %: {100 * low:+.1f} to {100 * high:+.1f} %"
        sure = f"{_sure(difference)}, {p_text(self.p_value)}, {bounds}"
        effect = "" if difference.is_alike else f", effect {difference.effect:+.1f}"
        pairs = ", seed by seed" if difference.paired else ""
        return (
            f"{self.group.label}: {100 * difference.relative:+.1f} % {self.words} against"
            f" {self.first.label} ({sure}{effect},"
            f" {difference.estimate.count} runs{pairs})"
        )


def _sure(difference: Difference) -> str:
    """Returns how sure a difference is."""
    if difference.is_alike:
        return "the same in each run"
    return "significant" if difference.significant else "not significant"


def verdicts(groups: Sequence[Group]) -> list[Verdict]:
    """Returns the verdicts on all groups against the first, for each figure of COMPARED."""
    cut = warm_up(groups)
    figures = [{run.seed: figures_of(run, cut) for run in group.runs} for group in groups]
    out = []
    for group, its in zip(groups[1:], figures[1:]):
        for name, words, *_ in COMPARED:
            a, b = (
                {seed: figures_of_run[name] for seed, figures_of_run in all_.items()}
                for all_ in (figures[0], its)
            )
            if difference := difference_of(a, b):
                out.append(Verdict(group, groups[0], name, words, difference, difference.p_value))
    corrected = holm([verdict.p_value for verdict in out])
    return [
        replace(verdict, difference=verdict.difference.corrected(p), p_value=p)
        for verdict, p in zip(out, corrected)
    ]


def warm_up(groups: Sequence[Group]) -> int:
    """Returns the number of intervals in the longest warm-up of the groups."""
    return max(mser5(_rows(group)) for group in groups)


def _rows(group: Group) -> np.ndarray:
    rows = [run.data["intervals"]["picked"] for run in group.runs]
    length = min(map(len, rows))
    return np.array([row[:length] for row in rows]).reshape(len(rows), length)


def figures_of(run: Run, cut: int) -> dict[str, float]:
    """Returns the figures of COMPARED of a run without its first intervals.

    Runs of older versions lack these series: their figures are of the whole shift.
    """
    seconds = run.data["intervals"]["seconds"]
    picked = run.data["intervals"]["picked"][cut:]
    kpis, data = run.kpis, run.data
    if not picked or "driven_m" not in data:
        return {
            "pieces_per_hour": kpis["item_throughput_per_hour"],
            "metres_per_piece": kpis["distance_per_item_m"],
            "turnover_s": kpis["order_turnover_s"]["median"],
        }
    orders = zip(data["completed_s"], data["turnover_s"])
    times = [taken for at, taken in orders if at >= cut * seconds]
    return {
        "pieces_per_hour": sum(picked) * 3600 / (seconds * len(picked)),
        "metres_per_piece": sum(data["driven_m"][cut:]) / max(sum(picked), 1),
        "turnover_s": float(np.median(times or [0.0])),
    }


def p_text(p_value: float) -> str:
    """Returns a p-value as text; the smallest ones as a bound."""
    return "p < 1e-6" if p_value < 1e-6 else f"p = {p_value:.2g}"


def _half(difference: Difference) -> float:
    return difference.estimate.half / difference.base if difference.base else float("nan")
