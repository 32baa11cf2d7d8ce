# SPDX-License-Identifier: Apache-2.0
"""The charts of a report over time: pieces an hour, and how long orders take."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from warehouse_operations.document import tokens
from warehouse_operations.document.canvas import Canvas, spread
from warehouse_operations.document.chart import Chart, key, letter
from warehouse_operations.reports.comparison import Group

BLOCKS = 12  # most parts of a shift: means of shorter ones show noise
LINES = ("-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (6, 1.5, 1.5, 1.5)))
LABEL_ROOM = 0.65  # of the axis; a text that begins beyond would be cut, on a phone at least
TAIL = 99.5  # percentile of the order times at which the axis ends


def throughput(groups: Sequence[Group], height: float = 230) -> Chart:
    """Returns the pieces an hour over the shift, as means over BLOCKS parts of it.

    A band reaches from the least to the most where there are several runs.
    """
    bounds = [group.estimate("item_upper_bound_per_hour").mean for group in groups]
    drawn = [_in_blocks(group) for group in groups]
    alone, several = len(groups) == 1, any(len(group.runs) > 1 for group in groups)

    def draw(canvas: Canvas) -> None:
        ends = []
        for i, (hourly, minutes) in enumerate(drawn):
            ends.append(_draw_steps(canvas, i, hourly, minutes))
        top = max([*bounds, *(hourly.max() for hourly, _ in drawn if hourly.size)])
        end = max(minutes[-1] for _, minutes in drawn) or 1
        canvas.scale(("minutes of the shift", end), ("pieces an hour", top * 1.2 or 1))
        for bound in sorted(set(bounds)):
            canvas.axes.axhline(bound, color=tokens.colour("edge"), ls=(0, (2, 2)), lw=1)
        most = f"what the stations can at most: {max(bounds):,.0f}"
        canvas.say(0, max(bounds), most, xytext=(3, 5))
        _letter_ends(canvas, ends if not alone else [])

    hourly = groups[0].estimate("item_throughput_per_hour").mean
    title = f"{hourly:,.0f} pieces an hour over the shift" if alone else "Pieces an hour over time"
    bands = " Bands reach from the least to the most of the runs." if several else ""
    quantity = f"Pieces picked an hour, means of parts of the shift.{bands}"
    margins = (48, 12 if alone else 30, 30, 40)
    head, rows = _throughput_rows(groups, drawn)
    return Chart(
        title, quantity, draw, height, margins, head, rows, key="" if alone else key_of(groups)
    )


def _draw_steps(canvas: Canvas, number: int, hourly: np.ndarray, minutes: np.ndarray) -> Any:
    """Draws the means of a configuration, (runs, blocks); returns where its line ends."""
    if not hourly.size:
        return None
    colour, means = tokens.series(number), hourly.mean(0)
    canvas.axes.stairs(
        means, minutes, baseline=None, color=colour, lw=2, ls=LINES[number % len(LINES)]
    )
    if len(hourly) > 1:
        low, high = hourly.min(0), hourly.max(0)
        canvas.axes.stairs(high, minutes, baseline=low, fill=True, color=colour, alpha=0.16, lw=0)
    return minutes[-1], means[-1]


def _letter_ends(canvas: Canvas, ends: Sequence[Any]) -> None:
    """Writes each configuration's letter at the end of its line."""
    shown = [(i, *end) for i, end in enumerate(ends) if end]
    least = 14 * canvas.axes.get_ylim()[1] / max(canvas.height - 70, 1)
    for (i, x, _), y in zip(shown, spread([y for *_, y in shown], least)):
        canvas.say(x, y, letter(i), tokens.series(i), xytext=(6, -4), fontweight="bold", ha="left")


def _throughput_rows(groups: Sequence[Group], drawn: Sequence[Any]) -> Any:
    longest = max((minutes for _, minutes in drawn), key=len)
    rows = [
        [f"{begin:.0f} to {end:.0f} min", *(_at(hourly, i) for hourly, _ in drawn)]
        for i, (begin, end) in enumerate(zip(longest, longest[1:]))
    ]
    return ["Time of the shift", *headings(groups, "Pieces an hour")], rows


def _at(hourly: np.ndarray, block: int) -> str:
    return f"{hourly[:, block].mean():,.0f}" if block < hourly.shape[1] else ""


def _in_blocks(group: Group) -> tuple[np.ndarray, np.ndarray]:
    """Returns pieces an hour, (runs, blocks), and the bounds of blocks [min], (blocks + 1,)."""
    rows = [run.data["intervals"]["picked"] for run in group.runs]
    interval = group.runs[0].data["intervals"]["seconds"]
    length = min(map(len, rows))
    if not length:
        return np.zeros((len(rows), 0)), np.zeros(1)
    begins = np.arange(0, length, -(-length // BLOCKS))
    lengths = np.diff(begins, append=length)
    pieces = np.array([np.add.reduceat(row[:length], begins) for row in rows])
    return pieces / lengths * 3600 / interval, np.append(begins, length) * interval / 60


def turnover(groups: Sequence[Group]) -> Chart:
    """Returns the share of orders that are completed within a time of their arrival."""
    minutes = [
        np.sort(np.concatenate([run.data["turnover_s"] for run in group.runs])) / 60
        for group in groups
    ]
    not_empty = [times for times in minutes if len(times)]
    most = max((np.percentile(times, TAIL) for times in not_empty), default=1.0)
    longest = max((times[-1] for times in not_empty), default=1.0)

    def draw(canvas: Canvas) -> None:
        canvas.scale(("minutes from arrival to completion", most), ("orders [%]", 104))
        for i, times in enumerate(minutes):
            share = np.arange(1, len(times) + 1) / max(len(times), 1) * 100
            line = LINES[i % len(LINES)]
            canvas.axes.plot(
                *_thinned(times, share), color=tokens.series(i), lw=2, ls=line, clip_on=True
            )
        _mark_quantiles(canvas, minutes)

    cut = f" The axis is cut where {TAIL:g} % are done; the last takes {longest:,.0f} min."
    quantity = f"Orders done within a time of their arrival.{cut if longest > most else ''}"
    alone = len(groups) == 1
    head = ["Done within", *headings(groups, "Minutes")]
    rows = [
        [f"{level} % of the orders", *(_quantile(times, level) for times in minutes)]
        for level in (25, 50, 75, 90, 95, 99)
    ]
    words = _turnover_words(minutes[0]) if alone else "How long orders take"
    return Chart(
        words,
        quantity,
        draw,
        210,
        (48, 16, 30, 40),
        head,
        rows,
        key="" if alone else key_of(groups),
    )


def _turnover_words(minutes: np.ndarray) -> str:
    if not len(minutes):
        return "No order was completed"
    half, most = np.percentile(minutes, [50, 95])
    return f"Half of the orders take up to {half:.1f} min, 95 % up to {most:.1f} min"


def _mark_quantiles(canvas: Canvas, minutes: Sequence[np.ndarray]) -> None:
    """Marks the median and 95 % of each configuration, with letters at the median."""
    for i, times in enumerate(minutes):
        for level in (50, 95) if len(times) else ():
            at = np.percentile(times, level)
            canvas.axes.plot(at, level, "o", ms=6, color=tokens.series(i), clip_on=False)
            text = f"{level} %: {at:.1f} min" if len(minutes) == 1 else letter(i)
            # Near the right edge the text stands before its mark; behind it, it would be cut.
            has_room = at < LABEL_ROOM * canvas.axes.get_xlim()[1]
            offset, side = ((8, -12), "left") if has_room else ((-8, 2), "right")
            canvas.say(at, level, text, tokens.series(i), fontweight="bold", xytext=offset, ha=side)


def _quantile(minutes: np.ndarray, level: float) -> str:
    return f"{np.percentile(minutes, level):.1f}" if len(minutes) else "–"


def headings(groups: Sequence[Group], alone: str) -> list[str]:
    """Returns the headings of columns: letters of configurations, or `alone` for one."""
    if len(groups) == 1:
        return [alone]
    return [letter(i) for i in range(len(groups))]


def key_of(groups: Sequence[Group]) -> str:
    """Returns which letter is which configuration, HTML."""
    return key([group.label for group in groups])


def _thinned(x: np.ndarray, y: np.ndarray, most: int = 400) -> tuple[np.ndarray, np.ndarray]:
    step = max(1, len(x) // most)
    return np.append(x[::step], x[-1:]), np.append(y[::step], y[-1:])
