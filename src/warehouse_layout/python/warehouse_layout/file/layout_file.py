# SPDX-License-Identifier: Apache-2.0
"""Layout files, `NAME.layout.yaml`: read and written.

file = layout_file.read("north.layout.yaml")
file.floor[2, 9]                    # 'v': column 9 of the third row from the bottom
layout_file.write(file, "south.layout.yaml")
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from warehouse_layout.file import user_file
from warehouse_layout.file.layout_data import (
    ALONG_X,
    ALONG_Y,
    BELT,
    CHARACTERS,
    CHARGING,
    FLOOR,
    KEEP_OUT,
    KINDS,
    NO_FLOOR,
    ONE_WAY,
    PARKING,
    SERVICE,
    STORAGE,
    SUFFIX,
    WALL,
    Cell,
    ElevatorEntry,
    LayoutFile,
    LayoutFileError,
    StationEntry,
    lines_of,
    rows_of,
)
from warehouse_layout.file.layout_reader import VERSION, LayoutReader
from warehouse_layout.file.station_settings import PACE

__all__ = [
    "ALONG_X",
    "ALONG_Y",
    "BELT",
    "CHARACTERS",
    "CHARGING",
    "FLOOR",
    "KEEP_OUT",
    "KINDS",
    "NO_FLOOR",
    "ONE_WAY",
    "PARKING",
    "SERVICE",
    "STORAGE",
    "SUFFIX",
    "VERSION",
    "WALL",
    "Cell",
    "ElevatorEntry",
    "LayoutFile",
    "LayoutFileError",
    "StationEntry",
    "lines_of",
    "parse",
    "read",
    "rows_of",
    "text_of",
    "write",
]


def read(path: str | Path) -> LayoutFile:
    """Reads a layout file. Raises LayoutFileError for one that can't be read or is wrong."""
    try:
        text = user_file.read_text(path)
    except OSError as error:
        raise LayoutFileError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise LayoutFileError(f"{path}: is not text in UTF-8") from error
    return parse(text, str(path))


def parse(text: str, path: str = "layout") -> LayoutFile:
    """Reads the text of a layout file; `path` names it in errors. Raises LayoutFileError."""
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
    # YAML takes the first line's leading spaces for indentation, unless a digit says how much.
    begin = "floor: |2" if lines[:1] and lines[0].startswith(" ") else "floor: |"
    out = [f"layout: {VERSION}"]
    out += [f"name: {_flow(file.name)}"] if file.name else []
    out += [f"spacing: {file.spacing:g}"]
    out += [f"building: {_flow(file.building)}"] if file.building else []
    out += [f"at: {_flow(list(file.at))}"] if file.at else []
    out += [begin, *(f"  {line}" for line in lines)]
    if file.stations:
        out += ["stations:", *(f"  {s.key}: {_flow(_entry(s, file.floor))}" for s in file.stations)]
    if file.elevators:
        out += ["elevators:", *map(_elevator, file.elevators)]
    out += [f"storage_units: {_flow(_places(file.storage_units))}"]
    out += [f"robots: {_flow(_places(file.robots))}"]
    out += [f"items: {_stock(file)}" if file.stock else f"items: {file.items}"]
    if file.policies:
        out += [yaml.safe_dump({"policies": dict(file.policies)}, sort_keys=False).rstrip()]
    out += [f"measured: {_flow(file.measured)}"] if file.measured else []
    return "\n".join(out) + "\n"


def _stock(file: LayoutFile) -> str:
    skus = f", skus: {_flow(file.skus)}" if file.skus else ""
    return f"{{stock: {_flow(file.stock)}{skus}}}"


def _entry(station: StationEntry, floor: np.ndarray) -> dict[str, Any]:
    column, row = station.service
    drawn = len(station.key) == 1 and floor[row, column] == station.key
    return {
        "name": station.name,
        "kind": station.kind,
        **({} if drawn else {"service": list(station.service)}),
        **({"queue": _places(station.queue)} if station.queue else {}),
        **({"exit": _places(station.exit)} if station.exit else {}),
        **(
            {"short_cuts": [_places(cut) for cut in station.short_cuts]}
            if station.short_cuts
            else {}
        ),
        **{name: _setting(name, value) for name, value in station.settings.items()},
    }


def _elevator(elevator: ElevatorEntry) -> str:
    seconds = elevator.seconds
    times = [list(row) for row in seconds] if isinstance(seconds, tuple) else seconds
    entry = {"cells": _places(elevator.cells), "seconds": times}
    return f"  {_flow(elevator.name)}: {_flow(entry)}"


def _setting(name: str, value: Any) -> Any:
    """Returns a setting of a station as the file has it."""
    if name == PACE and isinstance(value, tuple):
        return dict(zip(("mean", "sd"), value))
    return list(value) if name == "roster" else _places(value)


def _places(value: Any) -> Any:
    return [list(cell) for cell in value] if isinstance(value, tuple) else value


def _flow(value: Any) -> str:
    """Returns a value in a line, as people write YAML."""
    if isinstance(value, float) and value.is_integer():
        return f"{value:.1f}"  # a share of 1 is not a count of 1
    if isinstance(value, (int, float)):
        return json.dumps(value)
    text: str = yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=10**9)
    return text.removesuffix("\n").removesuffix("...").rstrip()
