# SPDX-License-Identifier: Apache-2.0
"""Elevators of ideal robots: one robot at a time, in the order in which they come.

By the rules of elevator_rules; the next robot moves up by a cell. Of several elevators a robot
takes the one by which it should come first.
"""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.traffic.elevator_rules import Car, best
from warehouse_layout.floor.rides import Leg, Option, Ride
from warehouse_operations.fleets.ideal_floor import IdealFloor


class Rider(Protocol):
    """A robot that rides: its index and its cell."""

    index: int
    cell: int


class Drives(Protocol):
    """The trips whose robots ride, as ideal_trips.Trips. time: simulated [s]."""

    time: float
    kinematics: Kinematics
    floor: IdealFloor

    def stretched(self, seconds: float, act: Callable[[Any], object]) -> float:
        """Returns the time of a drive that ends with an act [s]."""
        ...

    def set_out(self, robot: Any, wait: float, leg: Leg) -> None:
        """Counts the metres of a drive that begins after a wait [s]."""
        ...

    def schedule(
        self, delay: float, act: Callable[[Any], object], argument: Any, robot: Any
    ) -> None:
        """Schedules an act of a robot after a delay [s]."""
        ...


@dataclass(eq=False)
class Journey:
    """A way with rides: the legs that are left, the present one first, and the act at its end."""

    legs: deque[Leg]
    act: Callable[[Any], object]
    argument: Any
    robot: Rider
    called: float = 0.0  # when it came to the elevator [s]
    is_riding: bool = False

    @property
    def ride(self) -> Ride:
        """The ride at the end of the present leg."""
        ride = self.legs[0].ride
        assert ride
        return ride

    @property
    def left(self) -> float:
        """The time of what follows the present drive or ride, without waiting for others [s]."""
        rides = sum(leg.ride.seconds for leg in self.legs if leg.ride)
        drives = sum(leg.seconds for leg in list(self.legs)[1:])
        return drives + rides - (self.ride.seconds if self.is_riding else 0.0)


@dataclass(eq=False)
class Lift(Car):
    """The robots that ride and wait for an elevator, and the figures of its rides so far."""

    queue: deque[Journey] = field(default_factory=deque)
    riding: Journey | None = None  # from when the robot may move up into it
    coming: int = 0  # robots on their way to it
    free_from: float = 0.0  # when its last robot has left [s]

    @property
    def ahead(self) -> int:
        """The robots that ride, wait, and are on their way to it."""
        return self.coming + len(self.queue) + (self.riding is not None)


class Lifts:
    """The elevators of a floor, which carry the robots of some Trips."""

    def __init__(self, trips: Drives, count: int) -> None:
        self._trips = trips
        self.all = [Lift() for _ in range(count)]
        self._coming: dict[int, int] = {}  # the elevator to which a robot drives, by its index

    def best(self, options: Iterable[Option]) -> Ride | None:
        """Returns the ride of the option that should end first; None without any."""
        trips = self._trips
        return best(options, self.all, trips.kinematics, trips.floor.plan.spacing)

    def begin(
        self,
        wait: float,
        legs: Sequence[Leg],
        act: Callable[[Any], object],
        argument: Any,
        robot: Rider,
    ) -> None:
        """Begins a way after a wait [s], at whose end the act is called with its argument."""
        self._drive(Journey(deque(legs), act, argument, robot), wait)

    def drop(self, robot: Rider, delay: float) -> None:
        """Ends the journey of a robot that goes no further; people need a time [s] to clear the
        elevator if it stands in one."""
        self._came(robot)
        for lift in self.all:
            lift.queue = deque(each for each in lift.queue if each.robot is not robot)
            if lift.riding and lift.riding.robot is robot:
                self._clear(lift, delay)

    def _drive(self, journey: Journey, wait: float = 0.0) -> None:
        trips, leg = self._trips, journey.legs[0]
        trips.set_out(journey.robot, wait, leg)
        if leg.ride:
            seconds = trips.stretched(leg.seconds, journey.act)
            self.all[leg.ride.elevator].coming += 1
            self._coming[journey.robot.index] = leg.ride.elevator
            trips.schedule(wait + seconds, self._call, journey, journey.robot)
        else:
            journey.robot.cell = leg.end
            trips.schedule(wait + leg.seconds, journey.act, journey.argument, journey.robot)

    def _came(self, robot: Rider) -> None:
        if (elevator := self._coming.pop(robot.index, None)) is not None:
            self.all[elevator].coming -= 1

    def _call(self, journey: Journey) -> None:
        lift = self.all[journey.ride.elevator]
        self._came(journey.robot)
        journey.robot.cell, journey.called = journey.ride.start, self._trips.time
        lift.queue.append(journey)
        self._carry_next(lift, 0.0)

    def _carry_next(self, lift: Lift, moving_up: float) -> None:
        """Carries the first that waits, as soon as the elevator has been left."""
        if lift.riding or not lift.queue:
            return
        journey = lift.riding = lift.queue.popleft()
        trips = self._trips
        delay = max(lift.free_from - trips.time, 0.0) + moving_up
        lift.waited += trips.time + delay - journey.called
        journey.is_riding = True
        trips.schedule(delay + journey.ride.seconds, self._leave, journey, journey.robot)

    def _leave(self, journey: Journey) -> None:
        """Has a robot leave at the end of its ride."""
        lift, ride = self.all[journey.ride.elevator], journey.ride
        lift.carried(ride)
        journey.robot.cell, journey.is_riding = ride.end, False
        journey.legs.popleft()
        trips = self._trips
        self._clear(lift, trips.kinematics.leaving(trips.floor.plan.spacing))
        self._drive(journey)

    def _clear(self, lift: Lift, delay: float) -> None:
        """Frees an elevator after a delay [s]."""
        trips = self._trips
        lift.riding, lift.free_from = None, trips.time + delay
        self._carry_next(lift, float(trips.kinematics.run(trips.floor.plan.spacing)))
