# SPDX-License-Identifier: Apache-2.0
"""The first sheet of a report about several configurations: which is best, and is it chance?"""

from collections.abc import Iterator, Sequence

from warehouse_operations import bar_charts, report_front
from warehouse_operations import verdicts as differences
from warehouse_operations.comparison import Group
from warehouse_operations.document import page
from warehouse_operations.document.chart import key, letter
from warehouse_operations.report_figures import number
from warehouse_operations.verdicts import Verdict, p_text

KPI = "item_throughput_per_hour"
SIDE = 300  # [px] of a chart of one figure
COMPARED = (
    (KPI, "pieces an hour"),
    ("order_throughput_per_hour", "orders an hour"),
    ("pile_on", "pieces a unit at a station"),
    ("distance_per_item_m", "metres driven for a piece"),
)
NOTE = "Means of the runs with half their 95 % confidence interval, where there are several runs."
INTERVALS = "Means of the runs with 95 % confidence intervals."
NO_INTERVALS = (
    "Where there is one run alone nothing tells how much of a difference is chance: simulate with"
    " several seeds."
)
METHOD = (
    "p is corrected for the number of differences (Holm); effect: over the standard deviation of"
    " the pairs (Hedges' g)."
)


def sheet(groups: Sequence[Group]) -> str:
    """Returns the HTML of the first sheet about several configurations."""
    runs = [run for group in groups for run in group.runs]
    warm_up = f"the first {_warm_up_min(groups):.0f} min are left out of differences (MSER-5)"
    has_several = all(len(group.runs) > 1 for group in groups)
    found = differences.verdicts(groups)
    drawn = [bar_charts.comparison(groups, *one).html(SIDE) for one in COMPARED]
    side = key([_with_limit(group) for group in groups]) + page.row(drawn)
    note = INTERVALS if has_several else NO_INTERVALS
    return "\n".join(
        [
            page.opening(
                f"Which of {len(groups)} configurations picks most?", answer(groups, found)
            ),
            page.section("Side by side", side, note),
            page.section("Is it chance?", _differences(groups, found), METHOD if found else ""),
            page.section("Assumptions", page.facts(report_front.assumptions(runs, warm_up))),
        ]
    )


def answer(groups: Sequence[Group], found: Sequence[Verdict]) -> str:
    """Returns which configuration picks most, and whether chance may explain it, as a sentence."""
    means = [group.estimate(KPI).mean for group in groups]
    best = means.index(max(means))
    pieces = number(groups[best].estimate(KPI), 1, 0)
    other = 0 if best else 1
    more = 100 * (means[best] / max(means[other], 1e-9) - 1)
    sure = _sure(found, groups[best or 1])
    return (
        f"{named(best, groups[best])} picks most: {pieces} pieces an hour, {more:.1f} % more than"
        f" {named(other, groups[other])}; {sure}."
    )


def _sure(found: Sequence[Verdict], group: Group) -> str:
    told = [one for one in found if one.group is group and one.figure == "pieces_per_hour"]
    if not told:
        return "too few runs to tell it from chance"
    if told[0].difference.significant:
        return f"chance hardly explains it ({p_text(told[0].p_value)})"
    return f"chance may explain it ({p_text(told[0].p_value)})"


def named(place: int, group: Group) -> str:
    """Returns a configuration with its letter as text."""
    return f"{letter(place)} ({group.label})"


def by_chance(first: Group, group: Group) -> str:
    """Returns a sentence about a difference of too few runs."""
    a, b = (one.estimate(KPI).mean for one in (first, group))
    return (
        f"{group.label}: {100 * (b / max(a, 1e-9) - 1):+.1f} % pieces an hour against"
        f" {first.label} (too few runs to tell it from chance)"
    )


def _differences(groups: Sequence[Group], found: Sequence[Verdict]) -> str:
    """Returns how configurations differ from the first: a table, or sentences of too few runs."""
    if not found:
        return page.sentences(by_chance(groups[0], group) for group in groups[1:])
    head = ("Against A", "of", "difference", "95 %", "p", "effect")
    return page.table(head, list(_rows(groups, found)), "Differences against A")


def _rows(groups: Sequence[Group], found: Sequence[Verdict]) -> Iterator[list[str]]:
    letters = {id(group): letter(i) for i, group in enumerate(groups)}
    for one in found:
        relative, (low, high) = 100 * one.difference.relative, one.bounds
        yield [
            letters[id(one.group)],
            one.words,
            f"{relative:+.1f} %",
            f"{100 * low:+.1f} to {100 * high:+.1f} %",
            p_text(one.p_value).removeprefix("p = ").removeprefix("p "),
            f"{one.difference.effect:+.1f}",
        ]


def _with_limit(group: Group) -> str:
    return f"{group.label}, limited by {report_front.limit(group)}"


def _warm_up_min(groups: Sequence[Group]) -> float:
    return differences.warm_up(groups) * groups[0].runs[0].data["intervals"]["seconds"] / 60
