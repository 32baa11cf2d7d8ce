# SPDX-License-Identifier: Apache-2.0
"""How elevators are painted on the floor: their cells, one a tier, with a label that says the rest.

elevator/NAME/10            10 s from each of its cells to the next one
elevator/NAME/0,14,11,0     from each cell to each other one, row by row [s]
"""

from collections.abc import Sequence

import numpy as np

from warehouse_layout._core import FloorError
from warehouse_layout.floor.elevators import Elevator

ELEVATOR = "elevator"  # the kind of these markings
_BEGIN = f"{ELEVATOR}/"


def is_label(label: str) -> bool:
    """Returns whether a label is that of an elevator's cells."""
    return label.startswith(_BEGIN)


def label_of(elevator: Elevator) -> str:
    """Returns the label of an elevator's cells."""
    even = elevator.a_tier
    times = [even] if even is not None else np.ravel(elevator.seconds).tolist()
    return f"{_BEGIN}{elevator.name}/{','.join(f'{time:.12g}' for time in times)}"


def elevator_of(label: str, cells: Sequence[int]) -> Elevator:
    """Returns the elevator of a label and its cells. Raises FloorError where they do not fit."""
    name, _, text = label.removeprefix(_BEGIN).rpartition("/")
    try:
        times = np.array([float(time) for time in text.split(",")])
    except ValueError:
        times = np.zeros(0)
    count = len(cells)
    are_times = bool((np.isfinite(times) & (times >= 0)).all())
    if count < 2 or len(times) not in (1, count**2) or not are_times:
        raise FloorError(
            f"floor marking '{label}' on {count} cells: elevator/NAME/ with the seconds from each"
            " of two cells or more to the next one, or from each to each, was expected"
        )
    if len(times) == 1:
        return Elevator.evenly(name, cells, float(times[0]))
    seconds = tuple(tuple(row) for row in times.reshape(count, count).tolist())
    return Elevator(name, tuple(cells), seconds)
