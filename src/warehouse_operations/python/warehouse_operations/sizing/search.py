# SPDX-License-Identifier: Apache-2.0
"""Looks for the fewest robots for each number of stations, judging as few points as that takes.

Robots are bisected, after a first guess: those that were at work when there were many. A station
more is tried for as long as it saves robots; it has to do with one robot less than without it.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol


class Judged(Protocol):
    """The result of a point, as far as a search needs it."""

    @property
    def met(self) -> bool:
        """Whether the point meets the wish."""

    def at_work(self) -> float:
        """Returns how many of its robots were at work, on the average."""


Judge = Callable[[int, int], Judged]  # of (robots, stations)


@dataclass
class Search:
    """The search for the fewest robots.

    judge: of (robots, stations). most_robots: of a number of stations, how many are tried at most.
    frontier: the fewest robots that meet the wish, by stations; None: no number of robots does. The
    first number of stations that saves no robot is not in it.
    """

    judge: Judge
    most_robots: Callable[[int], int]
    frontier: dict[int, int | None] = field(default_factory=dict)

    def run(self, least: int, most: int) -> dict[int, int | None]:
        """Fills the frontier for `least` stations and more, up to `most` at the most."""
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
