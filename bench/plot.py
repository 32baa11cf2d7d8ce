# SPDX-License-Identifier: Apache-2.0
"""The plot of the benchmarks: real-time factor over the number of robots."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# In the plot's order; colours of Okabe and Ito, which colour-blind people can tell apart.
STYLES = {
    "default": ("this world, default robots, 121 rays", "#0072B2", "o-", 2.5),
    "default, no scan read": ("this world, default robots, no scan read", "#56B4E9", "o-", 2.5),
    "arrays, 121 rays": ("bare arrays, no engine, 121 rays", "#666666", "^--", 1),
    "at_once": ("this world, at full speed at once, 20 rays", "#0072B2", "o:", 1.5),
    "jointed": ("this world, jointed", "#D55E00", "s-", 2.5),
    "arrays": ("bare arrays, no engine, 20 rays", "#000000", "^--", 1),
    "Bullet kinematic": ("Bullet, kinematic bodies", "#009E73", "v--", 1),
    "Bullet hinges": ("Bullet, hinged wheels", "#CC79A7", "v--", 1),
    "pybullet": ("pybullet, wheel joints", "#E69F00", "x:", 1.5),
    "MuJoCo": ("MuJoCo, wheel joints", "#999999", "x:", 1.5),
    "pybullet-fleet, no lasers": ("pybullet-fleet, 0.1 s step, no lasers", "#F0E442", "x:", 1.5),
}


def draw(figures, path):
    """`figures`: dicts with engine, robots, lasers and rtf_cpu."""
    lines = {}
    for figure in figures:
        read = "" if figure.get("read", True) else ", no scan read"
        key = figure["engine"] + (read if figure["lasers"] else ", no lasers")
        lines.setdefault(key, {})[figure["robots"]] = figure["rtf_cpu"]
    plt.figure(figsize=(8, 5.5))
    for key, (label, colour, style, width) in STYLES.items():
        if len(lines.get(key, {})) > 1:
            robots, factors = zip(*sorted(lines[key].items()))
            plt.loglog(robots, factors, style, color=colour, label=label, lw=width, ms=5)
    plt.axhline(1, color="#666666", lw=1)
    plt.text(1, 1.1, "real time", color="#666666", fontsize=8)
    plt.xlabel("robots")
    plt.ylabel("simulated seconds a CPU second of one thread")
    plt.grid(which="major", alpha=0.3)
    plt.legend(fontsize=8, frameon=False)
    plt.tight_layout()
    plt.savefig(path, dpi=110)
