# SPDX-License-Identifier: Apache-2.0
"""The pictures of a sizing's report, as SVG."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from warehouse_operations.plots import COLOURS, as_svg, new_figure
from warehouse_operations.sizing.answer import knee
from warehouse_operations.sizing.study import Study
from warehouse_operations.sizing.verdict import Verdict

FAR = 2.5  # times the robots of the answer
Chosen = tuple[int, int] | None  # robots and stations of the answer


def throughput(study: Study, chosen: Chosen) -> str:
    """Returns orders an hour over robots, a line for each number of stations with its knee."""
    figure, axes = new_figure(4.6, 3.2)
    _draw_throughput(axes, study, chosen)
    return as_svg(figure, axes, True)


def lateness(study: Study, chosen: Chosen) -> str:
    """Returns the share of late and of missed orders over robots, for each number of stations."""
    figure, axes = new_figure(4.6, 3.2)
    _draw_lateness(axes, study, chosen)
    return as_svg(figure, axes, False)


def write_png(path: Path, study: Study, chosen: Chosen) -> None:
    """Writes both of these side by side, for slides."""
    figure = Figure(figsize=(10.4, 3.4), layout="constrained", dpi=120)
    left, right = figure.subplots(1, 2)
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
    _draw_throughput(left, study, chosen)
    _draw_lateness(right, study, chosen)
    left.legend(frameon=False, fontsize=8)
    figure.savefig(path)


def _draw_throughput(axes: Any, study: Study, chosen: Chosen) -> None:
    for colour, stations, verdicts in _by_stations(study):
        _band(axes, verdicts, "orders_per_hour", 1.0, colour, _stations(stations))
        at = knee(verdicts)
        if at is not None:
            hourly = next(v for v in verdicts if v.robots == at).estimate("orders_per_hour").mean
            axes.plot(at, hourly, marker="v", ms=8, mfc="none", color=colour)
    axes.axhline(study.wish.orders_per_hour, color="#999", ls="--", lw=1)
    axes.text(0, study.wish.orders_per_hour, " asked", va="bottom", color="#777")
    _checks(axes, study, "orders_per_hour", 1.0)
    _mark(axes, chosen)
    top = 1.15 * study.wish.orders_per_hour
    axes.set(xlabel="robots", ylabel="orders completed an hour", ylim=(0, top))
    axes.set(xlim=(0, _most(chosen)))


def _draw_lateness(axes: Any, study: Study, chosen: Chosen) -> None:
    for colour, _, verdicts in _by_stations(study):
        _band(axes, verdicts, "late", 100.0, colour, "")
        _band(axes, verdicts, "missed", 100.0, colour, "", ls=":")
    _checks(axes, study, "missed", 100.0)
    late = 100 * study.wish.late
    axes.axhline(late, color="#999", ls="--", lw=1)
    _mark(axes, chosen)
    top = min(max(10 * late, 5.0), 100.0)
    axes.set(xlabel="robots", ylabel="orders late (line), missed (dotted) [%]")
    axes.set(ylim=(0, top), xlim=(0, _most(chosen)))


def use(study: Study, chosen: Chosen) -> str:
    """Returns how much of their time robots and stations work, over robots."""
    figure, axes = new_figure(7.5, 2.8)
    for colour, stations, verdicts in _by_stations(study):
        _band(axes, verdicts, "robots_at_work", 100.0, colour, f"robots, {_stations(stations)}")
        _band(axes, verdicts, "picking", 100.0, colour, "stations", ls=":")
    _mark(axes, chosen)
    axes.set(xlabel="robots", ylabel="at work [%]", ylim=(0, 102), xlim=(0, _most(chosen)))
    return as_svg(figure, axes, True)


def _most(chosen: Chosen) -> float | None:
    """Returns the robots up to which is drawn: where little changes any more is left out."""
    return FAR * chosen[0] if chosen else None


def _by_stations(study: Study) -> list[tuple[str, int, list[Verdict]]]:
    """Returns colour, stations and the points of each number of stations, by robots."""
    numbers = sorted({stations for _, stations in study.verdicts})
    points = [
        [v for key, v in sorted(study.verdicts.items()) if key[1] == number] for number in numbers
    ]
    return [(COLOURS[i % len(COLOURS)], *one) for i, one in enumerate(zip(numbers, points))]


def _band(
    axes: Any,
    verdicts: Sequence[Verdict],
    name: str,
    factor: float,
    colour: str,
    label: str,
    ls: str = "-",
) -> None:
    robots = [one.robots for one in verdicts]
    found = [one.estimate(name) for one in verdicts]
    mean = factor * np.array([one.mean for one in found])
    half = factor * np.nan_to_num([one.half for one in found])
    axes.plot(robots, mean, marker="o", ms=3, lw=1.2, ls=ls, color=colour, label=label or None)
    axes.fill_between(robots, mean - half, mean + half, color=colour, alpha=0.15, lw=0)


def _checks(axes: Any, study: Study, name: str, factor: float) -> None:
    """Draws the points of simulated robots."""
    for i, verdict in enumerate(study.checks.values()):
        found = verdict.estimate(name)
        label = "with physics" if not i else None
        axes.errorbar(
            verdict.robots,
            factor * found.mean,
            yerr=factor * np.nan_to_num(found.half),
            fmt="s",
            color="#222",
            ms=5,
            capsize=3,
            label=label,
        )


def _mark(axes: Any, chosen: Chosen) -> None:
    if chosen:
        axes.axvline(chosen[0], color="#222", lw=0.8, ls=":")


def _stations(number: int) -> str:
    return f"{number} station{'' if number == 1 else 's'}"
