# SPDX-License-Identifier: Apache-2.0
"""Plans for a fleet, without ROS.

    import numpy as np
    from warehouse_fleet import Fleet, Floor, epibt

    floor = Floor(np.ones((20, 30)))              # 20 rows of 30 cells, all passable
    planner = epibt(floor, seed=1)
    fleet = Fleet(cell=[0, 31], heading=[0, 2], goal=[599, 0])
    actions = planner.plan(fleet, seconds=0.01)   # (robots, ticks) of Action

A cell is a number, y * width + x; a heading counts quarter turns from +x towards +y. A tick is the
time of one cell at top speed, or of a quarter turn.

Rooms, from the lowest; a module imports from its own room and from lower ones:

    robots      what robots report, how they move and fail
    planners    which cell each robot enters next
    traffic     from goals to released cells
    transports  requests and records of transports, and the phases of the dispatcher
    hosts       the coordinator's node, and a fleet in one process with its world
    league      problems and plans of the League of Robot Runners
"""

from enum import IntEnum

from warehouse_fleet._core import (
    Execution,
    Fleet,
    Planner,
    Rules,
    Violation,
    epibt,
    load_planner,
    validate,
)
from warehouse_layout import Floor, FloorError, check_layout

__all__ = [
    "Action",
    "Execution",
    "Fleet",
    "Floor",
    "FloorError",
    "Planner",
    "Rules",
    "Violation",
    "check_layout",
    "epibt",
    "load_planner",
    "validate",
]


class Action(IntEnum):
    """What a robot does in one tick."""

    WAIT = 0
    FORWARD = 1
    TURN_POSITIVE = 2  # from +x towards +y
    TURN_NEGATIVE = 3
