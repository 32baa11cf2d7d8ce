# SPDX-License-Identifier: Apache-2.0
"""Searches the fewest robots for each number of stations, with as few points as possible.

The number of robots is bisected from a first guess: the number at work of a large fleet. Stations
are added while each saves at least one robot.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol


class Judged(Protocol):
    """The parts of a point's result that a search needs."""

    @property
    def met(self) -> bool:
        """Whether the point meets the wish."""

    def at_work(self) -> float:
        """Returns the mean number of its robots at work."""


Judge = Callable[[int, int], Judged]  # of (robots, stations)


@dataclass
class Search:
    """The search for the fewest robots.

    judge: of (robots, stations). most_robots: largest number of robots to try, by stations.
    frontier: the fewest robots that meet the wish, by stations; None: no number suffices. It ends
    before the first number of stations that saves no robot.
    """

    judge: Judge
    most_robots: Callable[[int], int]
    frontier: dict[int, int | None] = field(default_factory=dict)

    def run(self, least: int, most: int) -> dict[int, int | None]:
        """Fills the frontier from `least` stations to `most` or fewer."""
        best: int | None = None
        for stations in range(least, most + 1):
            highest = self.most_robots(stations) if best is None else best - 1
            fewest = self.fewest(stations, highest)
            if best is not None and fewest is None:
                break
            self.frontier[stations] = best = fewest
        return self.frontier

    def fewest(self, stations: int, highest: int) -> int | None:
        """Returns the fewest robots, `highest` at most, that suffice at some stations, or None."""
        if highest < 1:
            return None
        many = self.judge(highest, stations)
        if not many.met:
            return None
        low, high = 0, highest  # too few, enough
        guess = round(many.at_work())
        while high - low > 1:
            middle = guess if low < guess < high else (low + high) // 2
            if self.judge(middle, stations).met:
                high = middle
            else:
                low = middle
            guess = (low + high) // 2
        return high
