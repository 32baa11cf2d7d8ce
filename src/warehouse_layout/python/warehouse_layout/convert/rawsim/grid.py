# SPDX-License-Identifier: Apache-2.0
"""Waypoints of a RAWSim-O instance, snapped to the rows and columns of a grid."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from warehouse_layout.convert.rawsim.xml_fields import InstanceError, PathName, children, number_of

ON_A_LINE = 0.25  # of the spacing: waypoints this far apart may still be in one row
MOST_CELLS = 4_000_000  # of a floor


@dataclass
class Waypoint:
    """A waypoint of an instance; x, y [m] in the frame of the file."""

    number: str
    x: float
    y: float
    storage: bool
    queue: bool
    paths: list[str]  # numbers of the waypoints that follow
    station: tuple[str, str] | None = None  # ("OutputStation" or "InputStation", its ID)


def read_waypoints(path: PathName, root: Element) -> dict[str, Waypoint]:
    """Returns the waypoints by number. Raises InstanceError; path: of the file, for errors."""
    result: dict[str, Waypoint] = {}
    for element in children(root, "Waypoints", "Waypoint"):
        number: Any = element.get("ID")
        if number in result:
            raise InstanceError(f"{path}: there are two Waypoints {number}")
        kinds = ("OutputStation", "InputStation")
        station: Any = next(
            ((k, element.get(k)) for k in kinds if element.get(k, "-1") != "-1"), None
        )
        result[number] = Waypoint(
            number,
            number_of(path, element, "X"),
            number_of(path, element, "Y"),
            element.get("PodStorageLocation", "").lower() == "true",
            element.get("IsQueueWaypoint", "").lower() == "true",
            [(other.text or "").strip() for other in element.findall("Paths/Waypoint")],
            station,
        )
    if not result:
        raise InstanceError(f"{path}: there is no Waypoint")
    for waypoint in result.values():
        for other in waypoint.paths:
            if other not in result:
                raise InstanceError(
                    f"{path}: Waypoint {waypoint.number} has a path to {other}, which is not there"
                )
    return result


class Grid:
    """The rows and columns that waypoints form.

    columns, rows: indices by coordinate [m]. step_x, step_y: spacings [m]. width, height: [cells].
    cell: y * width + x, by waypoint. Raises InstanceError.
    """

    def __init__(self, path: PathName, waypoints: Mapping[str, Waypoint]) -> None:
        self.columns, self.step_x = _lines(sorted({waypoint.x for waypoint in waypoints.values()}))
        self.rows, self.step_y = _lines(sorted({waypoint.y for waypoint in waypoints.values()}))
        if not self.step_x and not self.step_y:
            raise InstanceError(f"{path}: two waypoints or more were expected")
        self.step_x, self.step_y = self.step_x or self.step_y, self.step_y or self.step_x
        self.width = max(self.columns.values()) + 1
        self.height = max(self.rows.values()) + 1
        if self.width * self.height > MOST_CELLS:
            raise InstanceError(
                f"{path}: waypoints make a floor of {self.width} by {self.height} cells; "
                f"{MOST_CELLS} cells at most were expected"
            )
        self.cell = {n: self._cell(waypoint.x, waypoint.y) for n, waypoint in waypoints.items()}
        taken: dict[int, str] = {}
        for number, cell in self.cell.items():
            if cell in taken:
                raise InstanceError(
                    f"{path}: Waypoints {taken[cell]} and {number} fall into one cell"
                )
            taken[cell] = number

    @property
    def origin(self) -> tuple[float, float]:
        """The centre of the first cell, (x, y) [m]."""
        return min(self.columns), min(self.rows)

    @property
    def spacing(self) -> float:
        """The spacing of the cells [m], the mean of both axes."""
        return (self.step_x + self.step_y) / 2

    def cell_at(self, element: Element, path: PathName) -> int:
        """Returns the cell of a bot or pod, in the nearest row and column."""
        x, y = number_of(path, element, "X"), number_of(path, element, "Y")
        return self._cell(
            min(self.columns, key=lambda line: abs(line - x)),
            min(self.rows, key=lambda line: abs(line - y)),
        )

    def _cell(self, x: float, y: float) -> int:
        return self.rows[y] * self.width + self.columns[x]


def _lines(values: Sequence[float]) -> tuple[dict[float, int], float]:
    """Returns the index of each coordinate's row, and the spacing; 0 if there is one row only."""
    gaps = np.diff(values)
    wide = gaps[gaps > ON_A_LINE * gaps.max()] if len(gaps) else gaps
    if not len(wide):
        return {values[0]: 0}, 0.0
    step = float(np.median(wide))
    index, result, last = 0, {values[0]: 0}, values[0]
    for value in values[1:]:
        if value - last > ON_A_LINE * step:
            index += max(1, round((value - last) / step))
            last = value
        result[value] = index
    return result, step
