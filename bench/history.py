# SPDX-License-Identifier: Apache-2.0
"""What the fleet's benchmark measured at each commit: history.jsonl, a line a run."""

import json
import subprocess

from programs import BENCH

FILE = BENCH / "history.jsonl"

# The bare arrays do the same work, with as many rays.
ARRAYS = {"default": "arrays, 121 rays", "at_once": "arrays"}


def name(figure):
    """Of what it is a figure, such as "default, N = 1,000, no scan read"."""
    read = "" if figure.get("read", True) else ", no scan read"
    lasers = read if figure["lasers"] else ", no lasers"
    return f"{figure['engine']}, N = {figure['robots']:,}{lasers}"


def ratios(figures):
    """Real-time factors by CPU over those of the bare arrays with as many robots, by name."""
    arrays = {(f["engine"], f["robots"]): f["rtf_cpu"] for f in figures if f["lasers"]}
    out = {}
    for figure in figures:
        beside = arrays.get((ARRAYS.get(figure["engine"]), figure["robots"]))
        if beside and figure["lasers"]:
            out[name(figure)] = figure["rtf_cpu"] / beside
    return out


def last():
    """The newest line, a dict, or None."""
    lines = FILE.read_text().splitlines() if FILE.exists() else []
    return json.loads(lines[-1]) if lines else None


def append(figures):
    """Adds a line for the commit that is checked out; `+` marks changes that it doesn't have."""
    commit = _git("rev-parse", "--short", "HEAD") + ("+" if _git("status", "--porcelain") else "")
    line = {
        "commit": commit,
        "time": _git("log", "-1", "--format=%cI"),
        "rtf_cpu": {name(f): f["rtf_cpu"] for f in figures},
        "ratios": {what: round(ratio, 3) for what, ratio in ratios(figures).items()},
    }
    with FILE.open("a") as file:
        file.write(json.dumps(line) + "\n")


def _git(*words):
    command = ["git", "-C", str(BENCH), *words]
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
