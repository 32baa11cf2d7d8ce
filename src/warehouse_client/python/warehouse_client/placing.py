# SPDX-License-Identifier: Apache-2.0
"""Free places for another robot."""

import math
from itertools import count

from warehouse_client import survey
from warehouse_client.engine import Engine
from warehouse_layout.file.request import LIMITS, RequestError
from warehouse_layout.generate.cells import Cells
from warehouse_layout.models import models

NEAR = 0.95  # [m]: another robot that is no further along x and y is on the same cell
OFF = 1e-3  # largest distance from the grid [m], and angle from a quarter turn [rad]


class PlaceError(ValueError):
    """Raised for a place where no robot can stand; says why."""


def add_robot(engine: Engine, x: float, y: float, heading: float) -> int:
    """Adds a robot on a free grid point (x, y) [m] with a heading in quarter turns [rad]; returns
    its number, the lowest free one. Raises PlaceError, EngineError.
    """
    standing = survey.of_engine(engine, without=("item", "storage_unit"))
    if len(standing.kiva) >= LIMITS["robots"]:
        raise PlaceError(f"there are {len(standing.kiva)} robots; that is the limit")
    point = _grid_point(x, y)
    _check_free(point, standing, _cells(engine))
    quarters = round(heading / (math.pi / 2))
    if abs(heading - quarters * math.pi / 2) > OFF:
        raise PlaceError(f"heading {heading:g} rad is not a whole number of quarter turns")
    number = next(n for n in count(1) if n not in standing.kiva)
    part = models.include("kiva", number, *point, yaw=quarters * math.pi / 2)
    engine.spawn(models.document([part]), part.name)
    return number


def _grid_point(x: float, y: float) -> tuple[int, int]:
    point = round(x), round(y)
    if max(abs(x - point[0]), abs(y - point[1])) > OFF:
        raise PlaceError(f"({x:g}, {y:g}) is off the grid")
    return point


def _cells(engine: Engine) -> Cells:
    try:
        return Cells.of_map(engine.map())
    except RequestError as error:
        raise PlaceError(str(error)) from error


def _check_free(point: tuple[int, int], standing: survey.Survey, cells: Cells) -> None:
    """Raises PlaceError if a grid point is taken; a storage unit takes none."""
    i, j = point[0] - cells.x, point[1] - cells.y
    if not (0 <= i < cells.taken.shape[0] and 0 <= j < cells.taken.shape[1]):
        raise PlaceError(f"{point} is outside the floor")
    for number, (x, y, _) in standing.kiva.items():
        if max(abs(point[0] - x), abs(point[1] - y)) < NEAR:
            raise PlaceError(f"{point} is taken by kiva{number}")
    if point in standing.obstacles():
        raise PlaceError(f"{point} is taken by something that no robot can pass")
