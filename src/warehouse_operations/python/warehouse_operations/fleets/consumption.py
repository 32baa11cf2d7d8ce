# SPDX-License-Identifier: Apache-2.0
"""The battery energy of ideal robots for driving, turning and lifting.

The formulas are those of simulated batteries (doc/explanation/realism.md), with the masses of the
models: a run from rest to rest gains and loses its kinetic energy once, and so does a turn. What
robots brake for others, or because the next cells are released late, comes on top.
"""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from warehouse_fleet.robots.kinematics import Kinematics

MassOfItems = Callable[[int], float]  # those on a unit [kg], by its id

GRAVITY = 9.81  # [m/s²]
STROKE = 0.1  # of the tower, from rest to raised [m]
TOUCHES = 0.03  # the tower's rise up to the unit's underside, where the load begins [m]
QUARTER = math.pi / 2  # [rad]

# As fitted to simulated shifts (bench/README.md). Stops for others per metre of way where one robot
# drives on each cell; those without a unit give way.
STOPS_LOADED, STOPS_UNLOADED = 0.7, 1.5
# Delays up to LATE [s] pass unnoticed; BRAKES is the share of any more in which robots brake.
LATE, BRAKES = 0.1, 0.33


@dataclass(frozen=True)
class Body:
    """Mass [kg] and moment of inertia about the vertical axis [kg m²], added up over parts."""

    mass: float
    inertia: float

    def __add__(self, other: "Body") -> "Body":
        return Body(self.mass + other.mass, self.inertia + other.inertia)

    def times(self, count: float) -> "Body":
        """Returns the body of a number of such bodies about the same axis."""
        return Body(self.mass * count, self.inertia * count)


# Of the models in worlds/models: chassis, wheels and tower; a storage unit; an item on its boards,
# with the mean square of its distance from the unit's centre.
ROBOT = Body(145.0, 11.36)
UNIT = Body(60.0, 6.4)
ITEM = Body(1.5, 0.13)
WHEEL_RADIUS, WHEEL_SEPARATION, WHEEL_INERTIA = 0.1, 0.52, 0.03  # [m], [m], [kg m²]


def load_of(items: float) -> Body:
    """Returns the body of a storage unit with items of a mass in all [kg]."""
    return UNIT + ITEM.times(items / ITEM.mass)


@dataclass(frozen=True)
class Drain:
    """Parameters of the energy of motion.

    rolling_resistance: force over weight. drive_efficiency: from the battery to the wheels;
    lift_efficiency: to the load. regeneration: the share of the energy of motion that braking
    gives back. motor_lag: time constant T with which speeds follow their commands [s]; where these
    rise evenly for a time t and fall again, the largest speed is a (t - T ln 2).
    """

    rolling_resistance: float = 0.015
    drive_efficiency: float = 0.75
    regeneration: float = 0.3
    lift_efficiency: float = 0.4
    motor_lag: float = 0.0

    def runs(self, metres: ArrayLike, kinematics: Kinematics, body: Body) -> float:
        """Returns the energy of straight runs from rest to rest, each of its length [J]."""
        lengths = np.abs(np.asarray(metres, float))
        return self._rolling(float(lengths.sum()), body) + self.starts(lengths, kinematics, body)

    def starts(self, metres: ArrayLike, kinematics: Kinematics, body: Body) -> float:
        """Returns the part of the energy of runs for starts and stops [J]."""
        lengths = np.abs(np.asarray(metres, float))
        peaks = np.sqrt(kinematics.acceleration * lengths) - self._lost(kinematics.acceleration)
        return self.changes(float((np.clip(peaks, 0.0, kinematics.speed) ** 2).sum()), body)

    def changes(self, squares: float, body: Body) -> float:
        """Returns the energy of speeds that are lost and gained again [J]. squares: by how much
        their squares change, in all [m²/s²]."""
        inert = body.mass + 2 * WHEEL_INERTIA / WHEEL_RADIUS**2
        return self._gained_and_lost(inert * squares / 2)

    def turns(self, quarters: float, kinematics: Kinematics, body: Body) -> float:
        """Returns the energy of quarter turns from rest to rest [J]."""
        if not kinematics.quarter_turn:
            return 0.0
        rate = 2 * QUARTER / kinematics.quarter_turn  # at the command's peak [rad/s]
        rate = max(rate - self._lost(2 * rate / kinematics.quarter_turn), 0.0)
        wheel = rate * WHEEL_SEPARATION / 2 / WHEEL_RADIUS
        kinetic = (body.inertia * rate**2 + 2 * WHEEL_INERTIA * wheel**2) / 2
        rolling = self._rolling(QUARTER * WHEEL_SEPARATION / 2, body)
        return quarters * (rolling + self._gained_and_lost(kinetic))

    def lift(self, load: Body) -> float:
        """Returns the energy of raising a load [J]; lowering it takes none."""
        return load.mass * GRAVITY * (STROKE - TOUCHES) / self.lift_efficiency

    def _lost(self, acceleration: float) -> float:
        """Returns by how much the largest speed falls short of the command's."""
        return self.motor_lag * math.log(2) * acceleration

    def _rolling(self, metres: float, body: Body) -> float:
        return self.rolling_resistance * body.mass * GRAVITY * metres / self.drive_efficiency

    def _gained_and_lost(self, kinetic: float) -> float:
        return kinetic * (1 / self.drive_efficiency - self.regeneration)


@dataclass(frozen=True)
class Way:
    """A way of straight runs [m], with a turn between two of them.

    first, last: the directions of the first and the last run, as the difference of adjacent cells;
    0 for no run.
    """

    runs: tuple[float, ...]
    first: int = 0
    last: int = 0

    @classmethod
    def along(cls, cells: Iterable[int], spacing: float) -> "Way":
        """Returns the way through adjacent cells."""
        lengths: list[float] = []
        first = ahead = 0
        before = None
        for cell in cells:
            step = cell - before if before is not None else 0
            if step and step != ahead:
                lengths.append(0.0)
                first, ahead = first or step, step
            if step:
                lengths[-1] += spacing
            before = cell
        return cls(tuple(lengths), first, ahead)

    @classmethod
    def along_axes(cls, start: int, end: int, width: int, spacing: float, heading: int) -> "Way":
        """Returns the way between two cells of a grid of a width, straight ahead first if one of
        its two runs is along the heading."""
        (y, x), (to_y, to_x) = divmod(start, width), divmod(end, width)
        runs = [
            (spacing * abs(cells), step if cells > 0 else -step)
            for cells, step in ((to_x - x, 1), (to_y - y, width))
            if cells
        ]
        runs.sort(key=lambda run: run[1] != heading)
        if not runs:
            return cls(())
        return cls(tuple(length for length, _ in runs), runs[0][1], runs[-1][1])


class Consumption:
    """The energy of the trips of a fleet's robots, with or without their units.

    items: the mass of the items on a unit [kg], by its id. spacing: of the cells [m]. delay: how
    late a robot learns on average that another one has left a cell of its way [s].
    """

    def __init__(
        self,
        drain: Drain,
        kinematics: Kinematics,
        items: MassOfItems,
        spacing: float = 1.0,
        delay: float = 0.0,
    ) -> None:
        self._drain, self._kinematics, self._items = drain, kinematics, items
        braking = 2 * kinematics.speed * kinematics.acceleration * BRAKES
        self._brakings = braking * max(delay - LATE, 0.0) / spacing

    def drive(self, way: Way, heading: int, unit: int | None, density: float = 0.0) -> float:
        """Returns the energy of a way with a unit, by its id, or without [J]. heading: of the robot
        before it, as Way.first: a way that goes straight on begins without a turn. density: robots
        that drive, per cell of the floor."""
        body = self._with(unit)
        quarters = len(way.runs) - (way.first == heading) if way.runs else 0
        turns = self._drain.turns(quarters, self._kinematics, body)
        runs = self._drain.runs(way.runs, self._kinematics, body)
        stops = (STOPS_UNLOADED if unit is None else STOPS_LOADED) * density  # [1/m]
        changes = (stops * self._kinematics.speed**2 + self._brakings) * sum(way.runs)
        return turns + runs + self._drain.changes(changes, body)

    def start(self, metres: float, unit: int | None) -> float:
        """Returns the energy of a start and a stop within a run [J]."""
        return self._drain.starts(metres, self._kinematics, self._with(unit))

    def _with(self, unit: int | None) -> Body:
        return ROBOT if unit is None else ROBOT + load_of(self._items(unit))

    def lift(self, unit: int) -> float:
        """Returns the energy of raising a unit [J]."""
        return self._drain.lift(load_of(self._items(unit)))
