# SPDX-License-Identifier: Apache-2.0
"""The rules of elevators, for simulated and for ideal robots alike.

An elevator carries one robot at a time. A ride takes the time of the plan, from when the robot
stands in it; an empty car needs no time to come to it, as in RAWSim-O. The next robot enters once
that one has left the cell at the end of its ride.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout.floor.rides import Option, Ride


@dataclass(eq=False)
class Car:
    """The figures of an elevator so far."""

    rides: int = 0
    ridden: float = 0.0  # time of its rides [s]
    waited: float = 0.0  # by all robots that have ridden [s]

    @property
    def ahead(self) -> int:
        """The robots that ride, wait, and are on their way to it."""
        raise NotImplementedError

    def carried(self, ride: Ride) -> None:
        """Notes a ride that is over."""
        self.rides, self.ridden = self.rides + 1, self.ridden + ride.seconds


def best(
    options: Iterable[Option], cars: Sequence[Car], kinematics: Kinematics, spacing: float
) -> Ride | None:
    """Returns the ride of the option that should end first, with those ahead; None without any."""
    options = list(options)
    if not options:
        return None
    moving = kinematics.leaving(spacing) + float(kinematics.run(spacing))

    def end(option: Option) -> float:
        wait = cars[option.ride.elevator].ahead * (option.ride.seconds + moving) - option.there
        return option.seconds + max(wait, 0.0)

    return min(options, key=end).ride


def figures(cars: Sequence[Car], time: float) -> dict[str, float]:
    """Returns the rides up to a time [s], the share of the elevators' time in them, and the mean
    wait before [s]; empty without elevators."""
    if not cars:
        return {}
    rides = sum(car.rides for car in cars)
    return {
        "elevator_rides": rides,
        "elevator_ride_fraction": sum(car.ridden for car in cars) / max(time * len(cars), 1e-9),
        "elevator_wait_s": sum(car.waited for car in cars) / max(rides, 1),
    }
