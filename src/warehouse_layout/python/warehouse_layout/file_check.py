# SPDX-License-Identifier: Apache-2.0
"""Checks that a fleet can work in the warehouse that a layout file describes."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from warehouse_layout import drawn_floor, station_lanes
from warehouse_layout._core import layout_faults
from warehouse_layout.floor_plan import FloorPlan
from warehouse_layout.layout_file import Cell, LayoutFile, LayoutFileError
from warehouse_layout.placement import place, plan_of

NAMED = 6  # cells that a sentence names, at most
LEAST_SPACING = 0.97  # [m]: a unit that turns sweeps 0.566 m, and its neighbour reaches 0.4 m


@dataclass(frozen=True)
class Fault:
    """What is wrong and how to change it, with the cells (column, row) at which it shows."""

    text: str
    cells: tuple[Cell, ...] = ()


def faults(file: LayoutFile) -> list[Fault]:
    """Returns what hinders a fleet from working there; [] if nothing does."""
    drawn = drawn_floor.areas(file.floor)
    stations, lane_faults = station_lanes.of_file(file, drawn)
    out = [*_spacing_faults(file), *(Fault(fault.text, fault.cells) for fault in lane_faults)]
    out += _floor_faults(plan_of(file, drawn, stations))
    if not lane_faults:
        out += _placing_faults(file)
    return out


def _spacing_faults(file: LayoutFile) -> list[Fault]:
    if file.spacing >= LEAST_SPACING:
        return []
    return [
        Fault(
            f"spacing is {file.spacing:g} m; {LEAST_SPACING:g} m or more were expected: a storage"
            " unit that turns needs it beside another one"
        )
    ]


def _placing_faults(file: LayoutFile) -> list[Fault]:
    try:
        place(file)
    except LayoutFileError as error:
        return [Fault(str(error).removeprefix(f"{file.path or file.title}: "))]
    return []


def _floor_faults(plan: FloorPlan) -> list[Fault]:
    out = []
    for kind, cells in layout_faults(plan.floor()):
        numbers = np.array(cells, int)
        if not len(numbers):
            out.append(Fault("there is no street for a loaded robot: draw '.', or arrows"))
        elif kind == "dead end":
            out.append(_dead_end(numbers, plan))
        else:
            out += _cut_off(numbers, plan)
    return out


def _dead_end(edges: np.ndarray, plan: FloorPlan) -> Fault:
    cells = _cells(np.unique(edges), plan)
    return Fault(
        f"loaded robots that meet at {_named(cells)} can't pass each other: streets there lead"
        " neither round nor on; join them into a ring, make them one-way, or draw 'p' or 'x' where"
        " no loaded robot needs to go",
        cells,
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
