# SPDX-License-Identifier: Apache-2.0
"""Drives the base of an order: gives a driver the released points, leg by leg.

A leg is one path of the driver: it ends where the robot has to stand for an action, and is
lengthened while it is under way. What was sent is sent again until the robot's report shows it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from warehouse_vda5050.driver import Driver, Point, Report
from warehouse_vda5050.grid import Cell, Grid, GridError
from warehouse_vda5050.vehicle.actions import holds_at
from warehouse_vda5050.vehicle.progress import OrderProgress

PATIENCE = 3.0  # until a command that is not heard is sent again [s]
RETRY = 5.0  # time from a refusal to the next attempt [s]


@dataclass
class Leg:
    """A path given to the driver; `counted` of its points were taken as passed. `speeds`: the
    highest on the way to each of its points [m/s]; empty as long as no limit was given."""

    path_id: int
    points: list[Point]
    sent: float
    counted: int = 1
    heard: bool = False
    is_cut: bool = False  # to end at the next grid point
    speeds: list[float] = field(default_factory=list)


class Wheels:
    """The way of one vehicle along its order. `first_path` is the number of its first path."""

    def __init__(self, driver: Driver, grid: Grid, first_path: int) -> None:
        self._driver, self.grid = driver, grid
        self._next_path = first_path
        self._leg: Leg | None = None
        self._refused: dict[int, Leg] = {}  # of this order; the refusal may be of something else
        self._retry_at = 0.0
        self._cancelled_at: float | None = None
        self.fault = ""  # why the robot does not drive on, '' if it does or need not

    @property
    def rest(self) -> bool:
        """Whether no path is under way."""
        return self._leg is None

    def begin(self) -> None:
        """Prepares for a new order."""
        self.fault, self._retry_at, self._cancelled_at = "", 0.0, None
        self.forget_refused()

    def forget_refused(self) -> None:
        """Counts no longer what the robot may take all the same of the paths that it refused."""
        self._refused.clear()

    def count(self, report: Report, now: float) -> int:
        """Returns the count of nodes reached since the last call; ends a leg that is over."""
        self._recognise(report)
        leg = self._leg
        if leg is None:
            return 0
        if report.path_id == leg.path_id:
            return self._count_heard(leg, report)
        refused = report.refusal and now - leg.sent > 0.5
        if refused or (self._cancelled_at and now - leg.sent > PATIENCE):
            self._refused[leg.path_id] = leg
            self._leg = None
            self.fault = report.refusal
            self._retry_at = now + RETRY
        return 0

    def _recognise(self, report: Report) -> None:
        """Takes up a leg again that seemed to be refused, and that the robot drives after all: what
        was refused was another command, and the report of this one came late."""
        leg = self._refused.pop(report.path_id, None)
        if leg is None:
            return
        if self._leg:
            self._refused[self._leg.path_id] = self._leg
        self._leg = leg

    def _count_heard(self, leg: Leg, report: Report) -> int:
        leg.heard = True
        self.fault = ""
        # The last point counts once the robot stands: masters send the next order right then.
        reached = min(report.reached, len(leg.points) - report.busy)
        passed = max(0, reached - leg.counted)
        leg.counted += passed
        if not report.busy:
            self._leg = None
        return passed

    def drive(
        self,
        order: OrderProgress,
        report: Report,
        now: float,
        limit: int | None = None,
        speeds: Sequence[float] = (),
    ) -> None:
        """Begins a leg, lengthens it, or sends it again if it was not heard. limit: index of the
        last node that may be driven to, None: any; a leg that leads beyond is cut. speeds: the
        highest on each edge of the base [m/s], empty for no limits."""
        goal = self._goal(order)
        leg = self._leg
        if limit is not None:
            goal = min(goal, limit)
            if leg and len(leg.points) - leg.counted > goal:
                leg.is_cut = True
        if leg and leg.is_cut:
            self.cancel(now)
            return
        if leg is None:
            if goal and not report.busy and now >= self._retry_at:
                self._begin_leg(order, report, goal, now, speeds)
        elif not leg.heard and now - leg.sent > PATIENCE:
            leg.sent = now
            self._send(leg, 0)
        else:
            self._lengthen(leg, order, goal, speeds)

    def _goal(self, order: OrderProgress) -> int:
        """Returns the index of the node that the robot may drive to."""
        for k in range(1, order.base_end + 1):
            if holds_at(order.nodes[k]):
                return k
        return order.base_end

    def _begin_leg(
        self,
        order: OrderProgress,
        report: Report,
        goal: int,
        now: float,
        speeds: Sequence[float],
    ) -> None:
        here = self.grid.cell_at(report.x, report.y)
        try:
            way = self.grid.between(order.cells[0], order.cells[1])
        except GridError as error:  # checked when the order was accepted
            raise AssertionError(str(error)) from error
        if here not in way[:-1]:
            self.fault = (
                f"the robot stands at {self.grid.node_id(here)}, not on its way from"
                f" {order.nodes[0].id} to {order.nodes[1].id}"
            )
            return
        points = self._points([here, *order.cells[1 : goal + 1]])
        self._leg, self._cancelled_at = Leg(self._next_path, points, now), None
        self._next_path = self._next_path % 0xFFFFFFFF + 1
        self._leg.speeds = _speeds_of(self._leg, speeds)
        self._send(self._leg, 0)

    def _lengthen(self, leg: Leg, order: OrderProgress, goal: int, speeds: Sequence[float]) -> None:
        # Point `counted - 1` of the leg is the order's node 0, the last passed one.
        beyond = len(leg.points) - leg.counted
        first = len(leg.points)
        if goal > beyond:
            leg.points += self._points(order.cells[beyond + 1 : goal + 1])
        before, leg.speeds = leg.speeds, _speeds_of(leg, speeds)
        if before[leg.counted : first] != leg.speeds[leg.counted : first]:
            self._send(leg, leg.counted - 1)  # other limits for what was sent
        elif goal > beyond:
            self._send(leg, first)

    def _send(self, leg: Leg, first: int) -> None:
        """Sends the points of a leg from number `first` on."""
        points, count = leg.points[first:], len(leg.points)
        speeds = [leg.speeds[first:]] if leg.speeds else []  # drivers without limits get none
        self._driver.follow(leg.path_id, first, points, count, *speeds)

    def _points(self, cells: list[Cell]) -> list[Point]:
        return [self.grid.position(cell) for cell in cells]

    def cancel(self, now: float) -> None:
        """Ends the leg under way at the next grid point; asks again until it is over."""
        if self._leg and (self._cancelled_at is None or now - self._cancelled_at > PATIENCE):
            self._cancelled_at = now
            self._driver.cancel()


def _speeds_of(leg: Leg, speeds: Sequence[float]) -> list[float]:
    """Returns the highest speed on the way to each point of a leg; empty if it never had limits."""
    ahead = [*speeds[: len(leg.points) - leg.counted]]
    if not leg.speeds and all(map(math.isinf, ahead)):
        return []
    passed = leg.speeds[: leg.counted] or [math.inf] * leg.counted
    lacking = len(leg.points) - len(passed) - len(ahead)
    return [*passed, *ahead, *[math.inf] * lacking]
