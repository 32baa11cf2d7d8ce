# SPDX-License-Identifier: Apache-2.0
"""A path as orders: point i is node 2i, the way from it to the next one is edge 2i + 1."""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from warehouse_vda5050.driver import Point
from warehouse_vda5050.master.commands import Follow, Lift, RefusedError
from warehouse_vda5050.master.whereabouts import NEAR, SQUARE
from warehouse_vda5050.model import Action, Edge, Node, Position, VehicleOrder

# A vehicle takes a node as reached that is within its deviation: without these it does not move.
EXACTLY = (("allowedDeviationXY", NEAR), ("allowedDeviationTheta", SQUARE))
EdgeDemands = Callable[[Point, Point], tuple[tuple[str, float], ...]]
PlaceNode = Callable[[Point], tuple[str, Position]]  # node id, and where the vehicle has it


@dataclass
class Journey:
    """A path under way, and what of it the vehicle has.

    A base is never taken back: what is released stays so. An order is resent as it was until the
    vehicle has it; changes wait meanwhile, and go together into the next update.
    """

    path_id: int
    order_id: str
    points: list[Point]
    released: int
    had: int = 0  # how many points the vehicle has as released
    had_update: int = -1  # the last orderUpdateId that it has
    end: int = 0  # sequenceId of the last node that it has
    update: int = -1  # the last orderUpdateId sent
    is_changed: bool = True  # since then
    is_refused: bool = False  # the last order: the vehicle does not have the path as it is here
    sent: VehicleOrder | None = field(default=None, repr=False)
    actions: tuple[Action, ...] = ()  # at the last point
    lift: Lift | None = None  # that it is made for
    heading: float | None = None  # of a path that is to put the vehicle straight [rad]
    edge_demands: EdgeDemands = field(default=lambda _start, _end: (), repr=False)
    speeds: list[float] = field(default_factory=list)  # limit on the way to each point [m/s]
    disputes: int = 0  # changes in a row that were refused
    max_nodes: int = 1000  # of one message; what is beyond comes in the next

    def change(self, command: Follow) -> None:
        """Applies a command's releases and plan. Raises RefusedError, with nothing changed."""
        if command.released < self.released:
            raise RefusedError(
                f"{self.released} points are released; over VDA 5050 none can be taken back"
            )
        points, speeds = self.points, self.speeds
        if command.points:
            points = [*points[: command.first], *command.points]
            speeds = speeds_after(self, command)
            base = self.released  # which may be sent once more, as of a path that is cut off
            is_other = points[:base] != self.points[:base] or speeds[:base] != self.speeds[:base]
            if is_other or command.first > len(self.points):
                raise RefusedError(
                    f"points from number {command.first} on can't be replaced:"
                    f" {self.released} of {len(self.points)} are released"
                )
        if command.released > len(points):
            raise RefusedError(f"{command.released} of {len(points)} points can't be released")
        is_same = (points, speeds, command.released) == (self.points, self.speeds, self.released)
        if is_same and not self.is_refused:
            return
        self.points, self.speeds = points, speeds
        self.released, self.is_changed = command.released, True

    @property
    def straightens(self) -> bool:
        """Whether the vehicle is to stand straight in the middle of the path's only point."""
        return self.heading is not None and len(self.points) == 1

    @property
    def awaits_answer(self) -> bool:
        """Whether the vehicle has yet to confirm the last order that was sent."""
        return self.sent is not None

    @property
    def is_known(self) -> bool:
        """Whether the vehicle was sent anything of it."""
        return self.update >= 0

    @property
    def is_whole(self) -> bool:
        """Whether the vehicle has all of the path, and all of it is released."""
        whole = self.released == len(self.points)
        return whole and not self.is_changed and not self.awaits_answer

    def confirm(self, update: int) -> bool:
        """Notes the update of this order that a vehicle confirms. Returns whether it is the awaited
        one."""
        if not self.sent or update != self.update:
            return False
        self.had = (self.sent.base[-1].sequence // 2) + 1
        self.had_update, self.end = update, self.sent.nodes[-1].sequence
        self.sent = None
        self.is_changed |= self.had < self.released
        return True

    def is_cut_short(self, update: int, sequence: int) -> bool:
        """Returns whether a vehicle that has nothing left to drive stands before the end of what
        it has, as after a cancelOrder."""
        return update == self.had_update and sequence < self.end

    def refuse(self) -> None:
        """Goes back to what the vehicle has: it refused the last order. The number is not used
        again, since states may still mention it."""
        self.sent, self.is_changed, self.is_refused = None, False, True
        self.released = self.had

    def next_order(self, place: PlaceNode) -> VehicleOrder | None:
        """Returns the order with the changes; None if there are none, or while the vehicle has not
        confirmed the last one."""
        if self.awaits_answer or not self.is_changed:
            return None
        self.update += 1
        first = max(0, self.had - 1)
        last = min(len(self.points), first + max(2, self.max_nodes))
        nodes = tuple(self._node(i, place) for i in range(first, last))
        edges = tuple(self._edge(i, place) for i in range(first, last - 1))
        self.sent = VehicleOrder(self.order_id, self.update, nodes, edges)
        self.is_changed = self.is_refused = False
        return self.sent

    def _node(self, i: int, place: PlaceNode) -> Node:
        name, position = place(self.points[i])
        actions = self.actions if i == len(self.points) - 1 else ()
        demands: tuple[tuple[str, float], ...] = ()
        if self.straightens:
            position, demands = replace(position, theta=self.heading), EXACTLY
        return Node(name, 2 * i, i < self.released, position, actions, demands=demands)

    def _edge(self, i: int, place: PlaceNode) -> Edge:
        start, end = (place(point)[0] for point in self.points[i : i + 2])
        demands = dict(self.edge_demands(*self.points[i : i + 2]))
        limit = min(self.speeds[i + 1], demands.get("maxSpeed", math.inf))
        if math.isfinite(limit):
            demands["maxSpeed"] = limit
        released = i + 1 < self.released
        return Edge(
            f"{start}-{end}", 2 * i + 1, released, start, end, demands=tuple(demands.items())
        )


def begin(command: Follow, order_id: str, heading: float) -> Journey:
    """Returns the journey of a new path; heading: of a vehicle that stands straight where it
    begins [rad]. Raises RefusedError."""
    if command.first != 0 or not command.points:
        raise RefusedError("a new path begins with point 0, where the robot stands")
    if not 1 <= command.released <= len(command.points):
        raise RefusedError(f"{command.released} of {len(command.points)} points can't be released")
    points = list(command.points)
    way = Journey(command.path_id, order_id, points, command.released, heading=heading)
    way.speeds = [*command.speeds] or [math.inf] * len(points)
    return way


def speeds_after(way: Journey, command: Follow) -> list[float]:
    """Returns a journey's speed limits after a command: where that has none, known points keep
    theirs."""
    first = command.first
    if command.speeds:
        return [*way.speeds[:first], *command.speeds]
    known = zip(way.points[first:], way.speeds[first:])
    olds = itertools.zip_longest(known, command.points)
    new = [old[1] if old and old[0] == point else math.inf for old, point in olds if point]
    return [*way.speeds[:first], *new]
