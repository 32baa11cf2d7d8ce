# SPDX-License-Identifier: Apache-2.0
"""The figures of scenarios: means with 95 % confidence intervals, and how they differ.

Figures by the minute begin after the warm-up (MSER-5), at the same minute for all scenarios that
are compared. Runs of the same seed are compared in pairs, since they draw the same random numbers.
A difference is reported where it is above chance, or the same in all pairs; tests and intervals
that are reported together are corrected together (Holm). Fewer than three runs have no interval,
and no difference is shown.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from warehouse_operations.reports import limits
from warehouse_operations.reports.comparison import (
    Difference,
    Estimate,
    Group,
    difference_of,
    holm,
)
from warehouse_operations.reports.verdicts import figures_of, warm_up
from warehouse_operations.runs.run_files import Run
from warehouse_operations.sizing.costs import Bill

MORE, LESS, NEITHER = 1, -1, 0  # is better


@dataclass(frozen=True)
class Figure:
    """A figure as the page shows it: in `unit`, with `digits`; better: MORE, LESS or NEITHER."""

    key: str
    title: str
    unit: str
    digits: int
    better: int
    note: str = "the whole shift"


AFTER = "after the warm-up"
FIGURES = (
    Figure("pieces", "Pieces picked", "an hour", 0, MORE, AFTER),
    Figure("share", "Of what the stations can at most", "%", 1, MORE, AFTER),
    Figure("orders", "Orders completed", "an hour", 0, MORE),
    Figure("late", "Late orders", "%", 1, LESS),
    Figure("turnover", "Order's way from arrival to completion", "min, median", 1, LESS, AFTER),
    Figure("waiting", "Robots wait for stations", "% of their time", 1, LESS),
    Figure("idle", "Robots without work", "% of their time", 1, NEITHER),
    Figure("metres", "Robots drive for a piece", "m", 1, LESS, AFTER),
)
BETTER, WORSE, SAME, DIFFERENT = "better", "worse", "no difference shown", "different"


def values_of(run: Run, cut: int) -> dict[str, float]:
    """Returns the FIGURES of a run without its first `cut` intervals, by key."""
    kpis, after = run.kpis, figures_of(run, cut)
    spent = run.data["robots"]
    whole = sum(spent.values()) or 1.0
    return {
        "pieces": after["pieces_per_hour"],
        "share": 100 * after["pieces_per_hour"] / max(kpis["item_upper_bound_per_hour"], 1e-9),
        "orders": kpis["order_throughput_per_hour"],
        "late": 100 * kpis["late_orders_fraction"],
        "turnover": after["turnover_s"] / 60,
        "waiting": 100 * spent.get("queue", 0.0) / whole,
        "idle": 100 * spent.get("idle", 0.0) / whole,
        "metres": after["metres_per_piece"],
    }


BillOf = Callable[[float, float, float], Bill]  # by orders and pieces an hour, and time at work
COSTS = (("to_buy", "To buy", "", 0), ("a_year", "Costs", "a year", 0))
A_PIECE = ("a_piece", "Cost of a piece", "", 4)


def _bills(runs: Sequence[Run], bill_of: BillOf) -> list[Bill]:
    """Returns what each run would cost."""
    bills = []
    for run in runs:
        spent, kpis = run.data["robots"], run.kpis
        at_work = 1 - spent.get("idle", 0.0) / (sum(spent.values()) or 1.0)
        rates = kpis["order_throughput_per_hour"], kpis["item_throughput_per_hour"]
        bills.append(bill_of(*rates, at_work))
    return bills


def _cost_rows(
    scenarios: Mapping[str, Sequence[Run]], costs: Mapping[str, BillOf]
) -> list[dict[str, Any]]:
    """Returns rows of what scenarios cost, the means of their runs."""
    bills = {name: _bills(runs, costs[name]) for name, runs in scenarios.items()}
    currency = next(iter(bills.values()))[0].currency
    rows = []
    for key, title, unit, digits in (*COSTS, A_PIECE):
        cells: list[dict[str, Any]] = []
        for of_runs in bills.values():
            estimate = Estimate.of([getattr(bill, key) for bill in of_runs])
            # What is bought is known; how much of it is used is chance.
            half = _finite(estimate.half) if key == A_PIECE[0] else None
            cells.append({"mean": estimate.mean, "half": half, "count": estimate.count})
        units = f"{currency} {unit}".strip()
        row = {"key": key, "title": title, "unit": units, "digits": digits, "cells": cells}
        rows.append(row | {"note": "the whole shift", "plain": True})
    return rows


def summary(runs: Sequence[Run]) -> dict[str, Any]:
    """Returns {key: estimate} of FIGURES, with the warm-up in minutes."""
    group = Group("", tuple(runs))
    by_seed = _by_seed(group, warm_up([group]))
    return {
        "warm_up": _minutes([group]),
        "limit": _limit(runs),
        "figures": {figure.key: _estimate(by_seed, figure.key) for figure in FIGURES},
    }


def _limit(runs: Sequence[Run]) -> dict[str, str]:
    """Returns what limits a scenario, and from when to when; "" for all the time."""
    parts = limits.windows(runs)
    return {"what": str(limits.limit(parts)), "when": limits.when(parts)}


def comparison(
    scenarios: Mapping[str, Sequence[Run]], costs: Mapping[str, BillOf] | None = None
) -> dict[str, Any]:
    """Returns the FIGURES of scenarios side by side, and how they differ from the first; with
    costs, by scenario, what each costs, too."""
    groups = [Group(name, tuple(runs)) for name, runs in scenarios.items()]
    cut = warm_up(groups)
    figures = [_by_seed(group, cut) for group in groups]
    differences = {
        (figure.key, i): _difference(figures[0], other, figure.key)
        for figure in FIGURES
        for i, other in enumerate(figures[1:], start=1)
    }
    known = {at: d for at, d in differences.items() if d}
    corrected = dict(zip(known, holm([d.p_value for d in known.values()])))
    rows = []
    for figure in FIGURES:
        cells: list[dict[str, Any]] = [_estimate(by_seed, figure.key) for by_seed in figures]
        for i in range(1, len(cells)):
            if difference := known.get((figure.key, i)):
                cells[i].update(_as_json(difference.corrected(corrected[figure.key, i]), figure))
        rows.append(_shown(figure) | {"cells": cells})
    if costs:
        rows += _cost_rows(scenarios, costs)
    return {
        "names": list(scenarios),
        "warm_up": _minutes(groups),
        "limits": [_limit(runs) for runs in scenarios.values()],
        "rows": rows,
    }


def _shown(figure: Figure) -> dict[str, Any]:
    return {
        "key": figure.key,
        "title": figure.title,
        "unit": figure.unit,
        "digits": figure.digits,
        "note": figure.note,
    }


def _minutes(groups: Sequence[Group]) -> float:
    return float(warm_up(groups) * groups[0].runs[0].data["intervals"]["seconds"] / 60)


def _by_seed(group: Group, cut: int) -> dict[int, dict[str, float]]:
    return {run.seed: values_of(run, cut) for run in group.runs}


def _estimate(by_seed: Mapping[int, Mapping[str, float]], key: str) -> dict[str, Any]:
    estimate = Estimate.of([row[key] for row in by_seed.values()])
    return {"mean": estimate.mean, "half": _finite(estimate.half), "count": estimate.count}


def _difference(
    first: Mapping[int, Mapping[str, float]], other: Mapping[int, Mapping[str, float]], key: str
) -> Difference | None:
    a, b = ({seed: row[key] for seed, row in all_.items()} for all_ in (first, other))
    return difference_of(a, b)


def _as_json(difference: Difference, figure: Figure) -> dict[str, Any]:
    estimate = difference.estimate
    is_shown = difference.significant or difference.is_alike
    return {
        "difference": {"mean": estimate.mean, "half": _finite(estimate.half)},
        "relative": _finite(difference.relative),
        "p": difference.p_value,
        "paired": difference.paired,
        "verdict": _verdict(estimate.mean, is_shown, figure.better),
        "alike": estimate.count if difference.is_alike else 0,
    }


def _verdict(mean: float, is_shown: bool, better: int) -> str:
    if not is_shown:
        return SAME
    if better == NEITHER:
        return DIFFERENT
    return BETTER if mean * better > 0 else WORSE


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
