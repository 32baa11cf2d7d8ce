# SPDX-License-Identifier: Apache-2.0
"""Parks robots without work."""

from typing import TYPE_CHECKING

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE

if TYPE_CHECKING:
    from warehouse_fleet.transports.transports import Transports


def run(work: "Transports") -> None:
    """Sends robots without work to where they are to wait; those that stand in a street or a lane
    go beneath a stored unit."""
    robots, idle = work.robots, work.without_work()
    idle[list(work.charging.cell_of)] = False
    robots.goal[idle & (robots.goal == robots.cell)] = NOWHERE
    sent = idle & (robots.goal != NOWHERE)
    if sent.any():  # a robot with work at a cell comes first, and stays
        wanted = np.zeros(work.plan.passable.size, bool)
        wanted[robots.goal[~idle & (robots.goal != NOWHERE)]] = True
        robots.goal[sent & wanted[robots.goal]] = NOWHERE
    if work.freed:
        _send_freed(work, idle)
    _clear_streets(work, idle & (robots.goal == NOWHERE) & ~work.aside[robots.cell])


def _send_freed(work: "Transports", idle: np.ndarray) -> None:
    """Asks the policy about robots that have ended a transport since the last tick."""
    robots = work.robots
    freed, work.freed = work.freed, []
    for robot in freed:
        cell = work.park(robot) if idle[robot] else None
        if cell is None or cell in robots.goal:
            continue
        if cell != robots.cell[robot] and work.aside[cell]:
            robots.send(robot, cell)


def _clear_streets(work: "Transports", in_the_way: np.ndarray) -> None:
    if not in_the_way.any():
        return
    robots = work.robots
    free = work.units.stands & work.aside
    for cells in (robots.goal, robots.cell):
        free[cells[cells != NOWHERE]] = False
    places = np.flatnonzero(free)
    for robot in np.flatnonzero(in_the_way).tolist():
        if not len(places):
            return
        far = work.distance(int(robots.cell[robot]), places)
        place = work.units.first_in(places[far == far.min()])
        places = places[places != place]
        robots.send(robot, place)
