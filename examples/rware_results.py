#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what examples/rware_train.py has trained, beside the fleet's planner and chance, on the
grid and with bodies, and draws learning curves. For several seeds it prints the interquartile mean,
with 95 % bands by the stratified bootstrap, as rliable has them.

examples/rware_results.py results                               # all that lies in that folder
examples/rware_results.py results --physics bodies --episodes 50
"""

import argparse
import json
from collections import defaultdict
from pathlib import Path

import numpy as np

from warehouse_learning.marl import evaluation, policy, statistics
from warehouse_learning.rware import options_of
from warehouse_learning.rware.motion import PHYSICS

TEST_SEED = 1_000_000  # of the first episode; trainings draw theirs below 2**31 by chance
POINTS = 50  # of a curve


def main():
    options = arguments()
    folder = Path(options.folder)
    trained = defaultdict(list)  # by task and algorithm
    for file in sorted(folder.glob("*.json")):
        record = json.loads(file.read_text())
        if "curve" in record:
            on = record.get("physics", "grid")
            learnt = record["settings"]["algorithm"].upper()
            kind = learnt if on == "grid" else f"{learnt} with {on}"
            trained[record["task"], kind].append(file)
    if not trained:
        raise SystemExit(f"{folder}: there is no training; examples/rware_train.py TASK makes one")
    print("| task | who | physics | seeds | steps each | return | 95 % | seconds an episode |")
    print("|---|---|---|---|---|---|---|---|")
    for (task, algorithm), files in trained.items():
        for physics in options.physics or PHYSICS:
            of_policies(task, algorithm, files, physics, options.episodes)
    for task in dict.fromkeys(task for task, _ in trained):
        for physics in options.physics or PHYSICS:
            scripted(task, physics, options.episodes)
    draw(folder / "curves.png", trained)


def arguments():
    parser = argparse.ArgumentParser(
        "rware_results", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder")
    parser.add_argument("--episodes", type=int, default=100, help="of each seed (100)")
    parser.add_argument("--physics", action="append", choices=PHYSICS, help="all")
    return parser.parse_args()


def played(make_act, task, physics, count):
    return evaluation.episodes(make_act, count, TEST_SEED, physics=physics, **options_of(task))


def of_policies(task, algorithm, files, physics, count):
    """A line of the table: each seed's mean return, and what they come to together."""
    scores, seconds, steps = [], [], []
    for file in files:
        learnt = policy.load(file.with_suffix(".npz"))
        results = played(evaluation.by_policy(learnt), task, physics, count)
        scores.append(results["returns"].mean())
        seconds.append(results.get("seconds", np.zeros(1)).mean())
        steps.append(learnt.about["steps"])
    mean, low, high = statistics.interval([np.array(scores)])
    band = f"{low:.1f} to {high:.1f}" if len(files) > 1 else "one seed"
    line(task, algorithm, physics, len(files), f"{np.mean(steps):,.0f}", mean, band, seconds)


def scripted(task, physics, count):
    for name, act in (("planner", evaluation.by_planner), ("chance", evaluation.by_chance)):
        results = played(act, task, physics, count)
        error = 1.96 * results["returns"].std(ddof=1) / np.sqrt(count)
        mean = results["returns"].mean()
        band = f"{mean - error:.1f} to {mean + error:.1f}"
        line(task, name, physics, "", "", mean, band, results.get("seconds", np.zeros(1)))


def line(task, who, physics, seeds, steps, mean, band, seconds):
    time = f"{np.mean(seconds):.0f}" if np.any(seconds) else ""
    print(
        f"| {task} | {who} | {physics} | {seeds} | {steps} | {mean:.1f} | {band} | {time} |",
        flush=True,
    )


def draw(path, trained):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure((8, 4.5), dpi=110)
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    for (task, algorithm), files in trained.items():
        curves = [json.loads(file.read_text())["curve"] for file in files]
        at = np.linspace(0, min(curve[-1][0] for curve in curves), POINTS + 1)[1:]
        returns = statistics.aligned(curves, at)
        mean, low, high = statistics.interval([returns])
        seeds = f"{len(files)} seeds" if len(files) > 1 else "one seed"
        (drawn,) = axes.plot(at / 1e6, mean, label=f"{task}, {algorithm}, {seeds}")
        if len(files) > 1:
            axes.fill_between(at / 1e6, low, high, color=drawn.get_color(), alpha=0.25, lw=0)
    axes.set_xlabel("steps of the environments [million]")
    axes.set_ylabel("return of an episode of 500 steps, interquartile mean")
    axes.legend(frameon=False)
    figure.savefig(path)
    print(f"\n{path} is drawn")


if __name__ == "__main__":
    main()
