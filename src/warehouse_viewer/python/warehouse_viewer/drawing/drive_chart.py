# SPDX-License-Identifier: Apache-2.0
"""The figure of a plan that was driven with bodies: its progress, and what robots do."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from warehouse_fleet.league.drive_report import WORDS
from warehouse_fleet.league.plan_driver import Cause
from warehouse_operations.document import canvas

SIZE = (1040, 360)  # [px]
MARGINS = (60, 20, 36, 44)
KEY = 275  # [px] beside the right half
COLOURS = {
    Cause.DRIVING: "#2a9d63",
    Cause.ACCELERATION: "#9bd3b0",
    Cause.TURN: "#4f86c6",
    Cause.AHEAD: "#e0a030",
    Cause.ORDER: "#c8553d",
    Cause.RING: "#7b4fa3",
    Cause.RELEASE: "#c9ccd1",
    Cause.ARRIVED: "#eceef0",
}


def write(path: Path, figures: dict[str, Any], curve: list[list[float]]) -> None:
    """Writes the figure of a drive as PNG; `figures` and `curve` as in drive_report."""
    rows = np.array(curve)
    canvas.write_png(path, lambda figure: _draw(figure, figures, rows), *SIZE)


def _draw(figure: Figure, figures: dict[str, Any], rows: np.ndarray) -> None:
    half = (SIZE[0] - KEY) / 2
    _draw_ticks(canvas.on(figure, (0, 0, half, SIZE[1]), MARGINS), figures, rows)
    right = (MARGINS[0], KEY, *MARGINS[2:])
    _draw_causes(canvas.on(figure, (half, 0, half + KEY, SIZE[1]), right), rows)


def _draw_ticks(drawn: canvas.Canvas, figures: dict[str, Any], rows: np.ndarray) -> None:
    """Draws the tick that robots have come to over time, and where they would be by the plan."""
    time, end = rows[:, 0] / 60, figures["ticks"]
    drawn.axes.plot(time, rows[:, 1], color=COLOURS[Cause.DRIVING], lw=2)
    planned = end * figures["tick_s"] / 60
    drawn.axes.plot([0, planned], [0, end], color="#888888", lw=1.2, ls="--")
    drawn.scale(("minutes", time[-1]), ("tick of the plan, mean of robots", end))
    drawn.say(planned, end, "as planned", xytext=(6, -14))


def _draw_causes(drawn: canvas.Canvas, rows: np.ndarray) -> None:
    """Draws how many robots do what over time, one above the other."""
    time, robots = rows[1:, 0] / 60, rows[1:, 2:].T
    colours = [COLOURS[cause] for cause in Cause]
    labels = [WORDS[cause] for cause in Cause]
    layers = drawn.axes.stackplot(time, robots, colors=colours, labels=labels)
    drawn.scale(("minutes", time[-1]), ("robots", robots.sum(axis=0).max()))
    drawn.axes.legend(
        layers[::-1],
        labels[::-1],
        loc="center left",
        bbox_to_anchor=(1.0, 0.5),
        frameon=False,
        fontsize=canvas.SMALL - 1,
    )
