# SPDX-License-Identifier: Apache-2.0
"""Units that some robots can't carry, as those robots have said: too heavy, or too large."""

from warehouse_fleet.robots.robot_table import RobotTable
from warehouse_fleet.transports.contracts import Clock

ASKS_AGAIN = 600.0  # time after which a robot is asked again: the unit may be lighter then [s]


class UnfitUnits:
    """The pairs of robot and unit that were refused, each for ASKS_AGAIN seconds."""

    def __init__(self, clock: Clock, robots: RobotTable) -> None:
        self._clock, self._robots = clock, robots
        self._refused: dict[int, dict[int, tuple[float, str]]] = {}  # by unit, by robot's index

    def note(self, robot: int, unit: int, why: str) -> None:
        """Notes that a robot can't carry a unit, for the reason `why`."""
        self._refused.setdefault(unit, {})[robot] = self._clock.time + ASKS_AGAIN, why

    def robots_of(self, unit: int) -> frozenset[int]:
        """Returns the robots that can't carry a unit, by index."""
        rows = self._refused.get(unit)
        if not rows:
            return frozenset()
        for robot in [r for r, (until, _) in rows.items() if until <= self._clock.time]:
            del rows[robot]
        return frozenset(rows)

    def why_all(self, unit: int) -> str:
        """Returns why no robot of the warehouse can carry a unit, one reason a robot at the most
        three; empty if one may."""
        refused = self.robots_of(unit)
        there = (~self._robots.gone).nonzero()[0].tolist()
        if not refused or not set(there) <= refused:
            return ""
        ids = self._robots.kiva_ids
        reasons = [f"kiva{ids[r]}: {self._refused[unit][r][1]}" for r in sorted(refused)][:3]
        return "; ".join(reasons)
