# SPDX-License-Identifier: Apache-2.0
"""Checks that a fleet can work in the warehouse that a layout file describes."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from warehouse_layout._core import FloorError, layout_faults
from warehouse_layout.file import drawn_floor, station_lanes
from warehouse_layout.file.layout_file import KEEP_OUT, Cell, LayoutFile, LayoutFileError
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.landings import Landings
from warehouse_layout.floor.served_part import served_part, steps_text, with_ways_back
from warehouse_layout.place.placement import place, plan_of

NAMED = 6  # cells that a sentence names, at most
LEAST_SPACING = 0.97  # [m]: a unit that turns sweeps 0.566 m, and its neighbour reaches 0.4 m


@dataclass(frozen=True)
class Fault:
    """What is wrong and how to change it, with the cells (column, row) at which it shows.

    is_of_bodies: it hinders robots with bodies alone; ideal ones pass through each other.
    """

    text: str
    cells: tuple[Cell, ...] = ()
    is_of_bodies: bool = False


def faults(file: LayoutFile) -> list[Fault]:
    """Returns what hinders a fleet from working there; [] if nothing does."""
    drawn = drawn_floor.areas(file.floor)
    stations, lane_faults = station_lanes.of_file(file, drawn)
    plan = plan_of(file, drawn, stations)
    out = [
        *_spacing_faults(file),
        *(Fault(fault.text, fault.cells) for fault in lane_faults),
        *_floor_faults(file, plan),
    ]
    if not out:
        out += _landing_faults(file, plan)
    if not lane_faults:
        out += _placing_faults(file)
    return out


def remarks(file: LayoutFile) -> list[str]:
    """Returns sentences about what robots with bodies leave out where a fleet works all the same;
    [] if that is nothing."""
    drawn = drawn_floor.areas(file.floor)
    stations, _ = station_lanes.of_file(file, drawn)
    plan, steps = with_ways_back(plan_of(file, drawn, stations))
    places = [(_named(_cells([a], plan)), _named(_cells([b], plan))) for a, b in steps.tolist()]
    return [steps_text(steps, places)] if places else []


def _spacing_faults(file: LayoutFile) -> list[Fault]:
    if file.spacing >= LEAST_SPACING:
        return []
    return [
        Fault(
            f"spacing is {file.spacing:g} m; {LEAST_SPACING:g} m or more were expected: a storage"
            " unit that turns needs it beside another one. Write 'spacing: 1.0', or simulate"
            " without physics: ideal robots work there as it is",
            is_of_bodies=True,
        )
    ]


def _landing_faults(file: LayoutFile, plan: FloorPlan) -> list[Fault]:
    """Returns why robots with bodies could not come to the elevators, or past them; [] if they
    can."""
    try:
        Landings(plan).check()
    except FloorError as error:
        cells = tuple(cell for elevator in file.elevators for cell in elevator.cells)
        return [Fault(str(error), cells, is_of_bodies=True)]
    return []


def _placing_faults(file: LayoutFile) -> list[Fault]:
    try:
        place(file)
    except LayoutFileError as error:
        return [Fault(str(error).removeprefix(f"{file.path or file.title}: "))]
    return []


def lacks(file: LayoutFile) -> list[Fault]:
    """Returns what a floor needs besides, before a fleet has work there; [] if nothing."""
    layout = place(file)
    out = []
    if not len(layout.robots):
        out.append(Fault("there are no robots: draw parking 'p', and say how many in robots"))
    if not len(layout.units):
        text = "there are no storage units: draw places 's', and say how many in storage_units"
        out.append(Fault(text))
    return out


def _floor_faults(file: LayoutFile, plan: FloorPlan) -> list[Fault]:
    out = _elevator_faults(file, plan)
    driven, _ = with_ways_back(plan)
    for kind, cells in chain.from_iterable(map(layout_faults, driven.floors())):
        numbers = np.array(cells, int)
        if not len(numbers):
            out.append(Fault("there is no street for a loaded robot: draw '.', or arrows"))
        elif kind == "dead end":
            out.append(_pocket(file, plan) or _dead_end(numbers, plan))
        else:
            out += _cut_off(numbers, plan)
    return out


def _elevator_faults(file: LayoutFile, plan: FloorPlan) -> list[Fault]:
    """Returns a Fault for each elevator that joins no tiers, and for tiers that none joins."""
    out = []
    groups: list[set[int]] = []
    for entry, elevator in zip(file.elevators, plan.elevators):
        tiers = [int(tier) for tier in plan.tier.flat[list(elevator.cells)]]
        if len(set(tiers)) < len(tiers):
            text = (
                f"elevator {entry.name} has two cells on one tier, {_named(entry.cells)}: robots"
                " drive from one to the other; a tier is a part of the drawing by itself"
            )
            out.append(Fault(text, entry.cells))
        joined = [group for group in groups if group & set(tiers)]
        groups = [group for group in groups if group not in joined]
        groups.append(set(tiers).union(*joined))
    if len(groups) > 1:
        cells = tuple(entry.cells[0] for entry in file.elevators)
        text = (
            "elevators do not lead from each tier to each other one: give one of them a cell on"
            f" both; they begin at {_named(cells)}"
        )
        out.append(Fault(text, cells))
    return out


def _pocket(file: LayoutFile, plan: FloorPlan) -> Fault | None:
    """Returns a Fault for streets that lead nowhere, which can be closed; None where closing them
    would take places or stations away."""
    try:
        cells = served_part(plan)[1].cells
    except FloorError:
        return None
    floor = file.floor.copy()
    streets = plan.passable & ~plan.storage & ~plan.parking & ~plan.lane
    if not len(cells) or not streets.flat[cells].all():
        return None
    floor.flat[cells] = KEEP_OUT
    closed = plan_of(replace(file, floor=floor), drawn_floor.areas(floor), plan.stations)
    if any(map(layout_faults, closed.floors())):
        return None
    named = _cells(cells, plan)
    return Fault(
        f"loaded robots that meet at {_named(named)} can't pass each other, and no storage place or"
        f" station is served from there: draw 'x' in {'this cell' if len(named) == 1 else 'these'}",
        named,
        is_of_bodies=True,
    )


def _dead_end(edges: np.ndarray, plan: FloorPlan) -> Fault:
    cells = _cells(np.unique(edges), plan)
    return Fault(
        f"loaded robots that meet at {_named(cells)} can't pass each other: streets there lead"
        " neither round nor on; join them into a ring, make them one-way, or draw 'p' or 'x' where"
        " no loaded robot needs to go. Ideal robots, without physics, work there as it is",
        cells,
        is_of_bodies=True,
    )


def _cut_off(numbers: np.ndarray, plan: FloorPlan) -> list[Fault]:
    """Returns a Fault for the stations, the storage places and the streets that are cut off."""
    lane = np.isin(numbers, np.flatnonzero(plan.lane))
    names = [s.name for s in plan.stations if np.isin(s.cells, numbers).any()]
    groups = (
        (
            f"the station{'s' if len(names) > 1 else ''} {', '.join(names[:NAMED])}",
            lane,
            "begin and end the lane beside a street",
        ),
        ("storage places", plan.storage.flat[numbers], "draw a street beside each"),
        ("parking", plan.parking.flat[numbers], "draw a street beside it"),
    )
    out = []
    rest = np.ones(len(numbers), bool)
    for what, chosen, advice in groups:
        if chosen.any():
            cells = _cells(numbers[chosen], plan)
            text = f"a loaded robot can't come to {what} at {_named(cells)} and back: {advice}"
            out.append(Fault(text, cells))
        rest &= ~chosen
    if rest.any():
        cells = _cells(numbers[rest], plan)
        out.append(
            Fault(
                f"loaded robots can't get from the streets at {_named(cells)} to all others and"
                " back: turn an arrow, join the streets, or draw 'p' or 'x' there",
                cells,
            )
        )
    return out


def _cells(numbers: Iterable[int], plan: FloorPlan) -> tuple[Cell, ...]:
    return tuple((int(n) % plan.width, int(n) // plan.width) for n in numbers)


def _named(cells: Sequence[Cell]) -> str:
    more = len(cells) - NAMED
    text = ", ".join(f"[{column}, {row}]" for column, row in cells[:NAMED])
    return f"{text} and {more} more" if more > 0 else text
