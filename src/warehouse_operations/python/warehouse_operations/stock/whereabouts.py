# SPDX-License-Identifier: Apache-2.0
"""The places of units and the ways from there: the floor as a shift's policies see it."""

from collections.abc import Mapping

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_operations.stock.travel import CHANGE, Travel
from warehouse_operations.stock.units_by_id import UnitCells

WIDE = 10_000  # storage units above which distant ones are not brought to a station
REACH = 60.0  # time from a station [s] within which are as many units as in a smaller warehouse


class Whereabouts:
    """The cells of units and robots on a FloorPlan, by id; `units` and `robots`: at the begin.

    cells: where each stored unit stands now; those that are carried are not in it.
    """

    def __init__(
        self,
        plan: FloorPlan,
        robots: Mapping[int, int],
        units: Mapping[int, int],
        travel: Travel | None = None,
    ) -> None:
        self.plan, self.robots, self.units = plan, dict(robots), dict(units)
        self.cells = UnitCells(units)
        self._travel = travel or Travel(plan, Kinematics())
        self._service = {
            station.name: int(station.cells[station.service]) for station in plan.stations
        }
        self._picking = [station.name for station in plan.stations if station.kind == "PICK"]
        self._place_rank: np.ndarray | None = None

    @property
    def reach(self) -> float:
        """The longest detour of a unit to a station, against the nearest unit [s]: on a wide floor
        a better unit always exists, far away, and on two tiers on the other one."""
        if len(self.units) > WIDE:
            return REACH
        return CHANGE / 2 if self.plan.elevators else np.inf

    def seconds_to(self, station: str, unit: int) -> float:
        """Returns the time [s] from a unit's place to a station's service cell; inf while it is
        carried."""
        cell = self.cells.get(unit)
        if cell is None:
            return float("inf")
        return float(self._travel.seconds_from_all(np.array([cell]), self._service[station])[0])

    def seconds_to_all(self, station: str, units: np.ndarray) -> np.ndarray:
        """Returns seconds_to() of units, (n,) [s]; from other tiers CHANGE more."""
        cells, service = self.cells.of(units), self._service[station]
        seconds = self._travel.seconds_from_all(cells, service)
        seconds = seconds + self._travel.changes(cells, np.array(service))
        return np.where(cells == NOWHERE, np.inf, seconds)

    def apart(self, cell: int, cells: np.ndarray) -> np.ndarray:
        """Returns the metres along the axes between a cell and others, (n,); much more to those of
        another tier."""
        return self._travel.apart(cell, np.asarray(cells))

    def place_rank(self, cells: np.ndarray) -> np.ndarray:
        """Returns ranks of storage places, (n,): 0 nearest to a picking station, 1 farthest."""
        if self._place_rank is None:
            self._place_rank = self._rank()
        return self._place_rank[np.asarray(cells)]

    def _rank(self) -> np.ndarray:
        places = np.flatnonzero(self.plan.storage)
        seconds = np.full(len(places), np.inf)
        for name in self._picking:
            ways = self._travel.seconds_from_all(places, self._service[name])
            seconds = np.minimum(seconds, ways)
        rank = np.ones(self.plan.passable.size)
        rank[places[np.argsort(seconds, kind="stable")]] = np.linspace(0, 1, len(places))
        return rank
