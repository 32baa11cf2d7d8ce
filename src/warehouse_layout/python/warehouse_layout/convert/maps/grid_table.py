# SPDX-License-Identifier: Apache-2.0
"""Reads a floor from a grid in a spreadsheet, `.csv` or `.xlsx`: a cell of the table is one of the
floor.

In a cell stands a character as in a drawing of a layout file, or a word: wall, storage, parking,
charging, belt, keep out, station, replenish (and what dxf_layers.NAMES has beside these), up, down,
left, right. What else is written at a station is its name: `pick 3`. An empty cell is floor where a
wall or more table lies around it, else none.
"""

import csv
import io
import re

import numpy as np

from warehouse_layout.convert.common import (
    MOST_CELLS,
    FormatError,
    PathName,
    bytes_of,
    check_spacing,
    station_entries,
    text_of,
    trimmed,
    with_letters,
)
from warehouse_layout.convert.dxf.layers import NAMES, Layers
from warehouse_layout.convert.maps import xlsx
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile

DRAWN = {
    "walls": lf.WALL,
    "floor": lf.FLOOR,
    "streets": lf.FLOOR,
    "keep_out": lf.KEEP_OUT,
    "belts": lf.BELT,
    "storage": lf.STORAGE,
    "parking": lf.PARKING,
    "charging": lf.CHARGING,
    "robots": lf.PARKING,
}
STATIONS = {"stations": "pick", "replenish": "replenish"}
WORDS = {"right": ">", "up": "^", "left": "<", "down": "v", "→": ">", "↑": "^", "←": "<", "↓": "v"}
_PLAIN = frozenset(lf.CHARACTERS) - frozenset(lf.SERVICE)


def read(path: PathName, spacing: float | None = None) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a grid, `spacing` the edge of a cell [m], 1 m by default. Raises
    FormatError."""
    spacing = check_spacing(path, spacing)
    rows = _rows(path)
    height, width = len(rows), max(map(len, rows), default=0)
    if not height or not width or height * width > MOST_CELLS:
        raise FormatError(
            f"{path}: a table of {width} x {height} cells; 1 to {MOST_CELLS} were expected"
        )
    floor = np.full((height, width), lf.NO_FLOOR, "<U1")
    names, services, kinds = list[str](), list[tuple[int, int]](), list[str]()
    robots = 0
    for number, row in enumerate(rows):
        for column, text in enumerate(row):
            at = height - 1 - number, column
            character, kind = _meaning(path, number, column, text)
            floor[at] = character
            robots += kind == "robots"
            if kind in STATIONS:
                names.append(text.strip())
                services.append((at[1], at[0]))
                kinds.append(STATIONS[kind])
    floor[_enclosed(floor)] = lf.FLOOR
    if not (floor != lf.NO_FLOOR).any():
        raise FormatError(f"{path}: all cells are empty; characters or words were expected")
    stations = station_entries(names, services, kinds)
    file = LayoutFile(floor=floor, spacing=spacing, stations=stations, robots=robots)
    return with_letters(trimmed(file)), []


def _rows(path: PathName) -> list[list[str]]:
    """Returns the texts of the table, the highest row first."""
    if bytes_of(path)[:2] == b"PK":
        return xlsx.first_sheet(path)
    text = text_of(path)
    line = text.partition("\n")[0]
    separator = max("\t;,", key=line.count)
    if separator not in line:
        raise FormatError(f"{path}:1: no comma, semicolon or tab; a table was expected")
    rows = list(csv.reader(io.StringIO(text), delimiter=separator))
    while rows and not any(rows[-1]):
        rows.pop()
    return rows


def _meaning(path: PathName, row: int, column: int, text: str) -> tuple[str, str]:
    """Returns the character that a cell's text means, and its kind of dxf_layers.NAMES or ""."""
    word = text.strip()
    if word in _PLAIN or not word:
        return word or lf.NO_FLOOR, ""
    if word.lower() in WORDS:
        return WORDS[word.lower()], ""
    if len(word) == 1 and word in lf.SERVICE:
        return lf.FLOOR, "stations"
    layers = Layers(NAMES)
    kind = layers.kind(word) or layers.kind(re.sub(r"[\s_#-]*\d+$", "", word))
    if kind in STATIONS:
        return lf.FLOOR, kind
    if not kind:
        raise FormatError(
            f"{path}: {xlsx.address(row, column)}: '{word[:40]}' means nothing here; a character of"
            f" a layout ({' '.join(sorted(_PLAIN - {' '}))}) or a word was expected: wall, floor,"
            " storage, parking, charging, belt, keep out, station, replenish, up, down, left, right"
        )
    return DRAWN[kind], kind


def _enclosed(floor: np.ndarray) -> np.ndarray:
    """Returns the empty cells (h, w) bool that no way over empty cells joins with the edge."""
    from scipy import ndimage

    empty = np.pad(floor == lf.NO_FLOOR, 1, constant_values=True)
    labels, _ = ndimage.label(empty)
    return (empty & (labels != labels[0, 0]))[1:-1, 1:-1]
