# SPDX-License-Identifier: Apache-2.0
"""The cells by which loaded robots come to stations and leave them."""

from collections.abc import Set as AbstractSet
from typing import NamedTuple

import numpy as np

from warehouse_layout.floor.floor_plan import FloorPlan, Station
from warehouse_layout.floor.stations import STEPS


class Ways(NamedTuple):
    """The cells from which a station's lane is entered, those of the lane, those that follow."""

    before: frozenset[int]
    lane: frozenset[int]
    after: frozenset[int]

    def are_barred(self, cells: AbstractSet[int]) -> bool:
        """Returns whether obstacles in some cells close the way in, through or out."""
        return bool(self.barring(cells))

    def barring(self, cells: AbstractSet[int]) -> AbstractSet[int]:
        """Returns those of some cells with obstacles that close the way in, through or out; empty
        if it is open."""
        if in_lane := self.lane & cells:
            return in_lane
        return next((way for way in (self.before, self.after) if way <= cells), frozenset())


class StationWays:
    """The Ways of all stations of a FloorPlan."""

    def __init__(self, plan: FloorPlan) -> None:
        self._of = {station.name: _ways(plan, station) for station in plan.stations}
        self._goals = {s.name: int(s.cells[s.service]) for s in plan.stations}  # service cells

    def are_barred(self, station: str, cells: AbstractSet[int]) -> bool:
        """Returns whether obstacles in some cells keep robots from a station, or there."""
        return bool(cells) and station in self._of and self._of[station].are_barred(cells)

    def bars(self, station: str, cells: AbstractSet[int]) -> AbstractSet[int]:
        """Returns those of some cells with obstacles that keep robots from a station, or there."""
        return self._of[station].barring(cells) if station in self._of else frozenset()

    def barring(self, cells: AbstractSet[int]) -> dict[int, int]:
        """Returns {service cell: one of some cells with obstacles that bars the way there}, of the
        stations to which or from which no way is open."""
        barred = {self._goals[name]: ways.barring(cells) for name, ways in self._of.items()}
        return {goal: min(by) for goal, by in barred.items() if by}


def _ways(plan: FloorPlan, station: Station) -> Ways:
    lane = frozenset(station.cells.tolist())
    first, last = int(station.cells[0]), int(station.cells[-1])
    beside = set(plan.beside([first]).tolist()) - lane
    before = {cell for cell in beside if first in _ahead(plan, cell)}
    before |= {cell for cell, _ in station.short_cuts if cell not in lane}
    return Ways(frozenset(before), lane, frozenset(_ahead(plan, last)))


def short_cuts(plan: FloorPlan) -> tuple[np.ndarray, np.ndarray]:
    """Returns (ends, goals), (cells,) each: the cell to which a short cut leads from each cell, and
    the service cell ahead; -1 without one."""
    ends, goals = np.full((2, plan.passable.size), -1, np.int32)
    for station in plan.stations:
        for cell, end in station.short_cuts:
            ends[cell], goals[cell] = end, station.service_cell
    return ends, goals


def _ahead(plan: FloorPlan, cell: int) -> list[int]:
    """Returns the cells to which the exits of one lead."""
    y, x = divmod(cell, plan.width)
    return [
        (y + dy) * plan.width + x + dx
        for heading, (dx, dy) in enumerate(STEPS)
        if plan.exits.flat[cell] >> heading & 1
    ]
