# SPDX-License-Identifier: Apache-2.0
"""Drives a plan of the League of Robot Runners with bodies, in a world of this process.

The order in which robots pass each cell is the plan's; times are those of bodies that accelerate,
brake and turn.
"""

from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from warehouse_fleet._core import Execution
from warehouse_fleet.hosts.fleet_driver import UPDATE
from warehouse_fleet.league.drive_order import DriveOrder
from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.message_enums import EventKind, State

STUCK = 60.0  # a drive ends if no robot moves for this duration [s]
STANDSTILL = 0.01  # [m/s]


class Cause(IntEnum):
    """What a robot's time goes into."""

    DRIVING = 0  # as long as its way takes at top speed
    ACCELERATION = 1  # what starting and braking take more
    TURN = 2  # it turns
    AHEAD = 3  # it stands behind a robot that has not left the cell before it
    ORDER = 4  # it stands before a free cell that another one passes first
    RING = 5  # it stands where a ring of the plan is broken
    RELEASE = 6  # it stands until its next cells are released, or until it starts
    ARRIVED = 7  # it has driven all of its plan


class PlanDriver:
    """Drives the robots of a world, which stand at the starts of a plan, in its order.

    `seconds` (Cause, robots): what each robot's time went into [s]. `arrival` (robots,): when each
    had driven its plan [s]; NaN: not yet. `events`: those of the world, if that is a list.
    """

    def __init__(
        self, world: Any, floor: FloorPlan, order: DriveOrder, kinematics: Kinematics | None = None
    ) -> None:
        self.world, self.plan, self.order = world, floor, order
        self.kinematics = kinematics or Kinematics()
        self._execution = Execution(
            floor.floor(),
            origin=floor.origin,
            spacing=floor.spacing,
            speed=self.kinematics.speed,
            acceleration=self.kinematics.acceleration,
            quarter=self.kinematics.quarter_turn,
        )
        robots = len(order.steps)
        self._never, self._always = np.zeros(robots, bool), np.ones(robots, bool)
        self._steps = max(1, round(UPDATE / world.step_size))
        self.seconds = np.zeros((len(Cause), robots))
        self.arrival = np.full(robots, np.nan)
        self.collisions = self.refusals = 0
        self.events: list[NDArray[Any]] | None = None
        self._moved = 0.0  # when a robot moved last [s]
        self._update()
        self._execution.drive(order.steps, upright(order.cell, floor), order.rank)

    @property
    def time(self) -> float:
        """Simulated [s]."""
        return float(self.world.time)

    @property
    def is_over(self) -> bool:
        """Whether all robots have driven their plans."""
        return not np.isnan(self.arrival).any()

    @property
    def is_stuck(self) -> bool:
        """Whether no robot has moved for STUCK."""
        return self.time - self._moved > STUCK

    @property
    def tick(self) -> NDArray[np.intp]:
        """The next tick of the plan of each robot, (robots,)."""
        rank = self._execution.next_tick()
        end = len(self.order.rank_of_tick)
        return np.where(rank < 0, end, self.order.tick(rank))

    @property
    def cells(self) -> int:
        """How many cells of the plan were released to robots so far."""
        rank = self._execution.next_tick()
        limit = np.where(rank < 0, np.iinfo(rank.dtype).max, rank)
        return int(np.count_nonzero(self.order.rank < np.repeat(limit, self.order.steps)))

    def at_end(self) -> NDArray[np.bool_]:
        """Returns which robots stand where the plan ends, (robots,)."""
        fleet = self.world.fleet
        cells = self.plan.cell_of(fleet.x, fleet.y)
        return np.equal(cells, upright(self.order.end, self.plan))

    def waiting(self, seconds: float) -> NDArray[np.intp]:
        """Returns the indices of the robots that have stood that long although they have to go."""
        return np.flatnonzero(self.time - self._execution.still_since() >= seconds)

    def step(self) -> None:
        """Advances by 0.1 s."""
        self._take_events()
        self._update()
        releases = self._execution.release()
        robot, path_id, first, points, cells, released = releases
        if len(robot):
            x, y = self.plan.point_of(cells)
            ids = self.world.fleet.kiva_id[robot]
            self.world.follow(ids, path_id, first, points, x, y, released)
        self._account()
        self.world.step(self._steps)

    def _update(self) -> None:
        fleet = self.world.fleet
        self._execution.update(
            self.world.time,
            fleet.x,
            fleet.y,
            fleet.yaw,
            fleet.vx,
            fleet.vy,
            fleet.status,
            fleet.state,
            fleet.path_id,
            fleet.reached,
            fleet.left,
            self._always,
            self._never,
            self._never,
        )

    def _account(self) -> None:
        """Adds the time until the next step to the causes."""
        fleet, top = self.world.fleet, self.kinematics.speed
        has_arrived = (self._execution.next_tick() < 0) & self._execution.stands()
        self.arrival[has_arrived & np.isnan(self.arrival)] = self.time
        speed = np.hypot(fleet.vx, fleet.vy)
        cause = np.where(fleet.state == State.ROTATING, Cause.TURN, self._waiting_for())
        cause[has_arrived] = Cause.ARRIVED
        drives = speed > STANDSTILL
        cause[drives] = Cause.ACCELERATION
        share = np.where(drives, np.minimum(speed / top, 1.0), 0.0)
        robots = np.arange(len(cause))
        self.seconds[cause, robots] += UPDATE * (1 - share)
        self.seconds[Cause.DRIVING] += UPDATE * share
        if drives.any() or (cause == Cause.TURN).any():
            self._moved = self.time

    def _waiting_for(self) -> NDArray[np.intp]:
        """Returns the Cause for which each robot would stand now, (robots,)."""
        rank = self._execution.next_tick()
        cause = np.array([Cause.RELEASE, Cause.AHEAD, Cause.ORDER, Cause.TURN])[
            self._execution.hindrance()
        ]
        waits = (cause != Cause.RELEASE) & (rank >= 0)
        cause[waits & self.order.breaks_ring(rank)] = Cause.RING
        return cause

    def _take_events(self) -> None:
        events = self.world.events()
        if self.events is not None:
            self.events.append(events)
        self.collisions += int(np.count_nonzero(events["kind"] == EventKind.COLLISION))
        for event in events[events["kind"] == EventKind.REFUSED]:
            self.refusals += 1
            kiva_id = int(event["model"].removeprefix("kiva"))
            self._execution.refused(self.world.fleet.index(kiva_id))


def upright(cells: NDArray[np.int32], floor: FloorPlan) -> NDArray[np.int32]:
    """Returns locations of the League, whose rows count downwards, as cells of a floor plan."""
    rows, columns = np.divmod(cells, floor.width)
    return ((floor.shape[0] - 1 - rows) * floor.width + columns).astype(np.int32)
