# SPDX-License-Identifier: Apache-2.0
"""The way of a robot from node to node, and the zones that it comes to.

Zones that the contour enters (6.4.1.1) are met by all that the robot sweeps: its length and width
along a stretch, and the circle around it where it turns. Zones of the kinematic centre (6.4.1.2)
are met by the middle of the robot alone.
"""

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from warehouse_vda5050.grid import Cell, Grid
from warehouse_vda5050.model import Factsheet
from warehouse_vda5050.zones.outline import Box, is_near, overlaps, passes
from warehouse_vda5050.zones.zone import Point, Zone, ZoneType

NEAR = 0.1  # a node within this is reached [m]
SQUARE = 0.1  # a heading within this of another needs no turn [rad]
PRECISION = 0.1  # how exactly a direction of travel is kept [rad]


@dataclass(frozen=True)
class Stretch:
    """A straight way to the next node. turns: whether the robot turns where it begins; length and
    width are the robot's, with its load [m]."""

    start: Point
    end: Point
    turns: bool
    length: float
    width: float

    @property
    def heading(self) -> float:
        """The direction of travel [rad]."""
        return math.atan2(self.end[1] - self.start[1], self.end[0] - self.start[0])

    def enters(self, zone: Zone) -> bool:
        """Returns whether the contour of the robot comes into a zone."""
        way = math.dist(self.start, self.end)
        x, y = (a + (b - a) / 2 for a, b in zip(self.start, self.end))
        swept = Box(x, y, self.heading, way + self.length, self.width)
        if overlaps(zone.vertices, swept):
            return True
        radius = math.hypot(self.length, self.width) / 2
        return self.turns and is_near(zone.vertices, self.start, radius)

    def is_forbidden(self, zone: Zone) -> bool:
        """Returns whether a zone keeps the robot off this way: no release opens it."""
        if zone.type is ZoneType.BLOCKED:
            return self.enters(zone)
        if zone.type not in (ZoneType.DIRECTED, ZoneType.BIDIRECTED) or zone.word == "SOFT":
            return False
        return self._is_against(zone) and passes(zone.vertices, self.start, self.end)

    def _is_against(self, zone: Zone) -> bool:
        off = abs(math.remainder(self.heading - zone.number, math.tau))
        if zone.type is ZoneType.BIDIRECTED:
            return min(off, math.pi - off) > PRECISION
        return off > (PRECISION if zone.word == "STRICT" else math.pi / 2 + PRECISION)


def size_of(sheet: Factsheet, is_loaded: bool) -> tuple[float, float]:
    """Returns length and width of the robot, with its load if it has any [m]."""
    length, width = sheet.load_size if is_loaded else (0.0, 0.0)
    return max(sheet.length, length), max(sheet.width, width)


def stretches(
    points: Sequence[Point], loaded: Iterable[bool], sheet: Factsheet, yaw: float | None
) -> Iterator[Stretch]:
    """Yields the stretches between points; loaded: whether there is a load on each. yaw: of the
    robot where it begins [rad], None: it does not turn there."""
    for (start, end), is_loaded in zip(itertools.pairwise(points), loaded):
        if math.dist(start, end) < NEAR:
            # What is left of the way has no direction, and the robot turns for none.
            yield Stretch(end, end, False, *size_of(sheet, is_loaded))
            continue
        heading = math.atan2(end[1] - start[1], end[0] - start[0])
        turns = yaw is not None and abs(math.remainder(heading - yaw, math.tau)) > SQUARE
        yield Stretch(start, end, turns, *size_of(sheet, is_loaded))
        yaw = heading


def points_of(cells: Iterable[Cell], grid: Grid) -> list[Point]:
    """Returns the middles of cells [m]."""
    return [grid.position(cell) for cell in cells]
