# SPDX-License-Identifier: Apache-2.0
"""The cells in which storage units stand."""

import itertools
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_layout.floor.floor_plan import FloorPlan

CROOKED = 0.05  # least offset from a cell's centre at which a unit can't be lifted [m]
ASKEW = 0.1  # [rad] from the axes, and more: nor there
UNIT_REACH = 0.48  # of a unit's sides, with room for a robot that turns beside it [m]
SEEN_LATE = 0.5  # largest lag of the reported states of units [s]


class UnitPoses(NamedTuple):
    """Where all storage units stood at a time; arrays (n,), in the frame world."""

    shelf_id: np.ndarray
    x: np.ndarray  # [m]
    y: np.ndarray  # [m]
    yaw: np.ndarray  # [rad]
    carried: np.ndarray  # bool
    stamp: float  # [s]


class Crooked(NamedTuple):
    """Where a unit stands across cells."""

    x: float  # [m]
    y: float  # [m]
    cells: frozenset[int]  # that it obstructs


class UnitMap:
    """The cell of each unit, `cell_of`: NOWHERE if it is carried, or stands across cells. `unit_in`
    holds those that stand, by cell; `stands`, (cells,) bool, marks those cells. `crooked`
    holds those that stand across cells, by unit."""

    def __init__(self, plan: FloorPlan) -> None:
        self.cell_of: dict[int, int] = {}
        self.unit_in: dict[int, int] = {}
        self.stands = np.zeros(plan.passable.size, bool)
        self._order = np.zeros(plan.passable.size, np.int64)  # in which units came to cells
        self._came = 0
        self.crooked: dict[int, Crooked] = {}
        # Cells with a unit, off the storage places: since when it has stood there without a
        # transport that brought it [s].
        self._streets: dict[int, float] = {}
        self._off_storage = ~np.asarray(plan.storage, bool).ravel()
        self._plan = plan
        self._put_down: dict[int, float] = {}  # when each unit was put down last [s]

    def locate(self, poses: UnitPoses) -> tuple[dict[int, int], set[int]]:
        """Returns ({unit: cell}, the cells that units which stand crooked obstruct)."""
        plan = self._plan
        cells = plan.cell_of(poses.x, poses.y)
        centre_x, centre_y = plan.point_of(cells)
        off = np.hypot(poses.x - centre_x, poses.y - centre_y)
        askew = abs(np.remainder(poses.yaw + np.pi / 4, np.pi / 2) - np.pi / 4)
        crooked = (off > CROOKED) | (askew > ASKEW)
        crooked &= ~poses.carried & (cells != NOWHERE)
        self.crooked = {}
        for unit in np.flatnonzero(crooked):
            x, y, yaw = poses.x[unit], poses.y[unit], poses.yaw[unit]
            half = UNIT_REACH * (abs(np.cos(yaw)) + abs(np.sin(yaw)))
            around = itertools.product((-half, 0, half), repeat=2)
            covers = frozenset(int(plan.cell_of(x + dx, y + dy)) for dx, dy in around)
            self.crooked[int(poses.shelf_id[unit])] = Crooked(float(x), float(y), covers)
        cells = np.where(poses.carried | crooked, NOWHERE, cells)
        obstructed = set().union(*(heap.cells for heap in self.crooked.values()))
        return dict(zip(poses.shelf_id.tolist(), cells.tolist())), obstructed

    def update(self, cells: dict[int, int], stamp: float, lifted: Iterable[int]) -> None:
        """Sets the cell of each unit, {unit: cell} as seen at `stamp` [s]. The cells of units that
        robots have `lifted`, or put down since then, are known better, and stay."""
        better = set(lifted)
        better |= {unit for unit, time in self._put_down.items() if time >= stamp - SEEN_LATE}
        kept = {unit: cell for unit, cell in self.cell_of.items() if unit in better & cells.keys()}
        self.cell_of = {**cells, **kept}
        self.unit_in = {cell: unit for unit, cell in self.cell_of.items() if cell != NOWHERE}
        standing = np.fromiter(self.unit_in, np.int64, len(self.unit_in))
        self.stands[:] = False
        self.stands[standing] = True
        self._order[standing], self._came = np.arange(len(standing)), len(standing)
        in_streets = standing[self._off_storage[standing]].tolist()
        self._streets = {cell: self._streets.get(cell, stamp) for cell in in_streets}

    def lift(self, unit: int) -> int:
        """Notes that a unit was lifted; returns the cell in which it stood."""
        cell = self.cell_of[unit]
        self.unit_in.pop(cell, None)
        self._streets.pop(cell, None)
        if cell != NOWHERE:
            self.stands[cell] = False
        self.cell_of[unit] = NOWHERE
        return cell

    def put_down(self, unit: int, cell: int, time: float) -> None:
        """Notes that a unit stands in a cell since `time` [s]."""
        self.cell_of[unit] = cell
        self.unit_in[cell] = unit
        self.stands[cell] = True
        self._came += 1
        self._order[cell] = self._came
        if self._off_storage[cell]:
            self._streets[cell] = np.inf  # it was to be brought there
        self._put_down[unit] = time

    def in_streets(self) -> list[int]:
        """Returns the cells in which units stand off the storage places."""
        return list(self._streets)

    def left_in_streets(self, before: float) -> list[int]:
        """Returns the cells, ascending, off the storage places in which units have stood since
        before that time [s] that no transport brought there."""
        return sorted(cell for cell, since in self._streets.items() if since < before)

    def first_in(self, cells: np.ndarray) -> int:
        """Returns that of some cells with units, (n,), to which its unit came first."""
        return int(cells[self._order[cells].argmin()])

    def is_in_reach(self, cell: int) -> bool:
        """Returns whether a robot can come to a unit's cell; NOWHERE counts as reachable."""
        return cell == NOWHERE or bool(self._plan.passable.flat[cell])

    def out_of_reach(self) -> list[int]:
        """Returns the units that no robot can come to, ascending."""
        return sorted(unit for unit, cell in self.cell_of.items() if not self.is_in_reach(cell))
