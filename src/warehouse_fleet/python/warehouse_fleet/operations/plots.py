# SPDX-License-Identifier: Apache-2.0
"""The report's pictures, as SVG that stands inside a page."""

import io
import re
from itertools import count

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

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
_ids = count()
mpl.rcParams.update({"font.size": 9, "svg.hashsalt": "report", "svg.fonttype": "none"})


def throughput(groups):
    """Pieces an hour over the time of the shift, the mean of each group's runs."""
    figure, axes = _figure(7.5, 2.8)
    for colour, group in zip(_colours(), groups):
        rows = [run.data["intervals"]["picked"] for run in group.runs]
        seconds = group.runs[0].data["intervals"]["seconds"]
        length = min(map(len, rows))
        if not length:
            continue
        hourly = np.array([row[:length] for row in rows]) * 3600 / seconds
        width = max(1, min(10, length // 6))
        smooth = np.array([np.convolve(row, np.ones(width) / width, "valid") for row in hourly])
        minutes = (np.arange(smooth.shape[1]) + width) * seconds / 60
        axes.plot(minutes, smooth.mean(0), color=colour, label=group.label)
        if len(rows) > 1:
            axes.fill_between(minutes, smooth.min(0), smooth.max(0), color=colour, alpha=0.15, lw=0)
    bound = groups[0].estimate("item_upper_bound_per_hour").mean
    axes.axhline(bound, color="#999", ls="--", lw=1)
    axes.text(0, bound, " upper bound", va="bottom", color="#777")
    axes.set(xlabel="time of the shift [min]", ylabel="pieces an hour", ylim=(0, bound * 1.15))
    return _svg(figure, axes, len(groups) > 1)


def stations(group):
    """How busy each station is, of one group's first run."""
    rows = group.runs[0].data["stations"]
    figure, axes = _figure(7.5, 2.4)
    colours = [COLOURS[0] if row["kind"] == "PICK" else COLOURS[2] for row in rows]
    axes.bar(range(len(rows)), [100 * row["busy_fraction"] for row in rows], color=colours)
    axes.set(ylabel="busy [%]", ylim=(0, 105), xlabel="stations: picking blue, replenishing green")
    if len(rows) <= 24:
        axes.set_xticks(range(len(rows)), [row["name"] for row in rows], rotation=60, ha="right")
    return _svg(figure, axes, False)


def turnover(groups):
    """From an order's arrival to its completion: which share is done within a time."""
    figure, axes = _figure(3.7, 2.6)
    for colour, group in zip(_colours(), groups):
        minutes = np.sort(np.concatenate([run.data["turnover_s"] for run in group.runs])) / 60
        if len(minutes):
            share = np.arange(1, len(minutes) + 1) / len(minutes) * 100
            axes.plot(*_thinned(minutes, share), color=colour, label=group.label)
    axes.set(xlabel="minutes from arrival to completion", ylabel="orders [%]", ylim=(0, 102))
    return _svg(figure, axes, False)


def robots(groups):
    """Where the time of the robots goes."""
    figure, axes = _figure(7.5, 0.9 + 0.4 * len(groups))
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
    return _svg(figure, axes, False)


def heat_map(values, title):
    """How much of something there is over the floor."""
    values = np.asarray(values, float)
    height, width = values.shape
    figure, axes = _figure(3.7, min(max(3.7 * height / width, 1.5), 5))
    top = np.percentile(values[values > 0], 99) if (values > 0).any() else 1.0
    shown = np.ma.masked_equal(values, 0)
    image = axes.imshow(shown, origin="lower", cmap="YlOrRd", vmin=0, vmax=top)
    axes.set(title=title, xticks=[], yticks=[])
    axes.spines[:].set_visible(True)
    figure.colorbar(image, shrink=0.7)
    return _svg(figure, axes, False)


def comparison(groups, kpi, label):
    """One figure of all groups, with confidence intervals."""
    figure, axes = _figure(3.7, 0.8 + 0.3 * len(groups))
    found = [group.estimate(kpi) for group in groups]
    half = [0 if np.isnan(one.half) else one.half for one in found]
    rows = range(len(groups))
    axes.errorbar(
        [one.mean for one in found], rows, xerr=half, fmt="o", color=COLOURS[0], capsize=3
    )
    axes.set_yticks(rows, [group.label for group in groups])
    axes.set(xlabel=label, ylim=(len(groups) - 0.5, -0.5))
    axes.grid(axis="x", color="#eee")
    return _svg(figure, axes, False)


def _colours():
    while True:
        yield from COLOURS


def _figure(width, height):
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots()
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def _svg(figure, axes, legend):
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


def _thinned(x, y, most=400):
    step = max(1, len(x) // most)
    return x[::step], y[::step]


def _sum(dicts):
    total = {}
    for one in dicts:
        for key, value in one.items():
            total[key] = total.get(key, 0.0) + value
    return total
