# SPDX-License-Identifier: Apache-2.0
"""Draws learning curves, which needs Matplotlib."""

import json
from collections.abc import Sequence

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from warehouse_learning import baselines
from warehouse_learning.options import Options


def draw(path: str, options: Options, curves: Sequence[np.ndarray]) -> None:
    """Draws the curves of several seeds beside what the other baselines deliver."""
    figure = Figure((8, 4.5), dpi=110)
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    at = curves[0][:, 0]
    values = np.array([np.interp(at, curve[:, 0], curve[:, 1]) for curve in curves])
    axes.fill_between(at, values.min(0), values.max(0), alpha=0.25, lw=0)
    axes.plot(at, values.mean(0), label=f"IPPO, {len(curves)} seeds")
    others = {"random": baselines.random_policy(), "greedy": baselines.greedy_policy(options)}
    for style, (name, policy) in zip((":", "--"), others.items()):
        delivered = baselines.measure(policy, options, 16)[0].mean()
        axes.axhline(delivered, ls=style, color="0.3", label=f"{name}, {delivered:.1f}")
    axes.set_xlabel("decisions of all robots")
    axes.set_ylabel(f"units delivered in {options.max_cycles} decisions a robot")
    axes.legend(frameon=False)
    axes.set_title(f"{options.robots} robots, {options.shelves} storage units")
    figure.savefig(path)
    with open(path.rsplit(".", 1)[0] + ".json", "w", encoding="utf-8") as file:
        json.dump([curve.tolist() for curve in curves], file)
