# SPDX-License-Identifier: Apache-2.0
"""A point hour by hour: orders in, done and late, utilisation, and the limit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from warehouse_operations.document import canvas, sheets, tokens
from warehouse_operations.document.canvas import Canvas
from warehouse_operations.document.chart import Chart
from warehouse_operations.reports import limits
from warehouse_operations.reports.limits import Limit
from warehouse_operations.sizing.verdict import Verdict

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEAD = (
    "hour", "orders in", "orders done", "late", "open orders", "stations at work %",
    "robots at work %", "queue %", "limit",
)  # fmt: skip
HEIGHT, MARGINS, SLIDE = 260, (54, 96, 32, 40), (760, 320)  # [px]
NOTHING = "nothing"  # limits an hour without late orders in which robots lack work
MINUTES = 60


@dataclass(frozen=True)
class Hour:
    """An hour of a shift, from its begin [h]; means over the shifts of a point.

    late: orders that came in this hour and were not done in time. Shares are of time.
    """

    begin: int
    arrived: float
    done: float
    late: float
    open_orders: float
    stations: float
    robots: float
    queue: float
    limit: str

    def cells(self) -> list[float | str]:
        """Returns the cells of HEAD."""
        counts = [round(value, 2) for value in (self.arrived, self.done, self.late)]
        shares = [round(100 * value, 1) for value in (self.stations, self.robots, self.queue)]
        return [self.begin, *counts, round(self.open_orders, 1), *shares, self.limit]


def hours_of(verdict: Verdict) -> list[Hour]:
    """Returns the hours of a point's shifts, after the warm-up."""
    names = {name: limit for _, name, limit in _limits(verdict)}
    count = len(verdict.records)
    series = {
        name: np.mean([record.series[name] for record in verdict.records], axis=0)[
            verdict.warm_up :
        ]
        for name in verdict.records[0].series
    }
    out = []
    for begin in range(0, len(series["open"]), MINUTES):
        part = {name: values[begin : begin + MINUTES] for name, values in series.items()}
        total = {name: float(values.sum()) for name, values in part.items()}
        seconds = 60.0 * len(part["open"])
        robot_s = max(total["robots_s"], 1.0)
        out.append(
            Hour(
                begin // MINUTES,
                total["arrived"],
                total["completed"],
                total["missed"],
                float(part["open"].mean()),
                total["picking_s"] / (seconds * verdict.stations),
                1 - (total["idle_s"] + total["queue_s"]) / robot_s,
                total["queue_s"] / robot_s,
                names.get(begin // MINUTES, "") if count else "",
            )
        )
    return out


def _limits(verdict: Verdict) -> Iterator[tuple[float, int, str]]:
    """Yields each hour with its limit."""
    for window, limit in limits.hours(verdict.windows):
        is_quiet = limit == Limit.ORDERS and not window.late
        yield window.begin, int(window.begin // limits.HOUR), NOTHING if is_quiet else str(limit)


def sentences(hours: Sequence[Hour]) -> Iterator[str]:
    """Yields sentences about the limits of the shift over time, and the hours with late orders."""
    begin = 0
    for i, hour in enumerate(hours):
        if i + 1 == len(hours) or hours[i + 1].limit != hour.limit:
            span = f"{begin}:00 to {i + 1}:00"
            late = sum(other.late for other in hours[begin : i + 1])
            yield f"{span}: limited by {hour.limit}; {late:,.1f} orders of these hours are late."
            begin = i + 1


def to_csv(hours: Sequence[Hour]) -> str:
    """Returns the hours as CSV."""
    return sheets.to_csv([list(HEAD), *(hour.cells() for hour in hours)])


def chart(hours: Sequence[Hour]) -> Chart:
    """Returns charts by hour: orders in, done and late; utilisation of stations and robots."""
    return Chart(
        "The day, hour by hour",
        "Orders an hour: that came (bars), done (line), late (dark bars)",
        lambda drawn: _draw_orders(drawn, hours),
        HEIGHT,
        MARGINS,
        list(HEAD),
        [[str(cell) for cell in hour.cells()] for hour in hours],
    )


def use_chart(hours: Sequence[Hour]) -> Chart:
    """Returns the utilisation of stations and robots, by hour."""
    return Chart(
        "How busy they are, hour by hour",
        "Share of the time [%]",
        lambda drawn: _draw_use(drawn, hours),
        HEIGHT,
        MARGINS,
    )


def write_png(path: Path, hours: Sequence[Hour]) -> None:
    """Writes both for slides."""

    def draw(figure: Figure) -> None:
        width, height = SLIDE
        for y, part in ((0, _draw_orders), (height, _draw_use)):
            part(canvas.on(figure, (0, y, width, height), MARGINS), hours)

    canvas.write_png(path, draw, SLIDE[0], 2 * SLIDE[1])


def _draw_orders(drawn: Canvas, hours: Sequence[Hour]) -> None:
    middle = [hour.begin + 0.5 for hour in hours]
    arrived, done = [hour.arrived for hour in hours], [hour.done for hour in hours]
    late = [hour.late for hour in hours]
    drawn.axes.bar(middle, arrived, 0.86, color=tokens.series(0), alpha=0.35)
    drawn.axes.bar(middle, late, 0.86, color=tokens.series(1))
    drawn.axes.plot(middle, done, marker="o", ms=4, lw=2, color=tokens.series(0))
    drawn.scale(("hour", len(hours)), ("orders an hour", 1.15 * max([*arrived, *done, 1.0])))
    for word, values, number in (("done", done, 0), ("late", late, 1)):
        drawn.say(len(hours), values[-1], word, tokens.series(number), xytext=(6, -4))


def _draw_use(drawn: Canvas, hours: Sequence[Hour]) -> None:
    middle = [hour.begin + 0.5 for hour in hours]
    lines = {
        "stations": [100 * hour.stations for hour in hours],
        "robots": [100 * hour.robots for hour in hours],
        "queue": [100 * hour.queue for hour in hours],
    }
    for i, values in enumerate(lines.values()):
        drawn.axes.plot(middle, values, marker="o", ms=4, lw=2, color=tokens.series(i))
    drawn.scale(("hour", len(hours)), ("of the time [%]", 104))
    ends = canvas.spread([values[-1] for values in lines.values()], 8)
    for i, (word, y) in enumerate(zip(lines, ends)):
        drawn.say(len(hours), y, word, tokens.series(i), xytext=(6, -4))
