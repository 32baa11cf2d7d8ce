# SPDX-License-Identifier: Apache-2.0
"""The charts of a report with bars: robots, stations, and configurations side by side."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from warehouse_operations.document import tokens
from warehouse_operations.document.canvas import Canvas
from warehouse_operations.document.chart import Chart, letter
from warehouse_operations.reports.charts import headings, key_of
from warehouse_operations.reports.comparison import Estimate, Group

NAMED = 30  # stations that have a bar with their name each
WAYS = {"to unit": "to a storage unit", "to station": "to a station", "back": "back to storage"}
WORDS = {
    "to unit": "Drive to a storage unit",
    "lift": "Lift and lower units",
    "to station": "Bring units to a station",
    "queue": "Wait for a station",
    "service": "Stand at a station",
    "back": "Bring units back",
    "idle": "Rest",
}


def robots(groups: Sequence[Group]) -> Chart:
    """Returns the activities that robots spend their time on."""
    shares = [_shares(group) for group in groups]
    title = _robots_words(shares[0]) if len(groups) == 1 else "What robots do, by configuration"
    quantity = "Share of the robots' time [%]"
    several = any(len(group.runs) > 1 for group in groups)
    quantity += ", with 95 % confidence intervals" if several else ""
    rows_of = len(groups)
    bar = 15 if rows_of > 1 else 18

    def draw(canvas: Canvas) -> None:
        _draw_bars(canvas, shares, rows_of > 1)

    head = ["Activity", *headings(groups, "Share of time [%]")]
    rows = [
        [words, *(_percent(shares_of_group[name]) for shares_of_group in shares)]
        for name, words in WORDS.items()
    ]
    height = len(WORDS) * (bar * rows_of + 9) + 44
    return Chart(
        title,
        quantity,
        draw,
        height,
        (172, 60, 6, 40),
        head,
        rows,
        QUEUES,
        key_of(groups) if rows_of > 1 else "",
    )


QUEUES = (
    "Counted alike for simulated and ideal robots. The wait for a station is in its lane, or"
    " beneath the unit until the lane has room."
)


def _draw_bars(canvas: Canvas, shares: Sequence[dict[str, Estimate]], lettered: bool) -> None:
    """Draws a bar for each activity and configuration, its share beside it."""
    axes, rows = canvas.axes, len(shares)
    step = 0.8 / rows
    top = max((100 * share.mean for each in shares for share in each.values()), default=1.0)
    for at, activity in enumerate(WORDS):
        token = tokens.ACTIVITIES[activity]
        for i, each in enumerate(shares):
            share, y = each[activity], at - 0.4 + (i + 0.5) * step
            half = 0.0 if np.isnan(share.half) else 100 * share.half
            axes.barh(y, 100 * share.mean, height=step * 0.84, color=tokens.colour(token))
            if half:
                _whisker(axes, 100 * share.mean, y, half)
            text = f"{letter(i)}  " if lettered else ""
            text += f"{100 * share.mean:.0f} %" if share.mean >= 0.01 else "< 1 %"
            shown = text if share.mean else text.replace("< 1 %", "0")
            canvas.say(100 * share.mean + half, y, shown, "text", xytext=(5, -4))
    canvas.scale(("% of their time", 1.06 * top or 1), ("", 1), upright=False, across=True)
    axes.set(ylim=(len(WORDS) - 0.5, -0.5))
    axes.set_yticks(range(len(WORDS)), list(WORDS.values()), color=tokens.colour("text"))


def _whisker(axes: Any, x: float, y: float, half: float) -> None:
    axes.errorbar(x, y, xerr=half, color=tokens.colour("text"), capsize=3, lw=1.2)


def _shares(group: Group) -> dict[str, Estimate]:
    """Returns the share of the robots' time of each activity, over the runs."""
    each = []
    for run in group.runs:
        whole = sum(run.data["robots"].values()) or 1.0
        each.append({name: run.data["robots"].get(name, 0.0) / whole for name in WORDS})
    return {name: Estimate.of([shares[name] for shares in each]) for name in WORDS}


def _robots_words(shares: Mapping[str, Estimate]) -> str:
    drive, wait = sum(shares[name].mean for name in WAYS), shares["queue"].mean
    return (
        f"Robots drive {100 * drive:.0f} % of their time and wait for stations {100 * wait:.0f} %"
    )


def _percent(share: Estimate) -> str:
    half = "" if np.isnan(share.half) else f" ± {100 * share.half:.1f}"
    return f"{100 * share.mean:.1f}{half}"


def stations(group: Group) -> Chart:
    """Returns how busy each station is, over the runs of a group."""
    busy_stations = _busy(group)
    title = _stations_words(busy_stations)
    several = ", with 95 % confidence intervals" if len(group.runs) > 1 else ""
    head = ["Station", "Kind", "Busy [%]", "Pieces", "Visits"]
    rows = [
        [name, kind.lower(), _percent(busy), *more] for name, kind, busy, *more in busy_stations
    ]
    if len(busy_stations) > NAMED:
        quantity = f"Time at work [%], a bar for each station, busiest first{several}"
        return Chart(title, quantity, _many(busy_stations), 190, (48, 12, 30, 40), head, rows)
    quantity = f"Time at work [%] of each station{several}"
    height = 24 * len(busy_stations) + 44
    return Chart(title, quantity, _few(busy_stations), height, (118, 52, 6, 40), head, rows)


def _few(busy_stations: Sequence[Any]) -> Any:
    def draw(canvas: Canvas) -> None:
        axes = canvas.axes
        for y, (_, _, busy, *_) in enumerate(busy_stations):
            share, half = 100 * busy.mean, 100 * np.nan_to_num(busy.half)
            axes.barh(y, share, height=0.68, color=tokens.colour("working"))
            if half:
                _whisker(axes, share, y, half)
            canvas.say(share + half, y, f"{share:.0f} %", "text", xytext=(5, -4))
        canvas.scale(("% of the time at work", 100), ("", 1), upright=False, across=True)
        axes.set(ylim=(len(busy_stations) - 0.5, -0.5))
        axes.set_yticks(
            range(len(busy_stations)),
            [row[0] for row in busy_stations],
            color=tokens.colour("text"),
        )

    return draw


def _many(busy_stations: Sequence[Any]) -> Any:
    def draw(canvas: Canvas) -> None:
        begin, ticks = 0, []
        for kind in dict.fromkeys(row[1] for row in busy_stations):
            shares = sorted(
                (100 * row[2].mean for row in busy_stations if row[1] == kind), reverse=True
            )
            at = np.arange(begin, begin + len(shares))
            canvas.axes.bar(at, shares, width=0.8, color=tokens.colour("working"))
            ticks.append((at.mean(), f"{len(shares)} for {KINDS.get(kind, kind.lower())}"))
            begin += len(shares) + 3
        canvas.scale(("", begin - 3), ("% of the time at work", 104))
        canvas.axes.set(xlim=(-1, begin - 3))
        canvas.axes.set_xticks([at for at, _ in ticks], [words for _, words in ticks])

    return draw


KINDS = {"PICK": "picking", "REPLENISH": "replenishing", "BOTH": "both"}


def _busy(group: Group) -> list[Any]:
    """Returns (name, kind, Estimate of the share at work, pieces and visits as text) by station."""
    by_name: dict[str, list[Any]] = {}
    for run in group.runs:
        for row in run.data["stations"]:
            by_name.setdefault(row["name"], []).append(row)
    return [
        (name, rows[0]["kind"], Estimate.of([row["busy_fraction"] for row in rows]))
        + tuple(f"{np.mean([row[what] for row in rows]):,.0f}" for what in ("pieces", "visits"))
        for name, rows in by_name.items()
    ]


def _stations_words(busy_stations: Sequence[Any]) -> str:
    picking = [busy.mean for _, kind, busy, *_ in busy_stations if kind != "REPLENISH"]
    if not picking:
        return "How busy stations are"
    least, most = (100 * bound for bound in (min(picking), max(picking)))
    if most - least < 1:
        return f"Picking stations work {most:.0f} % of the time"
    return f"Picking stations work {least:.0f} to {most:.0f} % of the time"


def comparison(groups: Sequence[Group], kpi: str, label: str) -> Chart:
    """Returns one figure of all groups, with confidence intervals where there are several runs.

    The axis begins at zero: a difference looks as large as it is.
    """
    estimates = [group.estimate(kpi) for group in groups]
    half = [float(np.nan_to_num(estimate.half)) for estimate in estimates]
    top = max(estimate.mean + more for estimate, more in zip(estimates, half))

    def draw(canvas: Canvas) -> None:
        axes = canvas.axes
        for y, (estimate, more) in enumerate(zip(estimates, half)):
            colour = tokens.series(y)
            axes.errorbar(
                estimate.mean, y, xerr=more or None, fmt="o", ms=7, color=colour, capsize=4
            )
            text = f"{estimate.mean:,.{_digits(top)}f}"
            canvas.say(estimate.mean + more, y, text, "text", xytext=(9, -4))
        canvas.scale((label, 1.08 * top or 1), ("", 1), upright=False, across=True)
        axes.set(ylim=(len(groups) - 0.5, -0.5))
        letters = [letter(i) for i in range(len(groups))]
        axes.set_yticks(range(len(groups)), letters, color=tokens.colour("text"), weight="bold")

    title = label[:1].upper() + label[1:]
    return Chart(title, "", draw, 26 * len(groups) + 52, (24, 56, 8, 40))


def _digits(top: float) -> int:
    return 0 if top >= 100 else 1 if top >= 10 else 2
