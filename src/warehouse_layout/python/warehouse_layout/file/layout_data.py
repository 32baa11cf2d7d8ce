# SPDX-License-Identifier: Apache-2.0
"""What a layout file says, as data: a warehouse drawn with a character a cell.

A cell is (column, row): the column from the left, the row from the bottom, both from 0.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.floor.elevators import Elevator
from warehouse_layout.floor.stations import PICK, REPLENISH

SUFFIX = ".layout.yaml"

FLOOR, STORAGE, PARKING, CHARGING, KEEP_OUT = ".", "s", "p", "c", "x"
WALL, BELT, NO_FLOOR = "#", "=", " "
ONE_WAY = ">^<v"  # by heading: quarter turns from +x
ALONG_X, ALONG_Y = "-", "|"  # both ways along one axis
SERVICE = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
STREETS = FLOOR + ONE_WAY + ALONG_X + ALONG_Y
CHARACTERS = FLOOR + ONE_WAY + ALONG_X + ALONG_Y + STORAGE + PARKING + CHARGING
CHARACTERS += KEEP_OUT + WALL + BELT + NO_FLOOR + SERVICE

# Of stations, as a file names them; at "both" a shift replenishes besides, the floor is alike.
KINDS = {"pick": PICK, "replenish": REPLENISH, "both": PICK}

Cell = tuple[int, int]  # column, row


class LayoutFileError(ValueError):
    """Says what is wrong in a layout file, with its name, the line and the column."""


@dataclass(frozen=True)
class StationEntry:
    """A station as a layout file describes it."""

    key: str  # in `stations`; one letter marks the service cell in the drawing too
    service: Cell
    name: str
    kind: str = "pick"  # of KINDS
    queue: tuple[Cell, ...] = ()  # in driving order, the entry first
    exit: tuple[Cell, ...] = ()  # in driving order
    # Further steps on the way to the service cell: from a street, or a cell of the queue.
    short_cuts: tuple[tuple[Cell, Cell], ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)  # of its service: times, hours


@dataclass(frozen=True)
class ElevatorEntry:
    """An elevator as a layout file describes it."""

    name: str
    cells: tuple[Cell, ...]  # one a tier
    # From each of its cells to the next [s], or from each (row) to each (column).
    seconds: float | tuple[tuple[float, ...], ...]

    def of_plan(self, width: int) -> Elevator:
        """Returns the Elevator of a plan with a width [cells]."""
        cells = [row * width + column for column, row in self.cells]
        if isinstance(self.seconds, tuple):
            return Elevator(self.name, tuple(cells), self.seconds)
        return Elevator.evenly(self.name, cells, self.seconds)

    @classmethod
    def of_elevator(cls, elevator: Elevator, width: int) -> "ElevatorEntry":
        """Returns the entry for an Elevator of a plan with a width [cells]."""
        cells = tuple((cell % width, cell // width) for cell in elevator.cells)
        even = elevator.a_tier
        return cls(elevator.name, cells, elevator.seconds if even is None else even)


@dataclass(frozen=True, eq=False)
class LayoutFile:
    """What a layout file says. Nothing in it is checked beyond the format."""

    floor: np.ndarray  # (h, w) of one character each; row 0 is the lowest
    name: str = ""
    spacing: float = 1.0  # edge of a cell [m]
    stations: tuple[StationEntry, ...] = ()
    elevators: tuple[ElevatorEntry, ...] = ()  # between tiers, which lie side by side
    storage_units: float | int | tuple[Cell, ...] = 0.85  # a float: share of the storage places
    robots: int | tuple[Cell, ...] = 0
    items: int = 0
    stock: str = ""  # CSV file with columns sku,quantity,storage_unit; instead of items
    skus: str = ""  # CSV file of the SKUs in stock, see sku_master: what pieces weigh
    policies: Mapping[str, Any] = field(default_factory=dict)
    measured: str = ""  # realism file whose motion and pace of stations are the site's
    building: str = ""  # world file of the hall around it
    at: tuple[float, float] | None = None  # centre of cell (0, 0) in `world` [m]; None: centred
    path: str = ""  # from which it was read

    @property
    def shape(self) -> tuple[int, int]:
        """Cells along y and x."""
        height, width = self.floor.shape
        return height, width

    @property
    def title(self) -> str:
        """Its name, or that of its file."""
        return self.name or Path(self.path).name.removesuffix(SUFFIX) or "layout"

    def beside_file(self, name: str) -> Path:
        """Returns the path of a file that this one names: relative to its own folder."""
        return Path(self.path).parent / Path(name).expanduser()


def rows_of(lines: Iterable[str]) -> np.ndarray:
    """Returns the floor (h, w) of a drawing's lines; the first line is the highest row."""
    return np.array([list(line) for line in lines][::-1], "<U1")


def lines_of(floor: np.ndarray) -> list[str]:
    """Returns the lines of a drawing, the highest row first."""
    return ["".join(row) for row in floor[::-1].tolist()]
