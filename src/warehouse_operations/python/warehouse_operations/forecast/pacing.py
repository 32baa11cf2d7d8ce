# SPDX-License-Identifier: Apache-2.0
"""How much slower a shift's robots are than ideal ones, by its own past.

A unit's way back into storage is a drive with a lift at its end; no queue is part of it. Its mean
time lately, over that of ideal robots in a pilot run from the same fork, is what traffic costs.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from warehouse_operations.fleets.forked_fleet import Pace
from warehouse_operations.forecast.ahead import Ahead, Task

PILOT, SETTLE = 720.0, 120.0  # length of a pilot run, and its part that is left out [s]
FEWEST = 20  # ways of a mean
TRIMMED = 0.05  # share of the longest ways, which failures made
LEAST, MOST = 0.8, 3.0  # factors
NUMBER = 2**16  # of the pilot among the runs of a task


def paced(tasks: Sequence[Task]) -> list[Task]:
    """Returns the tasks of a fork with the pace of its robots; as they are where too little has
    happened."""
    first = tasks[0]
    if first.physics:  # they meet traffic
        return list(tasks)
    pace = pace_of(first)
    return [replace(task, fork=replace(task.fork, pace=pace)) for task in tasks]


def pace_of(task: Task) -> Pace:
    """Returns the pace of the robots of a task's fork."""
    past = task.fork.ways_back
    if len(past) < FEWEST:
        return Pace()
    pilot = Ahead(replace(task, events=()), NUMBER)
    pilot.step_until(task.fork.time + SETTLE)
    pilot.shift.tally.ways_back.clear()
    pilot.step_until(task.fork.time + PILOT)
    ideal = pilot.shift.tally.ways_back
    if len(ideal) < FEWEST:
        return Pace()
    lift = task.site.kinematics.lift
    ratio = (_mean(past) - lift) / max(_mean(ideal) - lift, 1.0)
    factor = min(max(ratio, LEAST), MOST)
    return Pace(factor, factor)


def _mean(ways: Sequence[float]) -> float:
    """Returns the mean of all ways but the longest."""
    ordered = np.sort(np.asarray(ways))
    return float(ordered[: max(round(len(ordered) * (1 - TRIMMED)), 1)].mean())
