# SPDX-License-Identifier: Apache-2.0
"""Runs of several configurations side by side: means, confidence intervals, differences."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import special

from warehouse_operations.runs.run_files import Run

CONFIDENCE = 0.95
LEAST = 3  # fewest runs of an interval: two hardly show their deviation


@dataclass(frozen=True)
class Estimate:
    """A mean and half its confidence interval; nan with fewer than LEAST runs."""

    mean: float
    half: float
    count: int

    @classmethod
    def of(cls, values: Sequence[float]) -> "Estimate":
        """Returns the mean of values with its confidence interval."""
        sample = np.asarray(values, float)
        half = float("nan")
        if len(sample) >= LEAST:
            factor = special.stdtrit(len(sample) - 1, (1 + CONFIDENCE) / 2)
            half = float(factor * sample.std(ddof=1) / np.sqrt(len(sample)))
        return cls(float(sample.mean()), half, len(sample))


@dataclass(frozen=True)
class Difference:
    """The difference of the second of two configurations from the first, and its p-value.

    estimate: with its confidence interval. paired: compared seed by seed. effect: the difference
    over the standard deviation of the pairs' differences, else of the runs (Hedges' g); inf where
    all pairs differ by the same amount, without an interval. freedom: degrees of freedom.
    """

    estimate: Estimate
    relative: float
    p_value: float
    paired: bool
    effect: float = float("nan")
    base: float = float("nan")  # mean of the first
    freedom: float = float("nan")

    def corrected(self, p_value: float) -> "Difference":
        """Returns the same with a p-value that is corrected for others, as by holm().

        The interval is widened to the confidence at which it excludes 0 exactly if the corrected
        p-value is below 1 - CONFIDENCE.
        """
        risk = 1 - CONFIDENCE
        wider = risk * self.p_value / p_value if p_value else risk
        half = self.estimate.half * float(
            special.stdtrit(self.freedom, 1 - wider / 2)
            / special.stdtrit(self.freedom, 1 - risk / 2)
        )
        return replace(self, p_value=p_value, estimate=replace(self.estimate, half=half))

    @property
    def is_alike(self) -> bool:
        """Whether all pairs differ by the same amount: t has no deviation to judge it by, as where
        stations are busy all the time, and the number of pairs says how sure it is."""
        return bool(np.isinf(self.effect))

    @property
    def significant(self) -> bool:
        """Whether the difference is significant at the level of CONFIDENCE."""
        return self.p_value < 1 - CONFIDENCE


@dataclass(frozen=True)
class Group:
    """The runs of one configuration, by seed."""

    label: str
    runs: tuple

    def values(self, kpi: str) -> dict[int, float]:
        """Returns one figure of each run, by seed."""
        return {run.seed: value_of(run.kpis, kpi) for run in self.runs}

    def estimate(self, kpi: str) -> Estimate:
        """Returns the Estimate of one figure."""
        return Estimate.of(list(self.values(kpi).values()))


def value_of(kpis: Any, name: str) -> float:
    """Returns a figure by its name; "order_turnover_s.median" is one of several."""
    for part in name.split("."):
        kpis = kpis[part]
    return float(kpis)


def grouped(runs: Iterable[Run]) -> list[Group]:
    """Returns the Groups of runs, in their order; labels say how they differ."""
    by_config: dict[str, list[Run]] = {}
    for run in runs:
        by_config.setdefault(json.dumps(run.config, sort_keys=True), []).append(run)
    flat = [_flat(members[0].config) for members in by_config.values()]
    keys = [key for key in _all_keys(flat) if len({str(config.get(key)) for config in flat}) > 1]
    if "layout" in keys and len({(c.get("site"), c.get("layout")) for c in flat}) == len(
        {c.get("site") for c in flat}
    ):
        keys.remove("layout")  # a digest, which says no more than the name of the site
    result = []
    for config, members in zip(flat, by_config.values()):
        label = ", ".join(_word(key, config.get(key)) for key in keys)
        result.append(Group(label or members[0].folder.name, tuple(members)))
    return result


def difference(first: Group, second: Group, kpi: str) -> Difference | None:
    """Returns the Difference between two Groups; None if there are too few runs."""
    return difference_of(first.values(kpi), second.values(kpi))


def difference_of(a: dict[int, float], b: dict[int, float]) -> Difference | None:
    """Returns the Difference of figures by seed; None if there are too few."""
    common = sorted(a.keys() & b.keys())
    if len(common) >= LEAST:
        result = _of_pairs(*(np.array([side[seed] for seed in common]) for side in (a, b)))
    elif not common and min(len(a), len(b)) >= LEAST:
        result = _of_samples(np.array([*a.values()]), np.array([*b.values()]))
    else:
        return None
    base = float(np.mean(list(a.values())))
    estimate, p_value, effect, freedom = result
    relative = estimate.mean / base if base else float("nan")
    return Difference(estimate, relative, p_value, bool(common), effect, base, freedom)


def holm(p_values: Sequence[float]) -> list[float]:
    """Returns p-values corrected for their number (Holm, Scand. J. Statist. 6, 1979)."""
    corrected, highest = [0.0] * len(p_values), 0.0
    for rank, at in enumerate(np.argsort(p_values, kind="stable").tolist()):
        highest = max(highest, (len(p_values) - rank) * p_values[at])
        corrected[at] = min(highest, 1.0)
    return corrected


_Found = tuple[Estimate, float, float, float]  # with p-value, effect and degrees of freedom


def _of_pairs(a: np.ndarray, b: np.ndarray) -> _Found:
    """Returns the mean of the differences of pairs, its p-value and effect.

    Equal differences have no deviation for t: their signs are tested, which are all equal with a
    probability of 2 / 2^n.
    """
    deltas = b - a
    deltas[np.isclose(a, b, rtol=1e-12, atol=0.0)] = 0.0  # they differ by rounding
    estimate, count = Estimate.of(deltas), len(deltas)
    if not deltas.any():
        return estimate, 1.0, 0.0, count - 1
    deviation = deltas.std(ddof=1)
    if deviation <= 1e-12 * np.abs(deltas).max():
        effect = float(np.copysign(np.inf, estimate.mean))
        return replace(estimate, half=float("nan")), 2.0 ** (1 - count), effect, count - 1
    p_value = _p_value(estimate.mean, deviation / np.sqrt(count), count - 1)
    return estimate, p_value, estimate.mean / deviation * _small_sample(count - 1), count - 1


def _of_samples(a: np.ndarray, b: np.ndarray) -> _Found:
    """Returns the difference of two means by Welch's t, its p-value and effect."""
    mean = float(b.mean() - a.mean())
    errors = np.array([sample.var(ddof=1) / len(sample) for sample in (a, b)])
    if not errors.any():
        nothing = Estimate(mean, float("nan"), len(b))
        return nothing, 1.0, float(np.copysign(np.inf, mean)) if mean else 0.0, len(a) + len(b) - 2
    freedom = errors.sum() ** 2 / (errors**2 / [len(a) - 1, len(b) - 1]).sum()
    half = float(special.stdtrit(freedom, (1 + CONFIDENCE) / 2) * np.sqrt(errors.sum()))
    p_value = _p_value(mean, np.sqrt(errors.sum()), freedom)
    spread = np.sqrt((a.var(ddof=1) + b.var(ddof=1)) / 2)
    small = _small_sample(len(a) + len(b) - 2)
    return Estimate(mean, half, len(b)), p_value, float(mean / spread * small), float(freedom)


def _p_value(mean: float, error: float, freedom: float) -> float:
    """Returns the two-sided p-value of a mean with that standard error (Student's t)."""
    return float(2 * special.stdtr(freedom, -abs(mean) / error))


def _small_sample(freedom: int) -> float:
    """Returns Hedges' factor, by which small samples overstate an effect."""
    return 1 - 3 / (4 * freedom - 1)


def _flat(config: dict[str, Any], before: str = "") -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in config.items():
        if isinstance(value, dict) and "name" not in value:
            result |= _flat(value, f"{before}{key}.")
        else:
            result[before + key] = value
    return result


def _all_keys(flat: Iterable[dict[str, Any]]) -> list[str]:
    return list(dict.fromkeys(key for config in flat for key in config))


def _word(key: str, value: Any) -> str:
    name = key.rpartition(".")[2]
    if name == "physics":
        return "physics" if value else "ideal robots"
    if name == "seconds":
        return f"{value / 60:g} min"
    if isinstance(value, dict):
        options = ", ".join(f"{k} {v}" for k, v in value.items() if k != "name")
        value = f"{value['name']} ({options})" if options else value["name"]
    return f"{name}: {value}"
