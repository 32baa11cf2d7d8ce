# SPDX-License-Identifier: Apache-2.0
"""Judges a point by its shifts: is the wish met, and how sure is that?

An order that comes is met if it is completed in time. Those that are late, and those by which the
open orders pile up, are missed: of the orders that came after the warm-up, the part that was not
completed in time. A point meets a wish if the upper confidence limit of the mean part that is
missed, by Student's t over seeds, is at most the share that may be late.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import special

from warehouse_operations.comparison import CONFIDENCE, Estimate
from warehouse_operations.sizing.point import Record
from warehouse_operations.warm_up import mser5

FIRST = 2  # shifts after which a point that is far off is given up
MORE = (1, 2, 4)  # times the seeds of a wish, at which a point is judged
RISK = (1 - CONFIDENCE) / len(MORE)  # of one look: each has its part (Bonferroni)

Figures = dict[str, float]


def looks(seeds: int) -> list[int]:
    """Returns the numbers of shifts at which a point may be found to meet a wish."""
    return [seeds * times for times in MORE]


@dataclass(frozen=True)
class Verdict:
    """A point's shifts, and what they say. late: the share that may be late."""

    robots: int
    stations: int
    records: tuple[Record, ...]
    late: float
    seeds: int

    @property
    def decided(self) -> bool:
        """Whether more shifts would hardly say otherwise, or there are enough."""
        most = looks(self.seeds)[-1]
        return self.met or self.fails or len(self.records) >= most or self._hopeless(most)

    def _hopeless(self, most: int) -> bool:
        """Whether the wish would not be shown to be met if `most` shifts went on like these."""
        return len(self.records) >= self.seeds and self.limit(RISK, 1, most) > self.late

    @cached_property
    def met(self) -> bool:
        """Whether the wish is met with CONFIDENCE."""
        if len(self.records) < self.seeds:
            return False
        return self.limit(RISK, 1) <= self.late

    @cached_property
    def fails(self) -> bool:
        """Whether the wish is missed with CONFIDENCE."""
        return len(self.records) >= FIRST and self.limit(1 - CONFIDENCE, -1) > self.late

    def at_work(self) -> float:
        """Returns how many of the robots were at work, on the average."""
        return self.robots * self.estimate("robots_at_work").mean

    @property
    def word(self) -> str:
        """One of met, missed, undecided, and drawn: for the figure alone, by too few shifts."""
        if self.met or self.fails:
            return "met" if self.met else "missed"
        return "undecided" if len(self.records) >= self.seeds else "drawn"

    def limit(self, risk: float, side: int, shifts: int = 0) -> float:
        """Returns the upper (side 1) or lower (-1) limit of the mean part that is missed.

        shifts: so many would there be, with the same mean and deviation; 0: those there are.
        """
        values = np.array([one["missed"] for one in self.figures])
        if len(values) < 2:
            return math.inf * side
        count = shifts or len(values)
        error = values.std(ddof=1) / math.sqrt(count)
        return float(values.mean() + side * special.stdtrit(count - 1, 1 - risk) * error)

    @property
    def at_most(self) -> float:
        """The part of the orders that is missed at most, with CONFIDENCE."""
        return max(self.limit(RISK, 1), 0.0)

    @cached_property
    def warm_up(self) -> int:
        """The first minutes that are left out: until the open orders are steady."""
        return mser5([one.series["open"] for one in self.records])

    @cached_property
    def figures(self) -> list[Figures]:
        """The figures of each shift after the warm-up."""
        return [figures_of(one, self.warm_up) for one in self.records]

    def estimate(self, name: str) -> Estimate:
        """Returns the Estimate of one of the figures."""
        return Estimate.of([one[name] for one in self.figures])


def figures_of(record: Record, warm_up: int) -> Figures:
    """Returns the figures of a shift without its first minutes."""
    series = {name: np.array(values[warm_up:], float) for name, values in record.series.items()}
    total = {name: float(values.sum()) for name, values in series.items()}
    seconds = 60.0 * len(series["open"])
    hours, robot_s = seconds / 3600, seconds * record.robots
    overdue = float(series["overdue"][-1])
    done = total["completed"] - total["late"]
    pieces = total["pieces"] / hours
    return {
        "missed": 1 - done / max(total["arrived"], 1.0),
        "late": (total["late"] + overdue) / max(total["completed"] + overdue, 1.0),
        "orders_per_hour": total["completed"] / hours,
        "pieces_per_hour": pieces,
        "open_orders": float(series["open"].mean()),
        "pile_on": total["pieces"] / max(total["visits"], 1.0),
        "picking": total["picking_s"] / (seconds * record.stations),
        "replenishing": total["replenishing_s"] / max(seconds * record.replenishing, 1.0),
        "of_bound": pieces / record.bound_per_hour if record.bound_per_hour else 0.0,
        "robots_at_work": 1 - (total["idle_s"] + total["queue_s"]) / robot_s,
        "robots_idle": total["idle_s"] / robot_s,
        "robots_queue": total["queue_s"] / robot_s,
        "metres_per_piece": total["metres"] / max(total["pieces"], 1.0),
    }


def difference(first: Verdict, second: Verdict, name: str) -> Estimate:
    """Returns by how much a figure of `second` is above that of `first`, seed by seed."""
    seen = {one.seed: figures[name] for one, figures in zip(first.records, first.figures)}
    deltas: Sequence[float] = [
        figures[name] - seen[one.seed]
        for one, figures in zip(second.records, second.figures)
        if one.seed in seen
    ]
    return Estimate.of(deltas)
