# SPDX-License-Identifier: Apache-2.0
"""Layout files, `NAME.layout.yaml`: a warehouse drawn with a character a cell.

    file = layout_file.read("north.layout.yaml")
    file.floor[2, 9]                    # 'v': column 9 of the third row from the bottom
    layout_file.write(file, "south.layout.yaml")

A cell is (column, row): the column from the left, the row from the bottom, both from 0.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from warehouse_layout.stations import PICK, REPLENISH

VERSION = 1
SUFFIX = ".layout.yaml"

FLOOR, STORAGE, PARKING, CHARGING, KEEP_OUT = ".", "s", "p", "c", "x"
WALL, BELT, NO_FLOOR = "#", "=", " "
ONE_WAY = ">^<v"  # by heading: quarter turns from +x
ALONG_X, ALONG_Y = "-", "|"  # both ways along one axis
SERVICE = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
CHARACTERS = FLOOR + ONE_WAY + ALONG_X + ALONG_Y + STORAGE + PARKING + CHARGING
CHARACTERS += KEEP_OUT + WALL + BELT + NO_FLOOR + SERVICE

KINDS = {"pick": PICK, "replenish": REPLENISH}  # of stations, as a file names them

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
    settings: Mapping[str, Any] = field(default_factory=dict)  # of its service: times, hours


@dataclass(frozen=True, eq=False)
class LayoutFile:
    """What a layout file says. Nothing in it is checked beyond the format."""

    floor: np.ndarray  # (h, w) of one character each; row 0 is the lowest
    name: str = ""
    spacing: float = 1.0  # edge of a cell [m]
    stations: tuple[StationEntry, ...] = ()
    storage_units: float | int | tuple[Cell, ...] = 0.85  # a float: share of the storage places
    robots: int | tuple[Cell, ...] = 0
    items: int = 0
    stock: str = ""  # CSV file with columns sku,quantity,storage_unit; instead of items
    policies: Mapping[str, Any] = field(default_factory=dict)
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
    """Returns the floor (h, w) of a drawing's lines, of which the first is the highest row."""
    return np.array([list(line) for line in lines][::-1], "<U1")


def lines_of(floor: np.ndarray) -> list[str]:
    """Returns the lines of a drawing, the highest row first."""
    return ["".join(row) for row in floor[::-1].tolist()]


def read(path: str | Path) -> LayoutFile:
    """Reads a layout file. Raises LayoutFileError for one that can't be read or is wrong."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise LayoutFileError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise LayoutFileError(f"{path}: is no text in UTF-8") from error
    return parse(text, str(path))


def parse(text: str, path: str = "layout") -> LayoutFile:
    """Reads the text of a layout file; `path` names it in errors. Raises LayoutFileError."""
    from warehouse_layout.layout_reader import LayoutReader

    return LayoutReader(text, path).read()


def write(file: LayoutFile, path: str | Path) -> None:
    """Writes a layout file. Raises LayoutFileError where that is impossible."""
    try:
        Path(path).write_text(text_of(file), encoding="utf-8")
    except OSError as error:
        raise LayoutFileError(f"{path}: {error.strerror}") from error


def text_of(file: LayoutFile) -> str:
    """Returns the text of a layout file, which parse() reads as the same."""
    lines = lines_of(file.floor)
    # YAML takes the first line's leading spaces for indentation, unless it is told how much.
    begin = "floor: |2" if lines[:1] and lines[0].startswith(" ") else "floor: |"
    out = [f"layout: {VERSION}"]
    out += [f"name: {_flow(file.name)}"] if file.name else []
    out += [f"spacing: {file.spacing:g}"]
    out += [f"building: {_flow(file.building)}"] if file.building else []
    out += [f"at: {_flow(list(file.at))}"] if file.at else []
    out += [begin, *(f"  {line}" for line in lines)]
    if file.stations:
        out += ["stations:", *(f"  {s.key}: {_flow(_entry(s, file.floor))}" for s in file.stations)]
    out += [f"storage_units: {_flow(_places(file.storage_units))}"]
    out += [f"robots: {_flow(_places(file.robots))}"]
    out += [f"items: {{stock: {_flow(file.stock)}}}" if file.stock else f"items: {file.items}"]
    if file.policies:
        out += [yaml.safe_dump({"policies": dict(file.policies)}, sort_keys=False).rstrip()]
    return "\n".join(out) + "\n"


def _entry(station: StationEntry, floor: np.ndarray) -> dict[str, Any]:
    column, row = station.service
    drawn = len(station.key) == 1 and floor[row, column] == station.key
    return {
        "name": station.name,
        "kind": station.kind,
        **({} if drawn else {"service": list(station.service)}),
        **({"queue": _places(station.queue)} if station.queue else {}),
        **({"exit": _places(station.exit)} if station.exit else {}),
        **station.settings,
    }


def _places(value: Any) -> Any:
    return [list(cell) for cell in value] if isinstance(value, tuple) else value


def _flow(value: Any) -> str:
    """Returns a value in a line, as people write YAML."""
    if isinstance(value, float) and value.is_integer():
        return f"{value:.1f}"  # a share of 1 is no count of 1
    if isinstance(value, (int, float)):
        return json.dumps(value)
    text: str = yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=10**9)
    return text.removesuffix("\n").removesuffix("...").rstrip()
