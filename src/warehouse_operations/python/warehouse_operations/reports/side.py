# SPDX-License-Identifier: Apache-2.0
"""The first sheet of a report about several configurations: which is best, and is it chance?"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from warehouse_operations.document import page
from warehouse_operations.document.chart import Chart, key, letter
from warehouse_operations.reports import bar_charts
from warehouse_operations.reports import front as report_front
from warehouse_operations.reports import verdicts as differences
from warehouse_operations.reports.charts import key_of
from warehouse_operations.reports.comparison import LEAST, Group
from warehouse_operations.reports.figures import number
from warehouse_operations.reports.verdicts import Verdict, p_text

KPI = "item_throughput_per_hour"
SIDE = 300  # [px] of a chart of one figure
PIECES = "pieces_per_hour"  # of verdicts
COMPARED = (
    ("order_throughput_per_hour", "orders an hour"),
    ("pile_on", "pieces a unit at a station"),
    ("distance_per_item_m", "metres driven for a piece"),
)
NOTE = "Means of the runs with half their 95 % confidence interval, where there are several runs."
INTERVALS = "Means of the runs with 95 % confidence intervals."
NO_INTERVALS = (
    "Fewer than three runs don't show how much of a difference is chance: simulate with three"
    " seeds or more."
)
SHORT = {
    PIECES: "pieces an hour",
    "metres_per_piece": "metres driven for a piece",
    "turnover_s": "time of an order, median",
}
METHOD = (
    "p is corrected for the number of differences (Holm), and the interval alike; effect: over the"
    " standard deviation of the pairs (Hedges' g)."
)


def sheet(groups: Sequence[Group]) -> str:
    """Returns the HTML of the first sheet about several configurations."""
    runs = [run for group in groups for run in group.runs]
    warm_up = f"the first {_warm_up_min(groups):.0f} min are left out of differences (MSER-5)"
    verdicts = differences.verdicts(groups)
    of_pieces = [verdict for verdict in verdicts if verdict.figure == PIECES]
    labels = key([_with_limit(group) for group in groups])
    asked = f"Which of {len(groups)} configurations picks most?"
    return "\n".join(
        [
            page.opening(asked, answer(groups, verdicts)),
            page.section("Side by side", labels + _chart(groups, KPI, "pieces an hour").html()),
            page.section(
                "Is it chance?",
                _differences(groups, of_pieces, "pieces an hour"),
                METHOD if of_pieces else "",
            ),
            page.section("Assumptions", page.facts(report_front.assumptions(runs, warm_up))),
        ]
    )


def more(groups: Sequence[Group]) -> str:
    """Returns the HTML of other figures side by side, and of their differences."""
    drawn = [_chart(groups, *figure).html(SIDE) for figure in COMPARED]
    shown = key_of(groups) + page.row(drawn)
    side = page.section("Other figures side by side", shown, NOTE, is_short=True)
    verdicts = differences.verdicts(groups)
    if not verdicts:
        return side
    return side + page.section(
        "All differences", _differences(groups, verdicts, "all figures"), METHOD
    )


def _chart(groups: Sequence[Group], kpi: str, label: str) -> Chart:
    has_several = all(len(group.runs) >= LEAST for group in groups)
    note = INTERVALS if has_several else NO_INTERVALS
    drawn = bar_charts.comparison(groups, kpi, label)
    return replace(drawn, note=note if kpi == KPI else "")


def answer(groups: Sequence[Group], verdicts: Sequence[Verdict]) -> str:
    """Returns a sentence: the configuration that picks most, and whether chance may explain
    that."""
    means = [group.estimate(KPI).mean for group in groups]
    best = means.index(max(means))
    pieces = number(groups[best].estimate(KPI), 1, 0)
    other = 0 if best else 1
    more = 100 * (means[best] / max(means[other], 1e-9) - 1)
    sure = _sure(verdicts, groups[best or 1])
    return (
        f"{named(best, groups[best])} picks most: {pieces} pieces an hour, {more:.1f} % more than"
        f" {named(other, groups[other])}; {sure}."
    )


def _sure(verdicts: Sequence[Verdict], group: Group) -> str:
    of_pieces = [
        verdict for verdict in verdicts if verdict.group is group and verdict.figure == PIECES
    ]
    if not of_pieces:
        return too_few(group)
    if of_pieces[0].difference.is_alike:
        return (
            f"after the warm-up by as much in each of {of_pieces[0].difference.estimate.count} runs"
        )
    if of_pieces[0].difference.significant:
        return f"chance hardly explains it ({p_text(of_pieces[0].p_value)})"
    return f"chance may explain it ({p_text(of_pieces[0].p_value)})"


def named(place: int, group: Group) -> str:
    """Returns a configuration with its letter as text."""
    return f"{letter(place)} ({group.label})"


def by_chance(first: Group, group: Group) -> str:
    """Returns a sentence about a difference between too few runs for a test."""
    a, b = (group.estimate(KPI).mean for group in (first, group))
    return (
        f"{group.label}: {100 * (b / max(a, 1e-9) - 1):+.1f} % pieces an hour against"
        f" {first.label} ({too_few(group)})"
    )


def too_few(group: Group) -> str:
    """Returns a clause about a group without an interval, and the number of runs for one."""
    count = len(group.runs)
    runs = f"{count} run{'' if count == 1 else 's'}"
    return f"{runs}: too few to exclude chance; simulate {LEAST} seeds or more"


def _differences(groups: Sequence[Group], verdicts: Sequence[Verdict], label: str) -> str:
    """Returns the differences of configurations from the first: a table, or sentences for too few
    runs."""
    if not verdicts:
        return page.sentences(by_chance(groups[0], group) for group in groups[1:])
    head = ("Against A", "difference", "95 %", "p", "effect")
    return page.table(head, list(_rows(groups, verdicts)), f"Differences against A: {label}")


def _rows(groups: Sequence[Group], verdicts: Sequence[Verdict]) -> Iterator[list[str]]:
    letters = {id(group): letter(i) for i, group in enumerate(groups)}
    for verdict in verdicts:
        relative, (low, high) = 100 * verdict.difference.relative, verdict.bounds
        yield [
            f"{letters[id(verdict.group)]}, {SHORT[verdict.figure]}",
            f"{relative:+.1f} %",
            "all alike" if np.isnan(low) else f"{100 * low:+.1f} to {100 * high:+.1f} %",
            p_text(verdict.p_value).removeprefix("p = ").removeprefix("p "),
            "" if verdict.difference.is_alike else f"{verdict.difference.effect:+.1f}",
        ]


def _with_limit(group: Group) -> str:
    return f"{group.label}, limited by {report_front.limit(group)}"


def _warm_up_min(groups: Sequence[Group]) -> float:
    return differences.warm_up(groups) * groups[0].runs[0].data["intervals"]["seconds"] / 60
