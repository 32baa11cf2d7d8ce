# SPDX-License-Identifier: Apache-2.0
"""Tows robots that are broken in others' way, or lost, as people would."""

from typing import NamedTuple

import numpy as np

from warehouse_fleet.robots.failures import EMPTY
from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.transports import Transports
from warehouse_layout.message_enums import RobotMode as Mode


class TowOrder(NamedTuple):
    """People are to move a robot, with what it carries, to a place in the frame world [m]."""

    kiva_id: int
    x: float
    y: float


def order(transports: Transports, kiva_id: int) -> TowOrder:
    """Returns the order to tow a robot to the nearest cell where it blocks no robot. Raises
    ValueError: the robot works, or there is no such cell."""
    robots = transports.robots
    robot = robots.index(kiva_id)
    if robot == NOWHERE:
        raise ValueError(f"there is no kiva{kiva_id}")
    if not (robots.broken[robot] or robots.lost[robot]):
        raise ValueError(f"kiva{kiva_id} is not broken")
    cell = transports.nearest(int(robots.cell[robot]), _free_refuges(transports, robot))
    if cell == NOWHERE:
        raise ValueError(f"there is no free cell to tow kiva{kiva_id} to")
    x, y = transports.plan.point_of(cell)
    return TowOrder(kiva_id, float(x), float(y))


def _free_refuges(transports: Transports, robot: int) -> list[int]:
    robots, traffic = transports.robots, transports.traffic
    out = set(traffic.closed.tolist()) | set(robots.cell.tolist()) | set(robots.goal.tolist())
    if robots.loaded[robot]:
        out |= set(np.flatnonzero(transports.taken()).tolist())
    # Nor may a robot be about to pass there.
    cells = _refuges(transports, robot).tolist()
    return [c for c in cells if c not in out and traffic.holder(c) == NOWHERE]


def _refuges(transports: Transports, robot: int) -> np.ndarray:
    """Cells where no robot passes: with a unit, storage places; with an empty battery, those where
    it is charged."""
    robots, charging = transports.robots, transports.plan.charging
    if robots.loaded[robot]:
        return transports.places
    if robots.failures[robot] >> EMPTY & 1 and len(charging):
        return np.asarray(charging)
    return np.flatnonzero(transports.aside)


def in_the_way(transports: Transports) -> np.ndarray:
    """Returns (n,) bool: robots that are broken in a street or a lane."""
    robots = transports.robots
    in_street = (robots.cell == NOWHERE) | ~transports.aside[robots.cell]
    return robots.broken & ~robots.gone & in_street


class Towing:
    """Orders robots to be towed that have been broken in others' way, or lost anywhere, for `after`
    [s]. A broken one is repaired in time; a lost one stands until people come, and may keep a
    storage unit from being fetched. A robot that can't be towed is tried again."""

    def __init__(self, transports: Transports, after: float) -> None:
        self._transports, self._after = transports, after
        self._since = np.full(len(transports.robots), np.inf)  # [s]

    def due(self) -> list[TowOrder]:
        """Returns the orders that are due. A robot that was lost is AUTOMATIC from then on."""
        robots, time = self._transports.robots, self._transports.traffic.time
        waits = in_the_way(self._transports) | (robots.lost & ~robots.gone)
        self._since = np.where(waits, np.minimum(self._since, time), np.inf)
        orders = []
        for robot in np.flatnonzero(time - self._since > self._after).tolist():
            self._since[robot] = time
            try:
                orders.append(order(self._transports, int(robots.kiva_ids[robot])))
            except ValueError:
                continue
            if robots.lost[robot]:
                robots.mode[robot] = Mode.AUTOMATIC
        return orders
