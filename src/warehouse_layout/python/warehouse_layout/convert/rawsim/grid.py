# SPDX-License-Identifier: Apache-2.0
"""Waypoints of a RAWSim-O instance, snapped to the rows and columns of a grid.

Tiers lie side by side along x, the lowest number first, with GAP columns without floor between.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from warehouse_layout.convert.rawsim.xml_fields import InstanceError, PathName, children, number_of

ON_A_LINE = 0.25  # of the spacing: waypoints this far apart may still be in one row
MOST_CELLS = 4_000_000  # of a floor
GAP = 3  # columns between tiers
ALIKE = 0.01  # of the spacing: by how much the spacings of tiers may differ


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
    tier: str = "0"


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
            element.get("Tier", "0"),
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
    """The rows and columns that waypoints form, those of each tier by themselves.

    width, height: of the whole floor [cells]. spacing: of the cells [m], the mean of both axes.
    origin: the centre of the first cell, (x, y) [m]. cell: y * width + x, by waypoint. Raises
    InstanceError.
    """

    def __init__(self, path: PathName, waypoints: Mapping[str, Waypoint]) -> None:
        names = sorted({waypoint.tier for waypoint in waypoints.values()}, key=_by_number)
        self._tiers = {
            name: _Tier(path, [w for w in waypoints.values() if w.tier == name]) for name in names
        }
        first = self._tiers[names[0]]
        self.spacing, self.origin = first.spacing, first.origin
        self._left = self._side_by_side(path)
        self.width = self._left[names[-1]] + self._tiers[names[-1]].width
        self.height = max(tier.height for tier in self._tiers.values())
        if self.width * self.height > MOST_CELLS:
            raise InstanceError(
                f"{path}: waypoints make a floor of {self.width} by {self.height} cells; "
                f"{MOST_CELLS} cells at most were expected"
            )
        self.cell = {n: self._cell(w.tier, w.x, w.y) for n, w in waypoints.items()}
        taken: dict[int, str] = {}
        for number, cell in self.cell.items():
            if cell in taken:
                raise InstanceError(
                    f"{path}: Waypoints {taken[cell]} and {number} fall into one cell"
                )
            taken[cell] = number

    def cell_at(self, element: Element, path: PathName) -> int:
        """Returns the cell of a bot or pod, in the nearest row and column of its tier."""
        x, y = number_of(path, element, "X"), number_of(path, element, "Y")
        name = element.get("Tier", next(iter(self._tiers)))
        if name not in self._tiers:
            raise InstanceError(
                f"{path}: {element.tag} {element.get('ID')} is on Tier {name}, which has no"
                " Waypoint"
            )
        tier = self._tiers[name]
        return self._cell(
            name,
            min(tier.columns, key=lambda line: abs(line - x)),
            min(tier.rows, key=lambda line: abs(line - y)),
        )

    def _side_by_side(self, path: PathName) -> dict[str, int]:
        """Returns the first column of each tier."""
        left, out = 0, {}
        for name, tier in self._tiers.items():
            if abs(tier.spacing - self.spacing) > ALIKE * self.spacing:
                raise InstanceError(
                    f"{path}: waypoints of Tier {name} are {tier.spacing:g} m apart, those of the"
                    f" first {self.spacing:g} m; all alike was expected"
                )
            out[name] = left
            left += tier.width + GAP
        return out

    def _cell(self, tier: str, x: float, y: float) -> int:
        lines = self._tiers[tier]
        return lines.rows[y] * self.width + self._left[tier] + lines.columns[x]


class _Tier:
    """The rows and columns of a tier: indices by coordinate [m]; its size in cells."""

    def __init__(self, path: PathName, waypoints: Sequence[Waypoint]) -> None:
        self.columns, step_x = _lines(sorted({waypoint.x for waypoint in waypoints}))
        self.rows, step_y = _lines(sorted({waypoint.y for waypoint in waypoints}))
        if not step_x and not step_y:
            raise InstanceError(f"{path}: two waypoints or more were expected")
        self.spacing = ((step_x or step_y) + (step_y or step_x)) / 2
        self.width = max(self.columns.values()) + 1
        self.height = max(self.rows.values()) + 1
        self.origin = min(self.columns), min(self.rows)


def _by_number(name: str) -> tuple[bool, int, str]:
    return not name.isdecimal(), int(name) if name.isdecimal() else 0, name


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
