# SPDX-License-Identifier: Apache-2.0
"""Draws a description of demand: a page, and a picture of each part of it for slides."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from warehouse_operations.demand.description import sentences
from warehouse_operations.document import canvas, page, tokens
from warehouse_operations.document.canvas import Canvas
from warehouse_operations.document.chart import Chart
from warehouse_operations.runs.version import version
from warehouse_operations.stock.demand_file import Demand

MARGINS = (54, 20, 32, 40)
HEIGHT, SLIDE = 240, (680, 300)  # [px]
MOST_BARS = 12  # of a distribution; the rest is the last bar


def charts(demand: Demand) -> dict[str, Chart]:
    """Returns a Chart of each part, by name."""
    return {
        "orders": _orders(demand),
        "lines": _shares("Lines an order", "lines", demand.lines, demand.lines_an_order),
        "pieces": _shares("Pieces a line", "pieces", demand.pieces, demand.pieces_a_line),
        "popularity": _popularity(demand),
        "due": _due(demand),
        "repeated": _repeated(demand),
    }


def write(demand: Demand, odd: Sequence[str], path: Path) -> list[Path]:
    """Writes the page, and beside it a picture of each part; returns their paths."""
    drawn = charts(demand)
    first = page.opening(f"What comes on a day of {demand.of}?", " ".join(sentences(demand)))
    oddities = page.sentences(odd) if odd else "<p>Nothing.</p>"
    first += page.section("What was odd in the file", oddities)
    rest = "\n".join(page.section(chart.title, chart.html()) for chart in drawn.values())
    about = f"{page.today()}, version {version()}"
    path.write_text(page.document(f"Demand: {demand.of}", "Demand", about, first, rest), "utf-8")
    pictures = []
    for name, chart in drawn.items():
        picture = path.with_name(f"{path.stem}.{name}.png")
        _write_png(picture, chart)
        pictures.append(picture)
    return [path, *pictures]


def _write_png(path: Path, chart: Chart) -> None:
    width, height = SLIDE
    canvas.write_png(
        path,
        lambda figure: chart.draw(canvas.on(figure, (0, 0, width, height), MARGINS)),
        width,
        height,
    )


def _chart(
    title: str,
    quantity: str,
    draw: Callable[[Canvas], None],
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
) -> Chart:
    return Chart(title, quantity, draw, HEIGHT, MARGINS, head, rows)


def _orders(demand: Demand) -> Chart:
    hours = np.arange(len(demand.orders)) * demand.interval_s / 3600
    width = demand.interval_s / 3600
    per_hour = np.asarray(demand.orders) / width

    def draw(drawn: Canvas) -> None:
        drawn.axes.bar(hours, per_hour, 0.9 * width, align="edge", color=tokens.series(0))
        drawn.axes.axhline(
            demand.orders_a_day / (demand.seconds / 3600), ls=":", lw=1, color=tokens.colour("edge")
        )
        top = 1.15 * max(per_hour)
        drawn.scale(("hour of the day", demand.seconds / 3600), ("orders an hour", top))

    rows = [[f"{hour:.2f}", f"{count:,.1f}"] for hour, count in zip(hours, demand.orders)]
    return _chart(
        f"Orders come {demand.peak_per_hour:,.0f} an hour at the peak",
        "Orders an hour over the day; dotted: the mean",
        draw,
        ["from hour", "orders"],
        rows,
    )


def _shares(title: str, noun: str, shares: Mapping[int, float], mean: float) -> Chart:
    counts = sorted(shares)
    kept = [n for n in counts if n < MOST_BARS]
    heights = [100 * shares[n] for n in kept]
    rest = 100 * sum(shares[n] for n in counts if n >= MOST_BARS)

    def draw(drawn: Canvas) -> None:
        drawn.axes.bar(kept, heights, 0.8, color=tokens.series(0))
        if rest:
            drawn.axes.bar([MOST_BARS], [rest], 0.8, color=tokens.series(1))
            drawn.say(MOST_BARS, rest, "or more", xytext=(-16, 4))
        most = (MOST_BARS if rest else max(kept)) + 1
        drawn.scale((noun, most), ("share [%]", 1.1 * max([*heights, rest])))

    return _chart(
        f"{title}: {mean:.2f} on the average",
        f"Share [%] over {noun}",
        draw,
        [noun, "share %"],
        [[f"{n:,}", f"{100 * shares[n]:.2f}"] for n in counts],
    )


def _popularity(demand: Demand) -> Chart:
    lines = np.array(list(demand.skus.values()), float)
    reach = 100 * np.cumsum(lines) / lines.sum()
    place = 100 * np.arange(1, len(lines) + 1) / len(lines)

    def draw(drawn: Canvas) -> None:
        drawn.axes.plot([0, *place], [0, *reach], lw=2, color=tokens.series(0))
        at = 0.0
        for name, share in demand.classes.items():
            at += 100 * share["skus"]
            drawn.axes.axvline(at, lw=1, ls=":", color=tokens.colour("edge"))
            drawn.say(at, 4, name, xytext=(-12, 0))
        drawn.scale(("SKUs, the most popular first [%]", 100), ("lines [%]", 104))

    rows = [
        [name, f"{100 * part['skus']:.1f}", f"{100 * part['lines']:.1f}"]
        for name, part in demand.classes.items()
    ]
    a = demand.classes["A"]
    return _chart(
        f"{100 * a['skus']:.0f} % of {len(lines):,} SKUs take {100 * a['lines']:.0f} % of lines",
        f"Share of the lines [%] over SKUs; Zipf's exponent is {demand.exponent:.2f}",
        draw,
        ["class", "SKUs %", "lines %"],
        rows,
    )


def _due(demand: Demand) -> Chart:
    minutes = np.asarray(demand.due.seconds) / 60
    share = 100 * (1 - demand.due.none) * np.linspace(0, 1, max(len(minutes), 1))

    def draw(drawn: Canvas) -> None:
        if len(minutes):
            drawn.axes.plot(minutes, share, lw=2, color=tokens.series(0))
        most = 1.05 * float(max([*minutes, 1.0]))
        drawn.scale(("minutes", most), ("orders due within them [%]", 104))

    rows = [[f"{n:,.1f}", f"{percent:.0f}"] for n, percent in zip(minutes, share)]
    return _chart(
        "Time until orders are due",
        f"Share of the orders [%] over minutes; {100 * demand.due.none:.0f} % have no due time",
        draw,
        ["minutes", "share %"],
        rows,
    )


def _repeated(demand: Demand) -> Chart:
    share = 100 * demand.repeated

    def draw(drawn: Canvas) -> None:
        drawn.axes.barh([1], [100], 0.5, color=tokens.colour("line"))
        drawn.axes.barh([1], [share], 0.5, color=tokens.series(0))
        drawn.say(share, 1, f"{share:.1f} %", "text", xytext=(6, -4))
        drawn.scale(("rows [%]", 100), ("", 2), upright=False)
        drawn.axes.set_yticks([])

    return _chart(
        f"{share:.1f} % of the rows repeat a SKU of their order",
        "Share of the rows [%]",
        draw,
        ["rows", "share %"],
        [["repeated", f"{share:.2f}"]],
    )
