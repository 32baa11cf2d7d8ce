# SPDX-License-Identifier: Apache-2.0
"""How long runs take: from those that are there already, else from what is usual."""

from collections.abc import Iterable
from statistics import median
from typing import NamedTuple

from warehouse_operations.runs.run_files import Run

START = 4.0  # of a process, and its report [s, wall]
# Wall seconds that a robot takes for a simulated one, without and with physics.
USUAL = {False: 1.5e-4, True: 3e-3}
RECENT = 20  # runs that are looked at, of each kind


class Done(NamedTuple):
    """A run that is over. took: by its whole process [s, wall]; 0: not known."""

    run: Run
    took: float


class Pace:
    """What a process costs, and a robot in it for a simulated second, with physics or without
    [s, wall]."""

    def __init__(self, done: Iterable[Done] = ()) -> None:
        ratios: dict[bool, list[float]] = {False: [], True: []}
        starts = [START]
        for run, took in done:
            kpis = run.kpis
            work = kpis["robots"] * kpis["simulated_s"]
            if work > 0:
                ratios[bool(run.config.get("physics"))].append(kpis["wall_s"] / work)
            if took:
                starts.append(max(took - kpis["wall_s"], 0.0))
        self._costs = {kind: median(of[-RECENT:]) for kind, of in ratios.items() if of}
        self.start = median(starts[-RECENT:])

    def seconds(self, robots: int, simulated_s: float, physics: bool) -> float:
        """Returns how long a run probably takes [s, wall]."""
        cost = self._costs.get(physics, USUAL[physics])
        return self.start + cost * robots * simulated_s
