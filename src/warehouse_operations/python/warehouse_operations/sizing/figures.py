# SPDX-License-Identifier: Apache-2.0
"""The charts of a sizing's report."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_operations.document import canvas, tokens
from warehouse_operations.document.canvas import Canvas
from warehouse_operations.document.chart import Chart
from warehouse_operations.reports.charts import LINES
from warehouse_operations.sizing.answer import knee
from warehouse_operations.sizing.study import Study
from warehouse_operations.sizing.verdict import Verdict

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FAR = 2.5  # robots of the last point drawn, over those of the answer
MARGINS = (54, 84, 32, 40)
HEIGHT = 280  # [px]
SLIDE = (1040, 340)  # [px]
Chosen = tuple[int, int] | None  # robots and stations of the answer


def throughput(study: Study, chosen: Chosen) -> Chart:
    """Returns orders an hour over robots, a line for each number of stations with its knee."""
    asked = study.wish.orders_per_hour
    title = f"Orders completed an hour, where {asked:,.0f} are asked for"
    return Chart(
        title,
        "Means over robots, a line for each number of open picking stations",
        lambda drawn: _draw_throughput(drawn, study, chosen),
        HEIGHT,
        MARGINS,
    )


def lateness(study: Study, chosen: Chosen) -> Chart:
    """Returns the share of late orders over robots, for each number of stations."""
    return Chart(
        f"Throughput alone does not do: {100 * study.wish.late:g} % may be late",
        "Late orders [%], over robots",
        lambda drawn: _draw_lateness(drawn, study, chosen),
        HEIGHT,
        MARGINS,
        note="The axis is cut: where a line leaves it at the top, more are late.",
    )


def use(study: Study, chosen: Chosen) -> Chart:
    """Returns the utilisation of robots and stations, over robots."""

    def draw(drawn: Canvas) -> None:
        ends = []
        for i, stations, verdicts in _by_stations(study):
            _band(drawn, verdicts, "picking", 100.0, i)
            ends.append((i, _stations(stations), verdicts, "picking", 100.0))
            _band(drawn, verdicts, "robots_at_work", 100.0, i, marker="s")
        drawn.scale(("robots", _most(study, chosen)), ("at work [%]", 104))
        _mark(drawn, chosen)
        _label(drawn, ends)

    return Chart(
        "How busy robots and stations are",
        "Share of the time at work [%], over robots: squares are robots, circles picking stations",
        draw,
        HEIGHT,
        MARGINS,
    )


def write_png(path: Path, study: Study, chosen: Chosen) -> None:
    """Writes the first two side by side, for slides."""

    def draw(figure: Figure) -> None:
        width, height = SLIDE
        for x, draw_chart in ((0, _draw_throughput), (width / 2, _draw_lateness)):
            draw_chart(canvas.on(figure, (x, 0, width / 2, height), MARGINS), study, chosen)

    canvas.write_png(path, draw, *SLIDE)


def _draw_throughput(drawn: Canvas, study: Study, chosen: Chosen) -> None:
    asked, ends = study.wish.orders_per_hour, []
    for i, stations, verdicts in _by_stations(study):
        _band(drawn, verdicts, "orders_per_hour", 1.0, i)
        _knee(drawn, verdicts, i)
        ends.append((i, _stations(stations), verdicts, "orders_per_hour", 1.0))
    drawn.scale(("robots", _most(study, chosen)), ("orders completed an hour", 1.15 * asked))
    _line(drawn, asked, f"asked: {asked:,.0f}")
    _checks(drawn, study, "orders_per_hour", 1.0)
    _mark(drawn, chosen)
    _label(drawn, ends)


def _draw_lateness(drawn: Canvas, study: Study, chosen: Chosen) -> None:
    late, ends = 100 * study.wish.late, []
    for i, stations, verdicts in _by_stations(study):
        _band(drawn, verdicts, "late", 100.0, i)
        ends.append((i, _stations(stations), verdicts, "late", 100.0))
    top = min(max(10 * late, 5.0), 100.0)
    drawn.scale(("robots", _most(study, chosen)), ("late orders [%]", top))
    _line(drawn, late, f"may be: {late:g} %")
    _checks(drawn, study, "late", 100.0)
    _mark(drawn, chosen)
    _label(drawn, ends)


def _knee(drawn: Canvas, verdicts: Sequence[Verdict], number: int) -> None:
    at = knee(list(verdicts))
    if at is not None:
        hourly = next(v for v in verdicts if v.robots == at).estimate("orders_per_hour").mean
        drawn.axes.plot(at, hourly, "v", ms=9, mfc="none", mew=1.6, color=tokens.series(number))


def _most(study: Study, chosen: Chosen) -> float:
    """Returns the largest number of robots that is drawn: beyond it, little changes."""
    most = max((robots for robots, _ in study.verdicts), default=1)
    return min(FAR * chosen[0], 1.02 * most) if chosen else 1.02 * most


def _by_stations(study: Study) -> Iterator[tuple[int, int, list[Verdict]]]:
    """Yields the place, from 0, and the points of each number of stations, by robots."""
    for i, number in enumerate(sorted({stations for _, stations in study.verdicts})):
        yield i, number, [v for key, v in sorted(study.verdicts.items()) if key[1] == number]


def _band(
    drawn: Canvas,
    verdicts: Sequence[Verdict],
    name: str,
    factor: float,
    number: int,
    marker: str = "o",
) -> None:
    robots, mean, half = _points(verdicts, name, factor)
    colour = tokens.series(number)
    line = LINES[number % len(LINES)]
    drawn.axes.plot(robots, mean, marker=marker, ms=3.5, lw=1.8, ls=line, color=colour)
    drawn.axes.fill_between(robots, mean - half, mean + half, color=colour, alpha=0.16, lw=0)


def _points(verdicts: Sequence[Verdict], name: str, factor: float) -> Any:
    """Returns robots, and means with half their intervals of a figure."""
    estimates = [verdict.estimate(name) for verdict in verdicts]
    mean = factor * np.array([estimate.mean for estimate in estimates])
    half = factor * np.nan_to_num([estimate.half for estimate in estimates])
    return np.array([verdict.robots for verdict in verdicts]), mean, half


def _label(drawn: Canvas, ends: Sequence[Any]) -> None:
    """Writes the number of stations at the end of each line, or where it leaves the chart."""
    (_, right), (_, top) = drawn.axes.get_xlim(), drawn.axes.get_ylim()
    heights = []
    for _, _, verdicts, name, factor in ends:
        robots, mean, _ = _points(verdicts, name, factor)
        heights.append(min(float(np.interp(right, robots, mean)), top))
    least = 15 * top / max(drawn.height - MARGINS[2] - MARGINS[3], 1)
    for (i, words, *_), y in zip(ends, canvas.spread(heights, least)):
        drawn.say(right, y, words, tokens.series(i), xytext=(6, -4), fontweight="bold")


def _line(drawn: Canvas, y: float, words: str) -> None:
    drawn.axes.axhline(y, color=tokens.colour("edge"), ls=(0, (2, 2)), lw=1)
    drawn.say(0, y, words, xytext=(3, 4))


def _checks(drawn: Canvas, study: Study, name: str, factor: float) -> None:
    """Draws the points of simulated robots."""
    for i, verdict in enumerate(study.checks.values()):
        robots, mean, half = _points([verdict], name, factor)
        drawn.axes.errorbar(
            robots, mean, yerr=half, fmt="D", color=tokens.colour("text"), ms=6, capsize=4
        )
        if not i:
            drawn.say(robots[0], mean[0], "with physics", "text", xytext=(9, -12))


def _mark(drawn: Canvas, chosen: Chosen) -> None:
    if chosen:
        drawn.axes.axvline(chosen[0], color=tokens.colour("text"), lw=1, ls=(0, (1, 2)))
        words = f"{chosen[0]} robots"
        drawn.say(chosen[0], 0, words, "text", xytext=(5, 6), fontweight="bold")


def _stations(number: int) -> str:
    return f"{number} station{'' if number == 1 else 's'}"
