# SPDX-License-Identifier: Apache-2.0
"""What this package reads of messages and worlds, as types: it imports neither ROS nor a world."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np


class OccupancyGrid(Protocol):
    """A nav_msgs/OccupancyGrid: the map of a world, row by row from the lowest y."""

    info: Any  # nav_msgs/MapMetaData
    data: Any  # int8 a cell


class Look(Protocol):
    """A warehouse_msgs/Look: the shapes that make up a model's appearance."""

    links: Sequence[str]
    shape_link: Sequence[int]  # index into links
    shape_pose: Sequence[float]  # 7 a shape
    shape_size: Sequence[float]  # 3 a shape [m]


class Scenery(Protocol):
    """A warehouse_msgs/Scenery: which models stand in a world, and how they look."""

    models: Sequence[str]
    model_look: Sequence[int]  # index into looks
    pose: Sequence[float]  # 7 a model
    looks: Sequence[Look]


class World(Protocol):
    """A kiva_plugin_cpp.World, as far as a floor plan is read from it."""

    @property
    def names(self) -> Sequence[str]:
        """The names of all models."""

    def visuals(self, name: str) -> Sequence[Any]:
        """Returns (link, pose (7,), size (3,) [m]) of each visual of a model."""

    def pose(self, name: str) -> np.ndarray:
        """Returns x y z [m] qx qy qz qw of a model in the world, (7,)."""

    def occupancy(self) -> tuple[Any, ...]:
        """Returns x, y [m] of cell (0, 0), the spacing [m] and the cells' values, (h, w) uint8."""
