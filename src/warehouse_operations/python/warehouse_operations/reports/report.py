# SPDX-License-Identifier: Apache-2.0
"""Writes report.html: one page with its charts, about one run or several side by side."""

import itertools
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from warehouse_operations.document import page as document
from warehouse_operations.document import sheets
from warehouse_operations.reports import bar_charts, charts, comparison, floor_charts
from warehouse_operations.reports import exports as report_exports
from warehouse_operations.reports import figures as report_figures
from warehouse_operations.reports import front as report_front
from warehouse_operations.reports import side as report_side
from warehouse_operations.reports import troubles as report_troubles
from warehouse_operations.reports import verdicts as differences
from warehouse_operations.reports.comparison import Group
from warehouse_operations.runs.run_files import REPORT, Run

MOST_SHOWN = 4  # configurations whose stations and floor are shown


def page(runs: Sequence[Run]) -> str:
    """Returns the HTML of the report about runs."""
    groups = comparison.grouped(runs)
    alone = len(groups) == 1
    first = report_front.sheet(groups[0]) if alone else report_side.sheet(groups)
    exports = sheets.links(report_exports.tables(groups))
    labels = "" if alone else charts.key_of(groups)
    figures = labels + report_figures.table(groups) + exports
    rest = [document.section("Figures", figures, "" if alone else report_side.NOTE)]
    if not alone:
        over_time = document.section("Over the shift", charts.throughput(groups).html())
        rest += [report_side.more(groups), over_time]
    rest += [
        document.section("How long orders take", charts.turnover(groups).html()),
        document.section("Where the robots' time goes", bar_charts.robots(groups).html()),
        *(_of_group(i, group, alone) for i, group in enumerate(groups[:MOST_SHOWN])),
    ]
    about = ", ".join(filter(None, report_front.common(runs)))
    return document.document("Shift report", "Shift report", about, first, "\n".join(rest))


def _of_group(place: int, group: Group, alone: bool) -> str:
    """Returns the sections about one configuration."""
    name = "" if alone else f": {report_side.named(place, group)}"
    hours = document.section(
        f"Hour by hour{name}", report_front.by_hour(group, f"Hour by hour{name}")
    )
    parts = [
        hours,
        document.section(f"Stations{name}", bar_charts.stations(group).html()),
        report_troubles.section(group, name),
    ]
    if maps := floor_charts.maps(group):
        drawn = document.row(map_.html(floor_charts.SIDE) for map_ in maps)
        parts += [document.section(f"The floor{name}", drawn, floor_charts.NOTE, is_short=True)]
    return "\n".join(filter(None, parts))


def write(path: str | os.PathLike[str], runs: Sequence[Run]) -> Path:
    """Writes the report about runs, and beside it its figures as a workbook; returns its path."""
    path = Path(path)
    path.write_text(page(runs), encoding="utf-8")
    sheets.write_xlsx(path.with_suffix(".xlsx"), report_exports.tables(comparison.grouped(runs)))
    return path


def default_path(folders: Sequence[str | os.PathLike[str]]) -> Path:
    """Returns the path for a report about folders of runs.

    The report of a single folder lies in it. Several folders have their own reports: a common one
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
    return "\n".join([report_figures.text(groups), *(f"\n{text}" for text in verdicts(groups))])


def verdicts(groups: Sequence[Group]) -> Iterator[str]:
    """Yields a sentence about the difference of each configuration from the first."""
    all_verdicts = differences.verdicts(groups)
    yield from map(str, all_verdicts)
    for group in groups[1:]:
        if all(verdict.group is not group for verdict in all_verdicts):
            yield report_side.by_chance(groups[0], group)
