# SPDX-License-Identifier: Apache-2.0
"""Runs of several configurations side by side: means, confidence intervals, differences."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import stats

from warehouse_operations.runs import Run

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """A mean and half its confidence interval; nan where one run alone can't tell."""

    mean: float
    half: float
    count: int

    @classmethod
    def of(cls, values: Sequence[float]) -> "Estimate":
        """Returns the mean of values with its confidence interval."""
        sample = np.asarray(values, float)
        half = float("nan")
        if len(sample) > 1:
            factor = stats.t.ppf((1 + CONFIDENCE) / 2, len(sample) - 1)
            half = float(factor * sample.std(ddof=1) / np.sqrt(len(sample)))
        return cls(float(sample.mean()), half, len(sample))


@dataclass(frozen=True)
class Difference:
    """How much the second of two configurations is above the first, and how likely by chance.

    paired: seeds that both have are compared one by one.
    """

    estimate: Estimate
    relative: float
    p_value: float
    paired: bool

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
    keys = [key for key in _all_keys(flat) if len({str(one.get(key)) for one in flat}) > 1]
    result = []
    for one, members in zip(flat, by_config.values()):
        label = ", ".join(_word(key, one.get(key)) for key in keys)
        result.append(Group(label or members[0].folder.name, tuple(members)))
    return result


def difference(first: Group, second: Group, kpi: str) -> Difference | None:
    """Returns the Difference between two Groups; None if there are too few runs."""
    a, b = first.values(kpi), second.values(kpi)
    common = sorted(a.keys() & b.keys())
    base = np.mean(list(a.values()))
    if len(common) > 1:
        deltas = np.array([b[seed] - a[seed] for seed in common])
        estimate = Estimate.of(deltas)
        certain = deltas.std() < 1e-12
        p_value = float(deltas.mean() == 0) if certain else stats.ttest_1samp(deltas, 0).pvalue
        paired = True
    elif len(a) > 1 and len(b) > 1:
        found = stats.ttest_ind(list(b.values()), list(a.values()), equal_var=False)
        estimate = Estimate(np.mean(list(b.values())) - base, float("nan"), len(b))
        p_value, paired = found.pvalue, False
    else:
        return None
    relative = estimate.mean / base if base else float("nan")
    return Difference(estimate, float(relative), float(p_value), paired)


def _flat(config: dict[str, Any], before: str = "") -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in config.items():
        if isinstance(value, dict) and "name" not in value:
            result |= _flat(value, f"{before}{key}.")
        else:
            result[before + key] = value
    return result


def _all_keys(flat: Iterable[dict[str, Any]]) -> list[str]:
    return list(dict.fromkeys(key for one in flat for key in one))


def _word(key: str, value: Any) -> str:
    name = key.rpartition(".")[2]
    if name == "physics":
        return "physics" if value else "ideal robots"
    if isinstance(value, dict):
        options = ", ".join(f"{k} {v}" for k, v in value.items() if k != "name")
        value = f"{value['name']} ({options})" if options else value["name"]
    return f"{name}: {value}"
