# SPDX-License-Identifier: Apache-2.0
"""The points of a sizing as a table: text for a terminal, CSV for a spreadsheet."""

import csv
import io
from collections.abc import Iterable, Sequence
from typing import Any

from warehouse_operations.runs.event_file import plain
from warehouse_operations.sizing.prices import Pricing
from warehouse_operations.sizing.study import Study
from warehouse_operations.sizing.verdict import Verdict

# Of figures: name, heading, factor, digits.
FIGURES: tuple[tuple[str, str, float, int], ...] = (
    ("orders_per_hour", "orders/h", 1, 1),
    ("pieces_per_hour", "pieces/h", 1, 0),
    ("late", "late %", 100, 2),
    ("open_orders", "open orders", 1, 0),
    ("picking", "stations at work %", 100, 1),
    ("of_bound", "of their bound %", 100, 1),
    ("replenishing", "replenishing %", 100, 1),
    ("robots_at_work", "robots at work %", 100, 1),
    ("robots_queue", "robots queue %", 100, 1),
    ("pile_on", "pieces a unit", 1, 2),
    ("metres_per_piece", "m a piece", 1, 1),
)
SHORT = ("orders_per_hour", "late", "picking", "robots_at_work")
HEAD = ("stations", "robots", "by", "verdict", "shifts", "warm-up min")


def rows(study: Study) -> list[tuple[Verdict, str]]:
    """Returns each point with `ideal` or `physics`, by stations and robots."""
    return [
        (verdicts[key], kind)
        for verdicts, kind in ((study.verdicts, "ideal"), (study.checks, "physics"))
        for key in sorted(verdicts, key=lambda key: key[::-1])
    ]


def to_csv(study: Study, prices: Pricing | None) -> str:
    """Returns all figures of all points as CSV."""
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(cells(study, prices))
    return out.getvalue()


def cells(study: Study, prices: Pricing | None) -> list[list[Any]]:
    """Returns headings, and all figures of all points: means and half their 95 % intervals."""
    named = [text for _, heading, *_ in FIGURES for text in (heading, f"{heading} ±")]
    out: list[list[Any]] = [[*HEAD, *named, "cost a piece"]]
    for verdict, kind in rows(study):
        row: list[Any] = [plain(cell) for cell in head_of(verdict, kind)]
        for name, _, factor, digits in FIGURES:
            estimate = verdict.estimate(name)
            row += [round(factor * value, digits + 2) for value in (estimate.mean, estimate.half)]
        out.append([*row, plain(cost_of(study, prices, verdict))])
    return out


def to_text(study: Study, prices: Pricing | None) -> str:
    """Returns the main figures of all points, in columns."""
    columns = [column for column in FIGURES if column[0] in SHORT]
    cost = ["cost a piece"] if prices else []
    lines: list[Sequence[str]] = [[*HEAD, *(heading for _, heading, *_ in columns), *cost]]
    for verdict, kind in rows(study):
        cells = [cell_of(verdict, *column) for column in columns]
        lines.append(
            [*head_of(verdict, kind), *cells, *([cost_of(study, prices, verdict)] if cost else [])]
        )
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join(_aligned(line, widths) for line in lines)


def head_of(verdict: Verdict, kind: str) -> list[str]:
    """Returns the cells of HEAD."""
    numbers = (verdict.stations, verdict.robots, kind, verdict.word)
    return [str(number) for number in (*numbers, len(verdict.records), verdict.warm_up)]


def cell_of(verdict: Verdict, name: str, _: str, factor: float, digits: int) -> str:
    """Returns a figure with half its confidence interval as text."""
    estimate = verdict.estimate(name)
    return f"{factor * estimate.mean:,.{digits}f} ± {factor * estimate.half:,.{digits}f}"


def cost_of(study: Study, prices: Pricing | None, verdict: Verdict) -> str:
    """Returns what a piece costs at a point as text; empty without prices."""
    if not prices:
        return ""
    stations = verdict.stations + study.wish.replenishing
    hourly = prices.per_hour(verdict.robots, stations, study.wish.units)
    return f"{hourly / max(verdict.estimate('pieces_per_hour').mean, 1e-9):.4f}"


def _aligned(cells: Iterable[str], widths: Iterable[int]) -> str:
    return "  ".join(f"{cell:>{width}}" for cell, width in zip(cells, widths))
