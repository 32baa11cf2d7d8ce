# SPDX-License-Identifier: Apache-2.0
"""The verdict on a point by its shifts: whether it meets the wish, with a confidence.

Lateness is the share of late orders among those that came after the warm-up; the shift goes on
until all of them are complete or due. A point meets a wish if the upper confidence limit of the
mean share, by Student's t over seeds, is at most the limit, and if the open orders don't
accumulate: otherwise few late orders today may become many tomorrow.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import special

from warehouse_operations.reports.comparison import CONFIDENCE, LEAST, Estimate
from warehouse_operations.reports.limits import Window, windows_of
from warehouse_operations.reports.warm_up import mser5
from warehouse_operations.sizing.point import SERIES, Record

FIRST = LEAST  # shifts after which a point that is far off is dropped
MORE = (1, 2, 4)  # multiples of a wish's seeds at which a point is judged
RISK = (1 - CONFIDENCE) / len(MORE)  # risk of one judgement: the total is shared out (Bonferroni)

Figures = dict[str, float]


def looks(seeds: int) -> list[int]:
    """Returns the numbers of shifts after which a point may be accepted."""
    return [seeds * times for times in MORE]


@dataclass(frozen=True)
class Verdict:
    """The result of a point's shifts. late: the share of orders that may be late; run_in [min]."""

    robots: int
    stations: int
    records: tuple[Record, ...]
    late: float
    seeds: int
    run_in: int = 0
    is_day: bool = False  # a day with a peak: judged from its begin, by lateness alone

    @property
    def decided(self) -> bool:
        """Whether the shifts suffice: the verdict is clear, or stays open with more of them."""
        most = looks(self.seeds)[-1]
        return self.met or self.fails or len(self.records) >= most or self._hopeless(most)

    def _hopeless(self, most: int) -> bool:
        """Whether `most` shifts like these would not show that the wish is met."""
        return len(self.records) >= self.seeds and self.limit(RISK, 1, most) > self.late

    @cached_property
    def met(self) -> bool:
        """Whether the wish is met with CONFIDENCE."""
        if len(self.records) < self.seeds:
            return False
        return self.limit(RISK, 1) <= self.late and not self.piles_up

    @cached_property
    def fails(self) -> bool:
        """Whether the wish is missed with CONFIDENCE."""
        if len(self.records) < FIRST:
            return False
        return self.limit(1 - CONFIDENCE, -1) > self.late or self.piles_up

    @cached_property
    def piles_up(self) -> bool:
        """Whether open orders grow by more than the share that may be late, with the confidence of
        one judgement."""
        return not self.is_day and self._limit("growth", RISK, -1) > self.late

    def at_work(self) -> float:
        """Returns the mean number of robots at work."""
        return self.robots * self.estimate("robots_at_work").mean

    @property
    def word(self) -> str:
        """One of met, missed, undecided and drawn; drawn: for the figure alone, with too few
        shifts."""
        if self.met or self.fails:
            return "met" if self.met else "missed"
        return "undecided" if len(self.records) >= self.seeds else "drawn"

    def limit(self, risk: float, side: int, shifts: int = 0) -> float:
        """Returns the upper (side 1) or lower (-1) limit of the mean share of late orders.

        shifts: their assumed number, with the same mean and deviation; 0: the number simulated.
        """
        return self._limit("late", risk, side, shifts)

    def _limit(self, name: str, risk: float, side: int, shifts: int = 0) -> float:
        values = np.array([figures[name] for figures in self.figures])
        if len(values) < 2:
            return math.inf * side
        count = shifts or len(values)
        error = values.std(ddof=1) / math.sqrt(count)
        return float(values.mean() + side * special.stdtrit(count - 1, 1 - risk) * error)

    @property
    def at_most(self) -> float:
        """The upper limit of the share of late orders, with CONFIDENCE."""
        return max(self.limit(RISK, 1), 0.0)

    @cached_property
    def warm_up(self) -> int:
        """The minutes left out at the beginning: the run-in, and the warm-up of the open orders."""
        if self.is_day:
            return self.run_in
        return max(self.run_in, mser5([record.series["open"] for record in self.records]))

    @cached_property
    def figures(self) -> list[Figures]:
        """The figures of each shift after the warm-up."""
        return [figures_of(record, self.warm_up) for record in self.records]

    @cached_property
    def windows(self) -> list[Window]:
        """The Windows of all its shifts after the warm-up, summed."""
        each = [record.series for record in self.records]
        series = {
            name: np.sum([series_of_shift[name] for series_of_shift in each], axis=0)[
                self.warm_up :
            ].tolist()
            for name in SERIES
        }
        return windows_of(series, series["missed"])

    def estimate(self, name: str) -> Estimate:
        """Returns the Estimate of one of the figures."""
        return Estimate.of([figures[name] for figures in self.figures])


def figures_of(record: Record, warm_up: int) -> Figures:
    """Returns the figures of a shift without its first minutes."""
    series = {name: np.array(values[warm_up:], float) for name, values in record.series.items()}
    total = {name: float(values.sum()) for name, values in series.items()}
    seconds = 60.0 * len(series["open"])
    hours, robot_s = seconds / 3600, seconds * record.robots
    pieces = total["pieces"] / hours
    return {
        "late": total["missed"] / max(total["missed"] + total["in_time"], 1.0),
        "growth": 1 - total["completed"] / max(total["arrived"], 1.0),
        "orders_per_hour": total["completed"] / hours,
        "pieces_per_hour": pieces,
        "open_orders": float(series["open"].mean()),
        "pile_on": total["pieces"] / max(total["visits"], 1.0),
        "picking": total["picking_s"] / (seconds * record.stations),
        "replenishing": total["replenishing_s"] / max(total["open_replenishing_s"], 1.0),
        "of_bound": total["pieces"] / max(total["bound"], 1.0),
        "robots_at_work": 1 - (total["idle_s"] + total["queue_s"]) / robot_s,
        "robots_idle": total["idle_s"] / robot_s,
        "robots_queue": total["queue_s"] / robot_s,
        "metres_per_piece": total["metres"] / max(total["pieces"], 1.0),
    }


def difference(first: Verdict, second: Verdict, name: str) -> Estimate:
    """Returns the difference of a figure of `second` from that of `first`, seed by seed."""
    firsts = {record.seed: figures[name] for record, figures in zip(first.records, first.figures)}
    deltas: Sequence[float] = [
        figures[name] - firsts[record.seed]
        for record, figures in zip(second.records, second.figures)
        if record.seed in firsts
    ]
    return Estimate.of(deltas)
