# SPDX-License-Identifier: Apache-2.0
"""The battery energy of ideal robots for driving, turning and lifting.

The formulas are those of simulated batteries (doc/explanation/realism.md), with the masses of the
models: a run from rest to rest gains and loses its kinetic energy once, and so does a turn.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from warehouse_fleet.robots.kinematics import Kinematics

GRAVITY = 9.81  # [m/s²]
STROKE = 0.1  # of the tower, from rest to raised [m]
TOUCHES = 0.03  # the tower's rise up to the unit's underside, where the load begins [m]
QUARTER = math.pi / 2  # [rad]


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


def load_of(items: int) -> Body:
    """Returns the body of a storage unit with a number of items."""
    return UNIT + ITEM.times(items)


@dataclass(frozen=True)
class Drain:
    """Parameters of the energy of motion.

    rolling_resistance: force over weight. drive_efficiency: from the battery to the wheels;
    lift_efficiency: to the load. regeneration: the share of the energy of motion that braking
    gives back.
    """

    rolling_resistance: float = 0.015
    drive_efficiency: float = 0.75
    regeneration: float = 0.3
    lift_efficiency: float = 0.4

    def runs(self, metres: ArrayLike, kinematics: Kinematics, body: Body) -> float:
        """Returns the energy of straight runs from rest to rest, each of its length [J]."""
        lengths = np.abs(np.asarray(metres, float))
        return self._rolling(float(lengths.sum()), body) + self.starts(lengths, kinematics, body)

    def starts(self, metres: ArrayLike, kinematics: Kinematics, body: Body) -> float:
        """Returns the part of the energy of runs for starts and stops [J]."""
        lengths = np.abs(np.asarray(metres, float))
        squares = np.minimum(kinematics.speed**2, kinematics.acceleration * lengths)  # [m²/s²]
        inert = body.mass + 2 * WHEEL_INERTIA / WHEEL_RADIUS**2
        return self._gained_and_lost(inert * float(squares.sum()) / 2)

    def turns(self, quarters: float, kinematics: Kinematics, body: Body) -> float:
        """Returns the energy of quarter turns from rest to rest [J]."""
        if not kinematics.quarter_turn:
            return 0.0
        rate = 2 * QUARTER / kinematics.quarter_turn  # at its peak [rad/s]
        wheel = rate * WHEEL_SEPARATION / 2 / WHEEL_RADIUS
        kinetic = (body.inertia * rate**2 + 2 * WHEEL_INERTIA * wheel**2) / 2
        rolling = self._rolling(QUARTER * WHEEL_SEPARATION / 2, body)
        return quarters * (rolling + self._gained_and_lost(kinetic))

    def lift(self, load: Body) -> float:
        """Returns the energy of raising a load [J]; lowering it takes none."""
        return load.mass * GRAVITY * (STROKE - TOUCHES) / self.lift_efficiency

    def _rolling(self, metres: float, body: Body) -> float:
        return self.rolling_resistance * body.mass * GRAVITY * metres / self.drive_efficiency

    def _gained_and_lost(self, kinetic: float) -> float:
        return kinetic * (1 / self.drive_efficiency - self.regeneration)


@dataclass(frozen=True)
class Way:
    """A way of straight runs [m], with a turn before each."""

    runs: tuple[float, ...]

    @classmethod
    def along(cls, cells: Iterable[int], spacing: float) -> "Way":
        """Returns the way through adjacent cells."""
        lengths: list[float] = []
        ahead, before = 0, None
        for cell in cells:
            step = cell - before if before is not None else 0
            if step and step != ahead:
                lengths.append(0.0)
                ahead = step
            if step:
                lengths[-1] += spacing
            before = cell
        return cls(tuple(lengths))


class Consumption:
    """The energy of the trips of a fleet's robots, with or without their units.

    items: number of items on each unit, by its id.
    """

    def __init__(self, drain: Drain, kinematics: Kinematics, items: Mapping[int, int]) -> None:
        self._drain, self._kinematics, self._items = drain, kinematics, items

    def drive(self, way: Way, unit: int | None) -> float:
        """Returns the energy of a way with a unit, by its id, or without [J]."""
        body = self._with(unit)
        turns = self._drain.turns(len(way.runs), self._kinematics, body)
        return turns + self._drain.runs(way.runs, self._kinematics, body)

    def start(self, metres: float, unit: int | None) -> float:
        """Returns the energy of a start and a stop within a run [J]."""
        return self._drain.starts(metres, self._kinematics, self._with(unit))

    def _with(self, unit: int | None) -> Body:
        return ROBOT if unit is None else ROBOT + load_of(self._items.get(unit, 0))

    def lift(self, unit: int) -> float:
        """Returns the energy of raising a unit [J]."""
        return self._drain.lift(load_of(self._items.get(unit, 0)))
