# SPDX-License-Identifier: Apache-2.0
"""What a maker of a robot implements, so that any VDA 5050 master can drive it.

The vehicle core (warehouse_vda5050.vehicle) does the rest: orders and their updates, actions,
pauses, states. All methods return at once; report() returns what came of a command. The core
calls from one thread, ten times a second or more often.

A path is a list of points; the core numbers it with a `path_id` that no path had before. The robot
is given only what is released: it drives through all points, stops to turn, and stands at the last
one, unless more came in time. That ends the path; more after that comes as a path of its own.
"""

import abc
from collections.abc import Sequence
from dataclasses import dataclass

from warehouse_vda5050.errors import Error
from warehouse_vda5050.model import Battery, Factsheet, OperatingMode

Point = tuple[float, float]  # [m] in the frame of the map


@dataclass(frozen=True)
class Report:
    """A robot's report of its state; the frame is that of the map [m, rad, m/s, rad/s].

    busy: it carries out a command, and takes no other. path_id: of the last path that it took, 0
    for none. reached: count of that path's points that its centre has reached, with the start.
    moving: it drives or turns. refusal: why its last command was refused or broke off, '' if it was
    not; it holds until the next command. blocked: something is in its way. heard: its radio reaches
    us; otherwise all other fields are of its last report. silent: why nothing is heard of it
    although its radio works, such as a program that ended; '' if it is heard. declines: why it
    takes no orders and updates now, '' if it does.
    """

    x: float
    y: float
    yaw: float
    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0
    busy: bool = False
    moving: bool = False
    path_id: int = 0
    reached: int = 0
    load: str = ""  # what it carries, '' if nothing
    refusal: str = ""
    blocked: bool = False
    stopped: bool = False  # an emergency stop holds it that stop() did not ask for
    localized: bool = True
    heard: bool = True
    battery: Battery = Battery()
    mode: OperatingMode = OperatingMode.AUTOMATIC
    errors: tuple[Error, ...] = ()  # what is broken
    silent: str = ""
    declines: str = ""

    @property
    def answers(self) -> bool:
        """Whether the robot itself detects what stands here."""
        return self.heard and not self.silent

    @property
    def speed(self) -> float:
        """The larger of the two components' amounts [m/s]: robots drive along one axis."""
        return max(abs(self.vx), abs(self.vy))


class Driver(abc.ABC):
    """One robot. The simulated robot is the first implementation, SimulatedDriver."""

    @abc.abstractmethod
    def follow(
        self,
        path_id: int,
        first: int,
        points: Sequence[Point],
        released: int,
        speeds: Sequence[float] = (),
    ) -> None:
        """Drives a path, or extends the one under way.

        A new `path_id` with `first` 0 begins where the robot stands, points[0]. The path_id of the
        path under way appends points[0 …] as points number `first` and on. `released` counts the
        points of the whole path that the robot may come to; it never shrinks.

        speeds: the highest on the way to each point from the one before [m/s], inf for none: the
        robot has slowed down where a way begins. Points of the path under way that come again
        change their speeds alone; a robot that is too fast then brakes.
        """

    @abc.abstractmethod
    def lift(self, unit: str, up: bool) -> None:
        """Lifts the unit that stands here (`unit` is its id, '' for any), or puts it down."""

    @abc.abstractmethod
    def cancel(self) -> None:
        """Ends what the robot does: driving at the next grid point, a lift when it is over."""

    @abc.abstractmethod
    def stop(self, stopped: bool) -> None:
        """Pauses the robot at once, or resumes what it did."""

    @abc.abstractmethod
    def report(self) -> Report | None:
        """Returns the robot's present report, None before the first."""

    @abc.abstractmethod
    def factsheet(self) -> Factsheet:
        """Returns what the robot is and can; the core adds its actions and parameters."""

    # What follows has an answer of its own for robots that know none of it.

    # Whether follow() keeps to speeds; otherwise it gets none, and orders with them are refused.
    keeps_speeds = False

    def take(self) -> str:
        """Takes the robot for an order, from whom commands it else. Returns why not, or ''."""
        return ""

    def give_back(self) -> None:  # noqa: B027 robots that nothing else commands need none
        """Gives the robot back to whom commands it else: the order is over."""

    def is_taken(self) -> bool:
        """Returns whether an earlier run of this program took the robot and did not give it
        back."""
        return False

    def charge(self, on: bool) -> str:
        """Begins or ends charging where the robot stands. Returns why not, or ''."""
        report = self.report()
        if report and report.battery.charging == on:
            return ""
        return "the robot stands at no charger" if on else "the robot charges as long as it stands"

    def init_position(self, x: float, y: float, yaw: float) -> str:
        """Sets the robot's pose [m, rad]. Returns why the robot rejects it, or ''."""
        return "the robot finds its position by itself"
