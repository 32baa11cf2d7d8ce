# SPDX-License-Identifier: Apache-2.0
"""Runs and scenarios as the page shows them."""

import functools
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.generate import layout_choice
from warehouse_layout.place import placement
from warehouse_operations.runs.run_files import Run
from warehouse_operations.sizing.costs import Costs, LayoutCosts
from warehouse_viewer.whatif import stored
from warehouse_viewer.whatif.queue import Active
from warehouse_viewer.whatif.stored import Planned

CUT = "cut"  # the state of a run whose server ended
BEGUN = 0.1  # share of a run from which its own pace gives its duration

Json = dict[str, Any]


@functools.lru_cache(1000)
def planned(file: Path, _: tuple[int, int]) -> tuple[Planned, ...]:
    """Returns the runs of a scenario's file of that version. Raises SweepError."""
    return stored.planned(file)


@functools.lru_cache(1000)
def layout_counts(layout: str, _: int) -> tuple[int, int]:
    """Returns the robots and picking stations of a layout of that version."""
    file = layout_choice.chosen(layout)
    robots = file.robots if isinstance(file.robots, int) else len(file.robots)
    return robots, sum(station.kind != "replenish" for station in file.stations)


@functools.lru_cache(100)
def _priced(layout: str, _: int) -> tuple[LayoutFile, int]:
    file = layout_choice.chosen(layout)
    return file, len(placement.place(file).units)


def layout_costs(costs: Costs, layout: str, version: int) -> LayoutCosts:
    """Returns the costs of a layout of that version."""
    return LayoutCosts(costs, *_priced(layout, version))


def changed(path: Path) -> int:
    """Returns when a file was changed [ns]; 0 where there is none."""
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def site(name: str, robots: int, stations: int) -> Json:
    """Returns the warehouse of a scenario."""
    return {"name": name, "robots": robots, "stations": stations}


def run(planned: Planned, run: Run | None, active: Active | None, waits: bool, state: Json) -> Json:
    """Returns a run as the page shows it."""
    out: Json = {"seed": planned.seed, "state": "none"}
    if active:
        progress = active.progress
        share = min(progress.get("time", 0.0) / planned.seconds, 1.0)
        took = time.monotonic() - active.began
        return out | {"state": "runs", "share": share, "took": took}
    if waits:
        return out | {"state": "waits"}
    if run:
        return out | {"state": "done", "faults": state.get("faults") or []}
    known = state.get("state")
    if known in ("waits", "runs"):
        known = CUT  # neither in the queue nor over: it ended without a word
    return out | {"state": known or "none", "text": state.get("text", "")}


def state(each: Sequence[Json]) -> str:
    """Returns the state of a scenario from the states of its runs."""
    states = {row["state"] for row in each}
    for state in ("runs", "waits", "failed", CUT, "cancelled"):
        if state in states:
            return "runs" if state == "waits" else state
    return "done" if states == {"done"} else "part" if "done" in states else "none"


def left(row: Json, cost: float, start: float) -> float:
    """Returns how long a run still takes [s, wall]: by its own pace once it is well begun.

    start: what a process takes besides the shift, half of it for the report in the end.
    """
    if row["state"] != "runs":
        return cost
    share = row["share"]
    if share < BEGUN:
        return max(cost - float(row["took"]), start / 2)
    return max(row["took"] - start / 2, 0.0) * (1 - share) / share + start / 2
