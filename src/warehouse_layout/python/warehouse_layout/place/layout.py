# SPDX-License-Identifier: Apache-2.0
"""A Layout: where each model of a warehouse stands, and the plan of its floor."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from warehouse_layout.floor.floor_plan import FloorPlan

SEED = 1  # of the regular layout, in which numbers and items follow the rows


@dataclass(frozen=True)
class Floor:
    """A rectangle along the axes of `world` [m]."""

    min_x: float
    max_x: float
    min_y: float
    max_y: float

    @property
    def size(self) -> tuple[float, float]:
        """Edges along x and y [m]."""
        return self.max_x - self.min_x, self.max_y - self.min_y

    @property
    def centre(self) -> tuple[float, float]:
        """The point x, y in the middle, in `world` [m]."""
        return (self.min_x + self.max_x) / 2, (self.min_y + self.max_y) / 2


def _none(columns: int) -> Callable[[], np.ndarray]:
    return lambda: np.zeros((0, columns))


@dataclass(frozen=True)
class Layout:
    """Poses in `world` [m, rad]; entry i belongs to robot, unit, item or belt number i + 1."""

    floor: Floor
    robots: np.ndarray = field(default_factory=_none(3))  # x y yaw
    units: np.ndarray = field(default_factory=_none(2))  # x y
    places: np.ndarray = field(default_factory=_none(2))  # x y of all storage places
    item_unit: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # index into units
    item_mass: np.ndarray | None = None  # [kg]; NaN, and None for all: as the model is
    item_place: np.ndarray = field(default_factory=_none(3))  # x y z in the unit's frame
    belts: np.ndarray = field(default_factory=_none(3))  # x y yaw
    belt_lengths: np.ndarray | None = None  # [m]; None: each as its model is
    drops: np.ndarray = field(default_factory=_none(2))  # x y, before the belt of the same index
    plan: FloorPlan | None = None  # streets and stations; None: nothing is marked on the floor
    walls: np.ndarray = field(default_factory=_none(4))  # x y size_x size_y of boxes, a metre high
    has_own_floor: bool = True  # False: it uses the floor of the world
    where: str = ""  # the part of that floor, named for people


def chance(seed: int) -> np.random.Generator | None:
    """Returns the random generator that shuffles a layout; None for the regular one."""
    return None if seed == SEED else np.random.default_rng(seed)
