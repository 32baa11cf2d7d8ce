# SPDX-License-Identifier: Apache-2.0
"""The floors of RWARE: by the numbers of shelf rows and columns, drawn as text, or, beyond RWARE,
of a layout file."""

from dataclasses import dataclass

import numpy as np

from warehouse_layout.file import drawn_floor, station_lanes
from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_layout.floor.stations import PICK
from warehouse_layout.generate import layout_choice
from warehouse_layout.place import placement

AISLE = 3  # a column of shelves is two cells wide, with a highway beside it


@dataclass(frozen=True)
class Layout:
    """highways: (height, width) uint8, 1 = a highway, 0 = a storage place; goals: (x, y) of each,
    in the order in which deliveries are counted; column_height: None for a drawn floor. walls:
    (height, width) uint8, 1 = where no agent can be; None: nowhere, as in RWARE."""

    highways: np.ndarray
    goals: list
    column_height: int | None = None
    walls: np.ndarray | None = None

    @property
    def grid_size(self) -> tuple[int, int]:
        """(height, width) in cells."""
        height, width = self.highways.shape
        return height, width


def of_parameters(shelf_columns: int, shelf_rows: int, column_height: int) -> Layout:
    """Returns the Layout with blocks of 2 x `column_height` shelves and two goals at the bottom.

    Raises ValueError if the numbers make no floor.
    """
    if shelf_columns % 2 != 1:
        raise ValueError(f"shelf_columns is {shelf_columns}; an odd number was expected")
    if min(shelf_columns, shelf_rows, column_height) < 1:
        raise ValueError("shelf_columns, shelf_rows and column_height: 1 or more was expected")
    height, width = (column_height + 1) * shelf_rows + 2, AISLE * shelf_columns + 1
    y, x = np.indices((height, width))
    middle = (x == width // 2 - 1) | (x == width // 2)
    queue = middle & (y > height - (column_height + 3))
    highways = (x % AISLE == 0) | (y % (column_height + 1) == 0) | (y == height - 1) | queue
    goals = [(width // 2 - 1, height - 1), (width // 2, height - 1)]
    return Layout(highways.astype(np.uint8), goals, column_height)


def of_text(text: str) -> Layout:
    """Returns the Layout that a text draws: a line a row, x = a shelf, g = a goal, . = a highway.

    Raises ValueError that names line and column.
    """
    lines = text.strip().replace(" ", "").split("\n")
    highways = np.zeros((len(lines), len(lines[0])), np.uint8)
    goals = []
    for y, line in enumerate(lines):
        if len(line) != len(lines[0]):
            raise ValueError(
                f"layout: line {y + 1} has {len(line)} cells; {len(lines[0])} were expected"
            )
        for x, cell in enumerate(line.lower()):
            if cell not in "gx.":
                raise ValueError(f"layout: line {y + 1}, cell {x + 1} is {cell!r}; x, g or . fits")
            highways[y, x] = cell != "x"
            if cell == "g":
                goals.append((x, y))
    if not goals:
        raise ValueError("layout: no goal (g) is drawn; one at least was expected")
    return Layout(highways, goals)


def of_file(name: str) -> Layout:
    """Returns the Layout of a layout file, NAME.layout.yaml: each storage place has a shelf, goals
    are where picking stations are served, all else that robots may enter is a highway, both ways.

    Raises LayoutFileError, a ValueError, for a file without storage or picking stations too.
    """
    file = layout_choice.chosen(name)
    drawn = drawn_floor.areas(file.floor)
    stations, faults = station_lanes.of_file(file, drawn)
    if faults:
        raise LayoutFileError(f"{name}: {faults[0].text}")
    plan = placement.plan_of(file, drawn, stations)
    served = [station.service_cell for station in plan.stations if station.kind == PICK]
    if not served or not plan.storage.any():
        raise LayoutFileError(f"{name}: storage places and a picking station were expected")
    height, width = plan.shape
    goals = [(cell % width, height - 1 - cell // width) for cell in served]
    # Row 0 is the lowest there, and the highest here.
    walls, storage = (~plan.passable)[::-1], plan.storage[::-1]
    return Layout((~storage).astype(np.uint8), goals, walls=walls.astype(np.uint8))
