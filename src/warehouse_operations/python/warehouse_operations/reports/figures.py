# SPDX-License-Identifier: Apache-2.0
"""The figures of a report: their names, units and format."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from warehouse_operations.document import page
from warehouse_operations.document.chart import letter
from warehouse_operations.reports.comparison import Estimate, Group

# Of kpis.json: name, words, unit, factor, digits.
ROWS: tuple[tuple[str, str, str, float, int], ...] = (
    ("item_throughput_per_hour", "Pieces picked an hour", "", 1, 0),
    ("item_score", "Of what the stations can at most", "%", 100, 1),
    ("order_throughput_per_hour", "Orders completed an hour", "", 1, 0),
    ("order_turnover_s.median", "Order: arrival to completion, median", "min", 1 / 60, 1),
    ("order_turnover_s.p95", "Order: arrival to completion, 95 %", "min", 1 / 60, 1),
    ("order_throughput_s.median", "Order: at its station, median", "min", 1 / 60, 1),
    ("late_orders_fraction", "Late orders", "%", 100, 1),
    ("pile_on", "Pieces a unit at a station (pile-on)", "", 1, 2),
    ("station_idle_fraction", "Picking stations idle", "%", 100, 1),
    ("bundles_stored", "Bundles put into stock", "", 1, 0),
    ("trips", "Units brought to stations", "", 1, 0),
    ("distance_per_item_m", "Robots drive for a piece", "m", 1, 1),
    ("distance_m", "Robots drive in all", "km", 1e-3, 1),
    ("collisions", "Collisions", "", 1, 0),
    ("blocked", "Times a robot was blocked", "", 1, 0),
    ("watchdog", "Times a deadlock was resolved", "", 1, 0),
    ("plan_ms.p99", "Planning a step, 99 %", "ms", 1, 1),
    ("executed_over_planned", "Driven time over planned time", "", 1, 3),
    ("real_time_factor", "Faster than real time", "times", 1, 1),
)
# The same, of floors with elevators.
OF_ELEVATORS: tuple[tuple[str, str, str, float, int], ...] = (
    ("elevator_rides", "Rides of elevators", "", 1, 0),
    ("elevator_ride_fraction", "Elevators carry a robot for", "%", 100, 1),
    ("elevator_wait_s", "Robot: wait for an elevator, mean", "s", 1, 1),
)
ACROSS = 4  # configurations in a table
# Ideal robots have no traffic: there are no such figures to compare.
OF_TRAFFIC = {"collisions", "blocked", "watchdog", "plan_ms.p99", "executed_over_planned"}


def table(groups: Sequence[Group]) -> str:
    """Returns the figures of all groups, HTML: tables that are narrow enough for paper."""
    if len(groups) == 1:
        return f'<div class="halves">{_part(groups, [])}</div>'
    letters = [letter(i) for i in range(len(groups))]
    return "".join(
        _part(groups[i : i + ACROSS], letters[i : i + ACROSS])
        for i in range(0, len(groups), ACROSS)
    )


def _part(groups: Sequence[Group], letters: Sequence[str]) -> str:
    rows = [[words, *(cell(group, *row) for group in groups)] for words, row in _rows(groups)]
    return page.table(["", *letters] if letters else [], rows, " ".join(["Figures", *letters]))


def text(groups: Sequence[Group]) -> str:
    """Returns the figures of all groups for a terminal."""
    width = max(len(words) for words, _ in _rows(groups)) + 2
    lines = [" " * width + "".join(f"{group.label[:26]:>28}" for group in groups)]
    for words, row in _rows(groups):
        cells = "".join(f"{cell(group, *row):>28}" for group in groups)
        lines.append(f"{words:<{width}}{cells}")
    return "\n".join(lines)


def cell(group: Group, kpi: str, unit: str, factor: float, digits: int) -> str:
    """Returns a figure of a group as text, with its interval; – where it has none."""
    if kpi in OF_TRAFFIC and not group.runs[0].config.get("physics", True):
        return "–"
    return number(group.estimate(kpi), factor, digits, unit)


def number(estimate: Estimate, factor: float, digits: int, unit: str = "") -> str:
    """Returns a mean with half its confidence interval as text."""
    text = f"{estimate.mean * factor:,.{digits}f}"
    if not np.isnan(estimate.half):
        text += f" ± {estimate.half * factor:,.{digits}f}"
    return f"{text} {unit}".strip()


def _rows(groups: Sequence[Group]) -> list[tuple[str, Any]]:
    name = OF_ELEVATORS[0][0]
    rides = all(name in run.kpis for group in groups for run in group.runs)
    rows = (*ROWS, *OF_ELEVATORS) if rides else ROWS
    return [(words, (kpi, *shown)) for kpi, words, *shown in rows]
