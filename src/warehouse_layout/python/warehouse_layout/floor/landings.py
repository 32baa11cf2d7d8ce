# SPDX-License-Identifier: Apache-2.0
"""The cells before elevators, where robots with bodies wait for them."""

from collections import deque
from collections.abc import Iterator
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from warehouse_layout._core import FloorError, layout_faults
from warehouse_layout.floor.floor_edges import FloorEdges

if TYPE_CHECKING:
    from warehouse_layout.floor.floor_plan import FloorPlan


class Landings:
    """The landings of a FloorPlan's elevators, which are their cells, and the ways to them.

    approach: by landing, the cells from which a robot can only go on to it, and how many cells it
    has to go; they are the elevator's queue. gates: by landing, the cells beside it from which
    robots enter it. departure: by landing, the cells to which a robot comes only from it. lane:
    (h, w) bool, all of these, where only robots drive that ride.
    """

    def __init__(self, plan: "FloorPlan") -> None:
        self._plan = plan
        streets = plan.passable & ~plan.storage & ~plan.parking & ~plan.lane
        self._is_street = streets.ravel()
        self.cells = [cell for elevator in plan.elevators for cell in elevator.cells]
        self.approach = {cell: self._approach(cell) for cell in self.cells}
        self.gates = {cell: self._gates(cell) for cell in self.cells}
        self.departure = {cell: self._departure(cell) for cell in self.cells}
        self.lane = np.zeros(plan.shape, bool)
        self.lane.flat[self.cells] = True
        for cells in (*self.approach.values(), *self.departure.values()):
            self.lane.flat[list(cells)] = True

    @cached_property
    def _edges(self) -> FloorEdges:
        """The edges of the floor, which only elevators ask for."""
        return FloorEdges(self._plan.floor())

    @cached_property
    def _ahead(self) -> np.ndarray:
        return self._edges.ahead(True)

    def _before(self, cell: int) -> list[int]:
        """Returns the street cells from which a robot drives to a cell."""
        before = self._edges.before(cell, True)
        return before[self._is_street[before]].tolist()

    def _approach(self, landing: int) -> dict[int, int]:
        steps = {landing: 0}
        queue = deque([landing])
        while queue:
            cell = queue.popleft()
            for before in self._before(cell):
                ways = set(self._ahead[before][self._ahead[before] >= 0].tolist())
                if before not in steps and before not in self.cells and ways <= steps.keys():
                    steps[before] = steps[cell] + 1
                    queue.append(before)
        del steps[landing]
        return steps

    def _departure(self, landing: int) -> list[int]:
        out: list[int] = []
        known = {landing}
        queue = deque([landing])
        while queue:
            for cell in self._ahead[queue.popleft()].tolist():
                if cell < 0 or cell in known or not self._is_street[cell] or cell in self.cells:
                    continue
                if set(self._edges.before(cell, True).tolist()) <= known:
                    known.add(cell)
                    out.append(cell)
                    queue.append(cell)
        return out

    def _gates(self, landing: int) -> list[int]:
        """Returns the cells before a landing: those of its queue, if it has one."""
        before, approach = self._before(landing), self.approach[landing]
        return [cell for cell in before if cell in approach] or before

    def check(self) -> None:
        """Raises FloorError where robots could not come to an elevator, or past it; a floor without
        elevators is right."""
        if not self.cells:
            return
        plan = self._plan
        for elevator in plan.elevators:
            for cell in elevator.cells:
                if not self.gates[cell]:
                    raise FloorError(f"no street leads to {self._named(elevator.name, cell)}")
        if faults := list(self._faults()):
            cells = sorted({*chain(*faults)})[:10]
            places = ", ".join(f"({x:g}, {y:g})" for x, y in zip(*plan.point_of(np.array(cells))))
            raise FloorError(
                "robots with bodies don't drive through an elevator that they do not ride, and"
                f" have no other way there and back: {places}; draw a street past the elevator"
            )

    def _faults(self) -> Iterator[list[int]]:
        """Yields the cells of each fault that the floor has because of its landings."""
        plan = self._plan
        known = [*chain.from_iterable(map(layout_faults, plan.floors()))]
        for tier in range(plan.tier.max(initial=0) + 1):
            floor = plan.floor(plan.passable & (plan.tier == tier), plan.lane | self.lane)
            for fault in layout_faults(floor):
                if fault not in known and len(fault[1]):
                    yield list(fault[1])

    def _named(self, name: str, cell: int) -> str:
        x, y = self._plan.point_of(cell)
        return f"elevator {name} at ({x:g}, {y:g})"
