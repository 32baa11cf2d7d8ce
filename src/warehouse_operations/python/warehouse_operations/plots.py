# SPDX-License-Identifier: Apache-2.0
"""The report's pictures, as SVG to be put inside a page."""

import io
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from warehouse_operations.comparison import Group

COLOURS = ("#2f6f9f", "#c96a2b", "#4f8f4f", "#9a4f8f", "#8a7a3a", "#5a5a5a")
ACTIVITY_COLOURS = {
    "to unit": "#7fb2d6",
    "lift": "#c9a23b",
    "to station": "#2f6f9f",
    "queue": "#c96a2b",
    "service": "#4f8f4f",
    "back": "#9a9ac9",
    "idle": "#d8d8d8",
}
GREYS = {"s": 0.88, "p": 0.94, "l": 0.97, "#": 0.62}  # of cells, beneath a heat map
BLOCKS = 12  # most parts of a shift: shorter ones show little but chance
_ids = count()
mpl.rcParams.update({"font.size": 9, "svg.hashsalt": "report", "svg.fonttype": "none"})


def throughput(groups: Sequence[Group]) -> str:
    """Returns a picture of the pieces an hour over the shift, as means over BLOCKS parts of it.

    A band reaches from the least to the most where there are several runs.
    """
    figure, axes = new_figure(7.5, 2.8)
    bounds = [group.estimate("item_upper_bound_per_hour").mean for group in groups]
    top, end = max(bounds), 0.0
    for colour, group, bound in zip(_colours(), groups, bounds):
        hourly, minutes = _in_blocks(group)
        axes.axhline(bound, color=colour if len(groups) > 1 else "#999", ls="--", lw=1)
        if not hourly.size:
            continue
        axes.stairs(hourly.mean(0), minutes, baseline=None, color=colour, label=group.label)
        if len(hourly) > 1:
            low, high = hourly.min(0), hourly.max(0)
            axes.stairs(high, minutes, baseline=low, fill=True, color=colour, alpha=0.15, lw=0)
        top, end = max(top, hourly.max()), max(end, minutes[-1])
    axes.text(0, max(bounds), " upper bound of picking", va="bottom", color="#777")
    axes.set(xlabel="time of the shift [min]", ylabel="pieces an hour")
    axes.set(xlim=(0, end or 1), ylim=(0, top * 1.15 or 1))
    return as_svg(figure, axes, len(groups) > 1)


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


def stations(group: Group) -> str:
    """Returns a picture of how busy each station is, in the first run of a group."""
    rows = group.runs[0].data["stations"]
    figure, axes = new_figure(7.5, 2.4)
    colours = [COLOURS[0] if row["kind"] == "PICK" else COLOURS[2] for row in rows]
    axes.bar(range(len(rows)), [100 * row["busy_fraction"] for row in rows], color=colours)
    axes.set(ylabel="busy [%]", ylim=(0, 105), xlabel="stations: picking blue, replenishing green")
    if len(rows) <= 24:
        axes.set_xticks(range(len(rows)), [row["name"] for row in rows], rotation=60, ha="right")
    return as_svg(figure, axes, False)


def turnover(groups: Sequence[Group]) -> str:
    """Returns a picture of the share of orders that are completed within a time of arrival."""
    figure, axes = new_figure(3.7, 2.6)
    for colour, group in zip(_colours(), groups):
        minutes = np.sort(np.concatenate([run.data["turnover_s"] for run in group.runs])) / 60
        if len(minutes):
            share = np.arange(1, len(minutes) + 1) / len(minutes) * 100
            axes.plot(*_thinned(minutes, share), color=colour, label=group.label)
    axes.set(xlabel="minutes from arrival to completion", ylabel="orders [%]", ylim=(0, 102))
    return as_svg(figure, axes, False)


def robots(groups: Sequence[Group]) -> str:
    """Returns a picture of the activities that robots spend their time on."""
    figure, axes = new_figure(7.5, 0.9 + 0.4 * len(groups))
    for row, group in enumerate(groups):
        totals = _sum([run.data["robots"] for run in group.runs])
        whole, left = sum(totals.values()) or 1.0, 0.0
        for activity, colour in ACTIVITY_COLOURS.items():
            share = 100 * totals.get(activity, 0.0) / whole
            axes.barh(row, share, left=left, color=colour, label=activity if not row else None)
            left += share
    labels = [group.label if len(groups) > 1 else "" for group in groups]
    axes.set_yticks(range(len(groups)), labels)
    axes.invert_yaxis()
    axes.set(xlabel="share of the robots' time [%]", xlim=(0, 100))
    axes.legend(ncol=7, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, fontsize=8)
    return as_svg(figure, axes, False)


def heat_map(values: Any, title: str, floor: Sequence[str] = ()) -> str:
    """Returns a picture of values over the floor, (h, w).

    floor: its rows as runs.floor_rows() tells them, the lowest first; they lie beneath the values.
    """
    values = np.asarray(values, float)
    height, width = values.shape
    figure, axes = new_figure(3.7, min(max(3.7 * height / width, 1.5), 5))
    top = np.percentile(values[values > 0], 99) if (values > 0).any() else 1.0
    if len(floor) == height:
        axes.imshow(_ground(floor), origin="lower")
    shown = np.ma.masked_equal(values, 0)
    image = axes.imshow(shown, origin="lower", cmap="YlOrRd", vmin=0, vmax=top)
    axes.set(title=title, xticks=[], yticks=[])
    axes.spines[:].set_visible(True)
    figure.colorbar(image, shrink=0.7)
    return as_svg(figure, axes, False)


def _ground(floor: Sequence[str]) -> np.ndarray:
    """Returns the colours of a floor's cells, (h, w, 3)."""
    rows = np.array([list(row) for row in floor])
    colours = np.ones((*rows.shape, 3))
    for character, grey in GREYS.items():
        colours[rows == character] = grey
    return colours


def comparison(groups: Sequence[Group], kpi: str, label: str) -> str:
    """Returns a picture of one figure of all groups, with confidence intervals of several runs.

    The axis begins at zero: a difference looks as large as it is.
    """
    figure, axes = new_figure(3.7, 0.8 + 0.3 * len(groups))
    found = [group.estimate(kpi) for group in groups]
    half = [0 if np.isnan(one.half) else one.half for one in found]
    rows = range(len(groups))
    axes.errorbar(
        [one.mean for one in found], rows, xerr=half, fmt="o", color=COLOURS[0], capsize=3
    )
    axes.set_yticks(rows, [group.label for group in groups])
    top = max(one.mean + more for one, more in zip(found, half))
    axes.set(xlabel=label, xlim=(0, 1.08 * top or 1), ylim=(len(groups) - 0.5, -0.5))
    axes.grid(axis="x", color="#eee")
    return as_svg(figure, axes, False)


def _colours() -> Iterator[str]:
    while True:
        yield from COLOURS


def new_figure(width: float, height: float) -> tuple[Figure, Any]:
    """Returns an empty figure of that size [in] and its axes."""
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots()
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def as_svg(figure: Figure, axes: Any, legend: bool) -> str:
    """Returns a figure as SVG to be put inside a page, with a legend or without."""
    if legend:
        axes.legend(frameon=False, fontsize=8)
    file = io.StringIO()
    figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    text = file.getvalue()
    text = text[text.index("<svg") :]
    # Several pictures in one page must not share names.
    prefix = f"p{next(_ids)}-"
    text = re.sub(r'\bid="', f'id="{prefix}', text)
    return re.sub(r'(url\(#|href="#)', rf"\g<1>{prefix}", text)


def _thinned(x: np.ndarray, y: np.ndarray, most: int = 400) -> tuple[np.ndarray, np.ndarray]:
    step = max(1, len(x) // most)
    return x[::step], y[::step]


def _sum(dicts: Iterable[Mapping[str, float]]) -> dict[str, float]:
    total: dict[str, float] = {}
    for one in dicts:
        for key, value in one.items():
            total[key] = total.get(key, 0.0) + value
    return total
