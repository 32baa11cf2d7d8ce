# SPDX-License-Identifier: Apache-2.0
"""Robots that stand broken or out of service for long, and what they shut to new work."""

from collections.abc import Callable

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, OUT_OF_SERVICE, RobotTable
from warehouse_fleet.traffic.closed_zones import ClosedZones
from warehouse_fleet.traffic.reach import Reach
from warehouse_fleet.traffic.station_ways import StationWays
from warehouse_layout.floor.floor_edges import FloorEdges
from warehouse_layout.floor.floor_plan import FloorPlan

LONG = 60.0  # a robot that has not worked for longer shuts what it cuts off [s]
NAMED = 3  # robots that are named; the others are counted


class StandingRobots:
    """Looks which cells robots that stand for LONG cut off, together with the closed `zones`.
    `held` returns {cell: robot}, of the cells that no robot enters, by those who stand there."""

    def __init__(
        self,
        plan: FloorPlan,
        edges: FloorEdges,
        zones: ClosedZones,
        robots: RobotTable,
        held: Callable[[], dict[int, int]],
    ) -> None:
        self._plan, self._edges, self._ways = plan, edges, StationWays(plan)
        self._zones, self._robots, self._held = zones, robots, held
        self._since = np.full(len(robots), np.inf)
        self._by: dict[int, int] = {}  # the robot by the cell that it shuts
        self._closed: frozenset[int] = frozenset()
        self._reach = Reach(plan, edges, self._ways, self._closed)
        self._bars: dict[str, frozenset[int]] = {}  # the cells that bar each station cut off
        self._known: dict[frozenset[int], list[int]] = {}

    def __bool__(self) -> bool:
        """Returns whether a robot shuts cells."""
        return bool(self._by)

    @property
    def is_cut(self) -> np.ndarray:
        """(cells,) bool: held by such robots or in closed zones, or cut off by them."""
        return self._reach.is_cut if self._by else self._zones.is_cut

    def update(self, time: float) -> None:
        """Updates at a time [s]. The floor is looked at only where other cells are shut."""
        robots = self._robots
        stands = (robots.broken | (robots.mode == OUT_OF_SERVICE)) & ~robots.gone
        if not (self._by or stands.any()):
            self._since[:] = np.inf
            return
        self._since = np.where(stands, np.minimum(self._since, time), np.inf)
        shuts = time - self._since > LONG
        by = self._held().items() if shuts.any() else ()
        self._by = {cell: robot for cell, robot in by if shuts[robot]}
        closed = frozenset([*self._by, *self._zones.cells]) if self._by else frozenset[int]()
        if closed != self._closed:
            self._look(closed)

    def _look(self, closed: frozenset[int]) -> None:
        """Looks at what is cut off while cells are closed."""
        self._closed, self._known = closed, {}
        self._reach = Reach(self._plan, self._edges, self._ways, closed)
        cut = frozenset(np.flatnonzero(self._reach.is_cut).tolist())
        self._bars = {name: frozenset(self._ways.bars(name, cut)) for name in self._reach.stations}

    def why_unit(self, unit: int, cell: int) -> str:
        """Returns why a unit that stands in a cell can't be fetched; empty if it can."""
        return self._why_in(cell, f"unit {unit}")

    def why_cell(self, cell: int) -> str:
        """Returns why nothing can be brought to a cell; empty if it can."""
        x, y = self._plan.point_of(cell)
        return self._why_in(cell, f"({x:g}, {y:g})")

    def why_station(self, station: str) -> str:
        """Returns why no unit can be brought to a station; empty if it can."""
        if not self._by or station not in self._bars:
            return ""
        return self._sentence(station, self._bars[station])

    def _why_in(self, cell: int, what: str) -> str:
        if not self._by or cell == NOWHERE or not self._reach.is_cut[cell]:
            return ""
        return self._sentence(what, frozenset([cell]))

    def _sentence(self, what: str, cells: frozenset[int]) -> str:
        robots = self._robots_around(cells)
        named = ", ".join(f"kiva{self._robots.kiva_ids[robot]}" for robot in robots[:NAMED])
        more = f" and {len(robots) - NAMED} more" if len(robots) > NAMED else ""
        return f"{what} is cut off by {named}{more}, broken or out of service"

    def _robots_around(self, cells: frozenset[int]) -> list[int]:
        """Returns the robots at the edge of the part that is cut off around some cells; all, if
        none is there."""
        if cells not in self._known:
            part = set(cells)
            front = list(cells)
            while front:
                beside = self._plan.beside(front)
                front = [c for c in beside[self._reach.is_cut[beside]].tolist() if c not in part]
                part.update(front)
            robots = {robot for cell, robot in self._by.items() if cell in part}
            self._known[cells] = sorted(robots or set(self._by.values()))
        return self._known[cells]
