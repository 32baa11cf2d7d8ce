# SPDX-License-Identifier: Apache-2.0
"""The part of a floor that a fleet can serve; the rest is left out, and named.

In this part a loaded robot gets from each cell to each other.
"""

from collections.abc import Sequence, Sized
from dataclasses import dataclass, field, replace
from itertools import chain

import numpy as np

from warehouse_layout._core import FloorError, layout_faults
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import cell_steps

NAMED = 10  # places that are named in a sentence, at most
STEPS_NAMED = 6  # the same of steps
NO_STEPS = np.zeros((0, 2), int)


@dataclass(frozen=True, eq=False)
class LeftOut:
    """The cells and stations that a served part lacks of its floor; empty if it lacks none.

    steps: those between cells of the part, from cell to cell, from which a loaded robot could only
    come back the way that it went.
    """

    cells: np.ndarray  # (n,) int, ascending
    stations: tuple[str, ...] = ()  # names
    steps: np.ndarray = field(default_factory=lambda: NO_STEPS)  # (m, 2) int

    def text(
        self, plan: FloorPlan, units: Sequence[object] = (), robots: Sequence[int] = ()
    ) -> str:
        """Returns a sentence that names what is left out; "" if nothing is.

        `units` and `robots` are the ids of those on the cells that are left out.
        """
        if not len(self.cells):
            return ""
        x, y = plan.point_of(self.cells[:NAMED])
        places = ", ".join(f"({a:g}, {b:g})" for a, b in zip(x, y))
        cells = f"{len(self.cells)} cells and back: {_some(places, self.cells)}"
        parts = [f"loaded robots can't come to {cells}"]
        kinds: dict[str, Sequence[object]] = {
            "stations": self.stations,
            "storage units": units,
            "robots": [f"kiva{robot}" for robot in robots],
        }
        for what, names in kinds.items():
            if len(names):
                parts.append(f"{what} {_some(', '.join(map(str, names[:NAMED])), names)} are there")
        return "; ".join([*parts, "they are not used"])


def _some(text: str, names: Sized) -> str:
    more = len(names) - NAMED
    return f"{text} and {more} more" if more > 0 else text


def served_part(plan: FloorPlan) -> tuple[FloorPlan, LeftOut]:
    """Returns the largest part of a FloorPlan that passes its check, and what that leaves out.

    Raises FloorError if there is none.
    """
    passable, exits = plan.passable, plan.exits
    part = plan
    while faults := [*chain.from_iterable(map(layout_faults, part.floors()))]:
        passable, exits = passable.copy(), exits.copy()
        for kind, cells in faults:
            if not cells:
                plan.check(obstructed=False)
            if kind == "dead end":
                _cut(exits, np.array(cells).reshape(-1, 2), plan.width)
            else:
                passable.flat[cells] = False
        part = _without(part, passable, exits)
    if not part.passable.any():
        raise FloorError("there is no aisle for a loaded robot to drive on")
    names = {station.name for station in part.stations}
    gone = tuple(station.name for station in plan.stations if station.name not in names)
    return part, LeftOut(
        np.flatnonzero(plan.passable & ~part.passable), gone, _steps_gone(plan, part)
    )


def _steps_gone(plan: FloorPlan, part: FloorPlan) -> np.ndarray:
    """Returns the steps between cells of a part, (n, 2), that it lacks of its plan."""
    gone = np.where(part.passable, plan.exits & ~part.exits, 0)
    steps = [
        np.column_stack([cells, cells + step])
        for heading, step in enumerate(cell_steps(plan.width))
        for cells in [np.flatnonzero(gone >> heading & 1)]
    ]
    pairs = np.concatenate(steps)
    return pairs[part.passable.flat[pairs[:, 1]]]


def with_ways_back(plan: FloorPlan) -> tuple[FloorPlan, np.ndarray]:
    """Returns a FloorPlan without the steps from which a loaded robot could only come back the way
    that it went, and those, (n, 2) from cell to cell, if all of it is served without them; else the
    plan itself and none.
    """
    try:
        part, left_out = served_part(plan)
    except FloorError:
        return plan, NO_STEPS
    return (plan, NO_STEPS) if len(left_out.cells) else (part, left_out.steps)


def steps_text(steps: np.ndarray, places: Sequence[tuple[str, str]]) -> str:
    """Returns a sentence about steps that robots with bodies leave out; `places` names both ends of
    each, or of the first STEPS_NAMED."""
    named = ", ".join(f"{start} to {end}" for start, end in places[:STEPS_NAMED])
    more = f" and {len(steps) - STEPS_NAMED} more" if len(steps) > STEPS_NAMED else ""
    return (
        f"robots with bodies do not drive from {named}{more}: they could only come back the"
        " same way there, against others"
    )


def not_driven(plan: FloorPlan, steps: np.ndarray) -> str:
    """Returns a sentence about steps that robots with bodies leave out; "" if there are none."""
    points = np.column_stack(plan.point_of(steps[:STEPS_NAMED].ravel())).reshape(-1, 4)
    places = [(f"({a:g}, {b:g})", f"({c:g}, {d:g})") for a, b, c, d in points]
    return steps_text(steps, places) if places else ""


def _cut(exits: np.ndarray, edges: np.ndarray, width: int) -> None:
    """Removes the edges (n, 2), each from a cell to another one, from `exits`. Of a street that is
    one-way beyond a cell, only the way against that is among them: the street itself stays."""
    steps = cell_steps(width)
    for cell, after in edges.tolist():
        exits.flat[cell] &= ~np.uint8(1 << steps.index(after - cell))


def _without(plan: FloorPlan, passable: np.ndarray, exits: np.ndarray) -> FloorPlan:
    """Returns the plan restricted to passable cells; a station needs its whole lane."""
    stations = [s for s in plan.stations if passable.flat[s.cells].all()]
    for station in plan.stations:
        if station not in stations:
            passable.flat[station.cells] = False
    return replace(
        plan,
        passable=passable,
        storage=plan.storage & passable,
        parking=plan.parking & passable,
        obstructed=plan.obstructed & passable,
        exits=np.where(passable, exits, 0).astype(np.uint8),
        stations=tuple(stations),
        charging=np.asarray([c for c in plan.charging if passable.flat[c]], int),
    )
