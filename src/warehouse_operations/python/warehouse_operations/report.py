# SPDX-License-Identifier: Apache-2.0
"""Writes report.html: one page with its pictures, about one run or several side by side."""

import itertools
import os
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_operations import comparison, plots, report_exports
from warehouse_operations import verdicts as differences
from warehouse_operations.comparison import Estimate, Group
from warehouse_operations.report_front import assumptions, opening
from warehouse_operations.runs import REPORT, Run

# The figures of kpis.json in the table: name, words, unit, factor, digits.
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
# Ideal robots have no traffic: there are no such figures to compare.
OF_TRAFFIC = {"collisions", "blocked", "watchdog", "plan_ms.p99", "executed_over_planned"}
TROUBLES: tuple[tuple[str, str, str, float, int], ...] = (
    ("availability", "Availability: robot hours at work", "%", 100, 2),
    ("mtbf_h", "Robot hours between failures (MTBF)", "h", 1, 1),
    ("mttr_s", "Time to repair, mean (MTTR)", "min", 1 / 60, 1),
    ("items_lost_to_failures", "Pieces not picked for want of robots", "", 1, 0),
    ("items_fallen", "Items that fell off their storage units", "", 1, 0),
    ("items_on_floor", "Items that lie on the floor at the end", "", 1, 0),
    ("pieces_on_floor", "Pieces out of stock with them", "", 1, 0),
    ("person_hours", "Hours of people on the floor", "h", 1, 2),
    ("slowed_fraction", "Robot hours slowed down for people", "%", 100, 2),
    ("stopped_fraction", "Robot hours standing for people", "%", 100, 2),
    ("items_lost_to_people", "Pieces not picked meanwhile", "", 1, 0),
    ("charging_fraction", "Robot hours at a charging place", "%", 100, 1),
    ("charge_mean", "Charge of batteries at the end, mean", "%", 100, 0),
    ("charge_least", "Charge of the emptiest at the end", "%", 100, 0),
)
COMPARED = (
    ("item_throughput_per_hour", "pieces an hour"),
    ("order_throughput_per_hour", "orders an hour"),
    ("pile_on", "pieces a unit at a station"),
    ("distance_per_item_m", "metres driven for a piece"),
)
INTERVALS = "Means of the runs with 95 % confidence intervals."
NO_INTERVALS = (
    "Where there is one run alone nothing tells how much of a difference is chance: simulate with"
    " several seeds."
)
QUEUES = (
    "Counted alike for simulated and ideal robots. Queue: the wait for a station, in its lane or"
    " beneath the unit until the lane has room."
)
STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #222; max-width: 960px; margin: 2em auto; }
h1 { font-size: 1.6em } h2 { font-size: 1.15em; margin-top: 2em; border-top: 1px solid #ddd;
padding-top: 1em } table { border-collapse: collapse } td, th { padding: .2em .9em .2em 0;
text-align: right; vertical-align: top } td:first-child, th:first-child { text-align: left }
tr:nth-child(even) { background: #f6f6f4 } .big { display: flex; gap: 2.5em; margin: 1.2em 0 }
.big b { display: block; font-size: 1.9em } .note { color: #666; font-size: .9em }
.row { display: flex; flex-wrap: wrap; gap: 1em } svg { max-width: 100%; height: auto }
.bad { color: #b00 } .answer { font-size: 1.25em } h2, svg, tr { break-inside: avoid }
h2 { break-after: avoid } @media print { body { margin: 0 } .export { display: none }
.rest { break-before: page } }
"""


def page(runs: Sequence[Run]) -> str:
    """Returns the HTML of the report about runs."""
    groups = comparison.grouped(runs)
    first = groups[0]
    parts = [_head(runs, groups)]
    alone = len(groups) == 1
    parts += [opening(first, _headline(first)) if alone else _verdicts(groups)]
    note = "Bands reach from the least to the most of the runs." if _several(groups) else ""
    parts += [section("Throughput over the shift", plots.throughput(groups), note)]
    parts += [section("Assumptions", assumptions(first))] if alone else []
    exports = report_exports.links(groups, (name for name, *_ in ROWS))
    parts += ['<div class="rest">', section("Figures", _table(groups) + exports)]
    if len(groups) > 1:
        pictures = [plots.comparison(groups, kpi, label) for kpi, label in COMPARED]
        note = INTERVALS if all(len(group.runs) > 1 for group in groups) else NO_INTERVALS
        parts += [section("Side by side", _row(pictures), note)]
    parts += [section("Orders: how long they take", plots.turnover(groups))]
    parts += [section("Where the robots' time goes", plots.robots(groups), QUEUES)]
    for group in groups[:4]:
        name = f": {group.label}" if len(groups) > 1 else ""
        parts += [section(f"Stations{escape(name)}", plots.stations(group))]
        troubles = _troubles(group)
        if troubles:
            note = (
                "Pieces not picked are estimated from those picked in the robot hours at work: what"
                " is lost if stations wait for robots."
            )
            parts += [section(f"Troubles of the day{escape(name)}", troubles, note)]
        maps = _maps(group.runs[0])
        if maps:
            parts += [section(f"The floor{escape(name)}", _row(maps))]
    return "\n".join(parts) + "</div></body></html>\n"


def write(path: str | os.PathLike[str], runs: Sequence[Run]) -> Path:
    """Writes the report about runs; returns its path."""
    Path(path).write_text(page(runs), encoding="utf-8")
    return Path(path)


def default_path(folders: Sequence[str | os.PathLike[str]]) -> Path:
    """Returns the path for a report about folders of runs.

    It is in the folder if there is one only. Several have a report each already: their common one
    is a new file in the working directory.
    """
    if len(folders) == 1:
        return Path(folders[0], REPORT)
    names = itertools.chain(
        ["comparison.html"], map("comparison-{}.html".format, itertools.count(2))
    )
    return next(path for path in map(Path, names) if not path.exists())


def table(runs: Sequence[Run]) -> str:
    """Returns the figures as text for a terminal."""
    groups = comparison.grouped(runs)
    width = max(len(words) for _, words, *_ in ROWS) + 2
    lines = [" " * width + "".join(f"{group.label[:26]:>28}" for group in groups)]
    for kpi, words, unit, factor, digits in ROWS:
        cells = [_cell(group, kpi, factor, digits, unit) for group in groups]
        lines.append(f"{words:<{width}}" + "".join(f"{cell:>28}" for cell in cells))
    return "\n".join([*lines, *(f"\n{text}" for text in verdicts(groups))])


def verdicts(groups: Sequence[Group]) -> Iterator[str]:
    """Yields sentences about how much each configuration differs from the first."""
    told = differences.verdicts(groups)
    yield from map(str, told)
    for group in groups[1:]:
        if all(one.group is not group for one in told):
            yield (
                f"{group.label}: {100 * _ratio(groups[0], group):+.1f} % pieces an hour against"
                f" {groups[0].label} (too few runs to tell it from chance)"
            )


def _ratio(first: Group, second: Group) -> float:
    a, b = (one.estimate("item_throughput_per_hour").mean for one in (first, second))
    return b / max(a, 1e-9) - 1


def _head(runs: Sequence[Run], groups: Sequence[Group]) -> str:
    count = f"{len(runs)} runs, {len(groups)} configurations" if len(runs) > 1 else ""
    return (
        f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
        f"<title>Shift report</title><style>{STYLE}</style></head><body>"
        f"<h1>Shift report</h1><p>{escape(', '.join(_common(runs)))}. {count}</p>"
    )


def _common(runs: Sequence[Run]) -> list[str]:
    """Returns words for the conditions that all runs share."""
    told = [list(_what(run)) for run in runs]
    return [words for words in told[0] if all(words in one for one in told)]


def _what(run: Run) -> Iterator[str]:
    yield run.config.get("site", "")
    yield f"{run.kpis['simulated_s'] / 3600:.2g} h"
    yield f"orders {run.config.get('orders', '')}"
    yield "simulated robots" if run.config.get("physics") else "ideal robots"


def _headline(group: Group) -> str:
    tell: tuple[tuple[str, str, float, int, str], ...] = (
        ("item_throughput_per_hour", "pieces an hour", 1, 0, ""),
        ("item_score", "of the stations' upper bound", 100, 0, " %"),
        ("late_orders_fraction", "orders late", 100, 1, " %"),
        ("distance_per_item_m", "driven for a piece", 1, 1, " m"),
    )
    cells = [
        f"<div><b>{group.estimate(kpi).mean * factor:,.{digits}f}{unit}</b>{words}</div>"
        for kpi, words, factor, digits, unit in tell
    ]
    collisions = group.estimate("collisions").mean
    warning = f'<p class="bad">{collisions:g} collisions.</p>' if collisions else ""
    return f'<div class="big">{"".join(cells)}</div>{warning}'


def _verdicts(groups: Sequence[Group]) -> str:
    cut = differences.warm_up(groups) * groups[0].runs[0].data["intervals"]["seconds"] / 60
    note = (
        f'<p class="note">After a warm-up of {cut:.0f} min (MSER-5 on the pieces picked); p is'
        " corrected for the number of differences (Holm); effect: over the standard deviation of"
        " the pairs (Hedges' g).</p>"
    )
    return "".join(f"<p>{escape(text)}</p>" for text in verdicts(groups)) + note


def _table(groups: Sequence[Group]) -> str:
    head = "".join(f"<th>{escape(group.label)}</th>" for group in groups)
    rows = []
    for kpi, words, unit, factor, digits in ROWS:
        cells = (_cell(group, kpi, factor, digits, unit) for group in groups)
        rows.append(f"<tr><td>{words}</td>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
    header = f"<tr><th></th>{head}</tr>" if len(groups) > 1 else ""
    return f"<table>{header}{''.join(rows)}</table>"


def _troubles(group: Group) -> str:
    """Returns tables of the first run's failures and their costs, and of the costs in all runs."""
    cost = [
        f"<tr><td>{words}</td><td>{_number(group.estimate(kpi), factor, digits, unit)}</td></tr>"
        for kpi, words, unit, factor, digits in TROUBLES
        if all(kpi in run.kpis for run in group.runs)
    ]
    rows = [
        f"<tr><td>{escape(words)}</td>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"
        for words, *cells in _each_trouble(group.runs[0])
    ]
    if not cost and not rows:
        return ""
    columns = ("Robots", "times", "repaired after, mean", "robot hours", "pieces not picked")
    head = "".join(f"<th>{words}</th>" for words in columns)
    table = f"<table><tr>{head}</tr>{''.join(rows)}</table><p></p>" if rows else ""
    return f"{table}<table>{''.join(cost)}</table>"


def _each_trouble(run: Run) -> Iterator[tuple[str, ...]]:
    """Yields (words, times, mean time to repair, robot hours, pieces not picked) for each kind."""
    all_h = run.data.get("robot_h", 0.0)
    failures = run.data.get("failures") or []
    charging_h = run.kpis.get("charging_fraction", 0.0) * all_h
    at_work_h = all_h - charging_h - sum(one["down_h"] for one in failures)
    an_hour = run.kpis["items_picked"] / at_work_h if at_work_h > 0 else 0.0
    for one in failures:
        repair = f"{one['mean_repair_s'] / 60:.1f} min" if one["repairs"] else ""
        pieces = f"{one['down_h'] * an_hour:.0f}"
        yield one["kind"], one["count"], repair, f"{one['robot_h']:.2f}", pieces
    if charging_h:
        yield "charge", "", "", f"{charging_h:.2f}", f"{charging_h * an_hour:.0f}"
    for words, count in (run.data.get("mishaps") or {}).items():
        yield words, count, "", "", ""


def _cell(group: Group, kpi: str, *shown: Any) -> str:
    if kpi in OF_TRAFFIC and not group.runs[0].config.get("physics", True):
        return "–"
    return _number(group.estimate(kpi), *shown)


def _number(estimate: Estimate, factor: float, digits: int, unit: str) -> str:
    text = f"{estimate.mean * factor:,.{digits}f}"
    if not np.isnan(estimate.half):
        text += f" ± {estimate.half * factor:,.{digits}f}"
    return f"{text} {unit}".strip()


def _maps(run: Run) -> list[str]:
    names = {"traffic": "Loaded robots through a cell", "waiting": "Waiting [robot-seconds]"}
    floor = run.data.get("floor") or []  # runs of before have none
    return [
        plots.heat_map(run.data[key], name, floor) for key, name in names.items() if run.data[key]
    ]


def _several(groups: Iterable[Group]) -> bool:
    return any(len(group.runs) > 1 for group in groups)


def _row(pictures: Iterable[str]) -> str:
    return f'<div class="row">{"".join(f"<div>{one}</div>" for one in pictures)}</div>'


def section(title: str, content: str, note: str = "") -> str:
    """Returns a part of a page, HTML, below its title."""
    note = f'<p class="note">{note}</p>' if note else ""
    return f"<h2>{title}</h2>{note}{content}"
