# SPDX-License-Identifier: Apache-2.0
"""Tows robots that are broken in others' way, or lost, as people would."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from warehouse_fleet.robots.failures import EMPTY
from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.traffic.traffic import Traffic
from warehouse_fleet.transports.distances import Distances
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.message_enums import RobotMode


class TowOrder(NamedTuple):
    """People are to move a robot, with what it carries, to a place in the frame world [m]."""

    kiva_id: int
    x: float
    y: float


class Towing:
    """Finds the places to which robots are towed. `aside`, (cells,) bool: the cells where no robot
    passes. `taken` returns (cells,) bool: those with a unit, or kept for one."""

    def __init__(
        self,
        plan: FloorPlan,
        aside: np.ndarray,
        traffic: Traffic,
        distances: Distances,
        taken: Callable[[], np.ndarray],
    ) -> None:
        self._plan, self._aside, self._distances, self._taken = plan, aside, distances, taken
        self._traffic, self._robots = traffic, traffic.robots

    def order(self, kiva_id: int) -> TowOrder:
        """Returns the order to tow a robot to the nearest cell where it blocks no robot. Raises
        ValueError: the robot works, or there is no such cell."""
        robots = self._robots
        robot = robots.index(kiva_id)
        if robot == NOWHERE:
            raise ValueError(f"there is no kiva{kiva_id}")
        if not (robots.broken[robot] or robots.lost[robot]):
            raise ValueError(f"kiva{kiva_id} is not broken")
        cell = self._distances.nearest(int(robots.cell[robot]), self._free_refuges(robot))
        if cell == NOWHERE:
            raise ValueError(f"there is no free cell to tow kiva{kiva_id} to")
        x, y = self._plan.point_of(cell)
        return TowOrder(kiva_id, float(x), float(y))

    def _free_refuges(self, robot: int) -> list[int]:
        robots, traffic = self._robots, self._traffic
        out = set(traffic.closed.tolist()) | set(robots.cell.tolist()) | set(robots.goal.tolist())
        if robots.loaded[robot]:
            out |= set(np.flatnonzero(self._taken()).tolist())
        # Nor may a robot be about to pass there.
        cells = self._refuges(robot).tolist()
        return [cell for cell in cells if cell not in out and traffic.holder(cell) == NOWHERE]

    def _refuges(self, robot: int) -> np.ndarray:
        """Cells where no robot passes: with a unit, storage places; with an empty battery, those
        where it is charged."""
        robots, charging = self._robots, self._plan.charging
        if robots.loaded[robot]:
            return np.flatnonzero(self._plan.storage)
        if robots.failures[robot] >> EMPTY & 1 and len(charging):
            return np.asarray(charging)
        return np.flatnonzero(self._aside)

    def in_the_way(self) -> np.ndarray:
        """Returns (n,) bool: robots that are broken in a street or a lane."""
        robots = self._robots
        in_street = (robots.cell == NOWHERE) | ~self._aside[robots.cell]
        return robots.broken & ~robots.gone & in_street


class TowingService:
    """Orders robots to be towed that have been broken in others' way, or lost anywhere, for `after`
    [s]. A broken one is repaired in time; a lost one stands until people come, and may keep a
    storage unit from being fetched. A robot that can't be towed is tried again."""

    def __init__(self, towing: Towing, robots: RobotTable, after: float) -> None:
        self._towing, self._robots, self._after = towing, robots, after
        self._since = np.full(len(robots), np.inf)  # [s]

    def due(self, time: float) -> list[TowOrder]:
        """Returns the orders that are due at a time [s]. A robot that was lost is AUTOMATIC from
        then on."""
        robots = self._robots
        waits = self._towing.in_the_way() | (robots.lost & ~robots.gone)
        self._since = np.where(waits, np.minimum(self._since, time), np.inf)
        orders = []
        for robot in np.flatnonzero(time - self._since > self._after).tolist():
            self._since[robot] = time
            try:
                orders.append(self._towing.order(int(robots.kiva_ids[robot])))
            except ValueError:
                continue
            if robots.lost[robot]:
                robots.mode[robot] = RobotMode.AUTOMATIC
        return orders
