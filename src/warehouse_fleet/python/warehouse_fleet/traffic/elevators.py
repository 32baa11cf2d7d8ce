# SPDX-License-Identifier: Apache-2.0
"""Takes robots with bodies from tier to tier.

A robot whose goal is on another tier drives to the gate of an elevator, through its queue. The
first one there enters once the car is free: the cell that it enters and the one where it is set
down are then kept for it alone, so that it meets no robot in either. It stands in the car for the
time of the ride; then the host sets it down at the other end, with the unit that it carries.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from warehouse_fleet import Execution, Floor
from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.traffic.elevator_rules import Car, best
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.landings import Landings
from warehouse_layout.floor.rides import Chains, Ride, rides_of

ROUNDING = 1e-6  # [s]


class Move(NamedTuple):
    """A robot is to be set down, with what it carries, at a place in the frame world [m]."""

    kiva_id: int
    x: float
    y: float


class Phase(IntEnum):
    """Where a robot is with its ride."""

    COMING = 0  # on its way to the queue
    WAITING = 1  # in the queue
    ENTERING = 2  # the car is kept for it
    RIDING = 3
    ARRIVING = 4  # the host sets it down


@dataclass(eq=False)
class Trip:
    """A robot on its way to a ride, and in it."""

    robot: int
    ride: Ride
    gate: int
    phase: Phase = Phase.COMING
    called: float = 0.0  # when it came to the queue [s]
    entered: float = 0.0  # when the car was kept for it [s]
    until: float = 0.0  # when the ride ends [s]


class KeptCar(Car):
    """An elevator of robots with bodies. user: the robot that it is kept for, until that has left
    the cell `exit`; NOWHERE: none."""

    def __init__(self) -> None:
        super().__init__()
        self.user, self.exit = NOWHERE, NOWHERE
        self.trips: list[Trip] = []  # by which robots are to come, in the order of their begin

    @property
    def ahead(self) -> int:
        """The robots that ride, wait, and are on their way to it."""
        has_left = self.user != NOWHERE and all(trip.robot != self.user for trip in self.trips)
        return len(self.trips) + has_left


class Elevators:
    """The elevators of a FloorPlan, for the robots of a RobotTable whose goals are on other tiers
    than they are; `floor` is the one that their planner knows."""

    def __init__(
        self,
        plan: FloorPlan,
        landings: Landings,
        floor: Floor,
        robots: RobotTable,
        execution: Execution,
        kinematics: Kinematics,
    ) -> None:
        self._plan, self._floor, self._robots = plan, floor, robots
        self._execution, self._kinematics = execution, kinematics
        self.cars = [KeptCar() for _ in plan.elevators]
        self._landings, self._tier = landings, plan.tier.ravel()
        self._chains = Chains(rides_of(plan.elevators), self._tier, self._along_axes)
        self._trips: dict[int, Trip] = {}  # by robot
        self._moves: list[Move] = []
        self._time = 0.0  # [s]
        self._steps: dict[Phase, Callable[[Trip], None]] = {
            Phase.COMING: self._come,
            Phase.WAITING: self._wait,
            Phase.ENTERING: self._enter,
            Phase.RIDING: self._carry,
            Phase.ARRIVING: self._arrive,
        }

    def _along_axes(self, cells: np.ndarray, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns time [s] and length [m] of drives along both axes."""
        (y, x), (to_y, to_x) = np.divmod(cells, self._plan.width), np.divmod(to, self._plan.width)
        dx, dy = np.abs(x - to_x) * self._plan.spacing, np.abs(y - to_y) * self._plan.spacing
        return self._kinematics.run(dx) + self._kinematics.run(dy), dx + dy

    # What others ask.

    @property
    def busy(self) -> np.ndarray:
        """(n,) bool: robots that ride, or stand at the head of a queue; they stay."""
        out = np.zeros(len(self._robots), bool)
        for robot, trip in self._trips.items():
            out[robot] = trip.phase >= Phase.RIDING or self._stays(trip)
        return out

    def _stays(self, trip: Trip) -> bool:
        """Returns whether a robot stops where it is, or where it was released to, though others
        push: in the car, or at the head of a queue. Before an elevator without one it makes way."""
        if trip.phase == Phase.ENTERING:
            return self._holds(trip, trip.ride.start)
        is_first = trip.phase == Phase.WAITING and self._robots.cell[trip.robot] == trip.gate
        return bool(is_first and trip.gate in self._landings.approach[trip.ride.start])

    def _holds(self, trip: Trip, cell: int) -> bool:
        """Returns whether a cell was released to the robot of a trip."""
        return bool(self._execution.holder(cell) == trip.robot)

    @property
    def waits(self) -> np.ndarray:
        """(n,) bool: robots that wait for an elevator, or ride."""
        out = np.zeros(len(self._robots), bool)
        for robot, trip in self._trips.items():
            out[robot] = trip.phase == Phase.WAITING or trip.phase >= Phase.RIDING
        return out

    def goals(self) -> np.ndarray:
        """Returns (n,) the cells to which robots drive now: goals, gates and cars."""
        goal = self._robots.goal.copy()
        for robot, trip in self._trips.items():
            goal[robot] = trip.ride.start if trip.phase >= Phase.ENTERING else trip.gate
        return goal

    def shortest(self, begin: int, end: int, loaded: bool) -> int:
        """Returns the cells of the shortest way between two cells, which leads by rides."""
        cells = 0
        for leg in self._chains.legs(begin, end):
            cells += self._floor.shortest(begin, leg.end, loaded=loaded)
            begin = leg.ride.end if leg.ride else begin
        return cells

    def take_moves(self) -> list[Move]:
        """Returns the robots that are to be set down now, since the last call."""
        moves, self._moves = self._moves, []
        return moves

    # What happens.

    def advance(self, time: float) -> None:
        """Goes on to a time [s], by where robots are and are to go."""
        self._time = time
        robots = self._robots
        asks = (robots.goal != NOWHERE) & (robots.cell != NOWHERE)
        asks &= self._tier[robots.goal] != self._tier[robots.cell]
        for robot in np.flatnonzero(asks).tolist():
            if robot not in self._trips:
                self._begin(robot)
        for trip in list(self._trips.values()):
            if trip.phase < Phase.RIDING and not (asks[trip.robot] and self._leads_on(trip)):
                self._drop(trip)
            else:
                self._steps[trip.phase](trip)
        for car in self.cars:
            self._free(car)
            self._admit(car)

    def _begin(self, robot: int) -> None:
        cell, goal = int(self._robots.cell[robot]), int(self._robots.goal[robot])
        options = self._chains.options(cell, goal)
        ride = best(options, self.cars, self._kinematics, self._plan.spacing)
        if ride is None:
            ride = self._chains.legs(cell, goal)[0].ride
        if ride is None:
            return
        gates = np.array(self._landings.gates[ride.start])
        gate = int(gates[self._along_axes(gates, np.array(cell))[0].argmin()])
        trip = self._trips[robot] = Trip(robot, ride, gate)
        self.cars[ride.elevator].trips.append(trip)

    def _leads_on(self, trip: Trip) -> bool:
        """Returns whether a ride still leads from a robot's tier towards that of its goal."""
        robots, tier = self._robots, self._tier
        cell, goal = int(robots.cell[trip.robot]), int(robots.goal[trip.robot])
        if tier[cell] != tier[trip.ride.start]:
            return False
        is_there = tier[goal] == tier[trip.ride.end]
        return bool(is_there or not list(self._chains.options(cell, goal)))

    def _drop(self, trip: Trip) -> None:
        """Ends a trip whose robot needs no ride any more. One in the car leaves it first."""
        if trip.phase == Phase.ENTERING:
            self._execution.give_up(trip.robot)
            self.cars[trip.ride.elevator].exit = trip.ride.start
        self._end(trip)

    def _end(self, trip: Trip) -> None:
        del self._trips[trip.robot]
        self.cars[trip.ride.elevator].trips.remove(trip)

    def _come(self, trip: Trip) -> None:
        cell = int(self._robots.cell[trip.robot])
        queue = self._landings.approach[trip.ride.start]
        if cell in (trip.gate, trip.ride.start) or cell in queue:
            trip.phase, trip.called = Phase.WAITING, self._time

    def _wait(self, trip: Trip) -> None:
        """A robot that waits goes on by _admit()."""

    def _enter(self, trip: Trip) -> None:
        robots, robot, car = self._robots, trip.robot, self.cars[trip.ride.elevator]
        if robots.cell[robot] == trip.ride.start and robots.stands[robot]:
            trip.phase, trip.until = Phase.RIDING, self._time + trip.ride.seconds
            car.waited += trip.entered - trip.called
        elif robots.cell[robot] != trip.ride.start and not self._is_entering(trip):
            # Others ride, if it lets them pass.
            self._execution.give_up(robot)
            trip.phase = Phase.WAITING
            car.exit = trip.ride.start

    def _is_entering(self, trip: Trip) -> bool:
        """Returns whether a robot is fit, and before the car or on its way into it."""
        cells = trip.gate, trip.ride.start
        return self._is_able(trip.robot) and any(self._holds(trip, cell) for cell in cells)

    def _is_able(self, robot: int) -> bool:
        robots = self._robots
        return bool(robots.automatic[robot] and not robots.broken[robot])

    def _carry(self, trip: Trip) -> None:
        if self._time < trip.until - ROUNDING:
            return
        x, y = self._plan.point_of(trip.ride.end)
        kiva_id = int(self._robots.kiva_ids[trip.robot])
        self._moves.append(Move(kiva_id, float(x), float(y)))
        trip.phase = Phase.ARRIVING

    def _arrive(self, trip: Trip) -> None:
        if self._robots.cell[trip.robot] != trip.ride.end:
            return
        car = self.cars[trip.ride.elevator]
        car.carried(trip.ride)
        car.exit = trip.ride.end
        self._end(trip)

    def _free(self, car: KeptCar) -> None:
        """Frees a car whose robot has left it."""
        if car.user == NOWHERE or car.exit == NOWHERE:
            return
        if self._execution.holder(car.exit) != car.user:
            car.user = car.exit = NOWHERE

    def _admit(self, car: KeptCar) -> None:
        """Keeps a free car for the robot that came first, of those at the heads of queues."""
        if car.user != NOWHERE:
            return
        for trip in sorted(self._heads(car), key=self._rank):
            start, end = trip.ride.start, trip.ride.end
            is_free = self._execution.holder(start) in (NOWHERE, trip.robot)
            if is_free and self._is_able(trip.robot) and self._execution.keep(trip.robot, end):
                trip.phase, trip.entered = Phase.ENTERING, self._time
                car.user = trip.robot
                return

    def _rank(self, trip: Trip) -> tuple[bool, float, int]:
        """Returns what orders robots: one that stands in the car comes first."""
        is_outside = self._robots.cell[trip.robot] != trip.ride.start
        return bool(is_outside), trip.called, trip.robot

    def _heads(self, car: KeptCar) -> Iterator[Trip]:
        """Yields the first robot of each of a car's queues: the one to which the gate was released,
        since no other one comes past it, or one that stands in the car already."""
        for trip in car.trips:
            is_inside = self._robots.cell[trip.robot] == trip.ride.start
            if trip.phase == Phase.WAITING and (is_inside or self._holds(trip, trip.gate)):
                yield trip
