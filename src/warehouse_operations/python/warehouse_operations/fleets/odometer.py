# SPDX-License-Identifier: Apache-2.0
"""How far ideal robots have driven, who report no positions on their ways."""

from collections import defaultdict
from dataclasses import dataclass

MOMENT = 1e-9  # shortest time of a drive [s]


@dataclass
class Stretch:
    """A drive of some metres, at an even pace between two times [s]."""

    begin: float
    end: float
    metres: float

    def driven(self, time: float) -> float:
        """Returns the metres driven until a time [s]."""
        if time >= self.end:
            return self.metres
        return self.metres * max(time - self.begin, 0.0) / max(self.end - self.begin, MOMENT)


class Odometer:
    """Metres of all robots, which count as they are driven. Robots are named by their indices."""

    def __init__(self) -> None:
        self._metres = 0.0  # of ways that are over
        self._ways: dict[int, list[Stretch]] = defaultdict(list)  # one after the other, by robot

    def begin(self, robot: int, time: float, way: Stretch) -> None:
        """Adds a way that follows the former ones of a robot, at a time [s] or later."""
        ways = self._ways[robot]
        while ways and ways[0].end <= time:
            self._metres += ways.pop(0).metres
        ways.append(way)

    def stop(self, robot: int, time: float) -> None:
        """Ends the last way of a robot, which turns off it."""
        if ways := self._ways[robot]:
            self._metres += ways.pop().driven(time)

    def halt(self, robot: int, time: float, seconds: float) -> None:
        """Has a robot stand on its way for a while [s]."""
        for way in self._ways[robot]:
            if way.end <= time:
                continue
            driven = way.driven(time)
            self._metres += driven
            way.metres -= driven
            way.begin, way.end = max(way.begin, time) + seconds, way.end + seconds

    def read(self, time: float) -> float:
        """Returns the metres driven until a time [s], not before that of another call."""
        under_way = (way.driven(time) for ways in self._ways.values() for way in ways)
        return self._metres + sum(under_way)
