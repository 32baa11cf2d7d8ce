# SPDX-License-Identifier: Apache-2.0
"""What the readers and writers of all formats share: errors, texts, and stations in a drawing."""

import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file import user_file
from warehouse_layout.file.layout_file import Cell, LayoutFile, StationEntry
from warehouse_layout.file.layout_reader import LEAST_SPACING, MOST_SPACING
from warehouse_layout.file.request import LIMITS
from warehouse_layout.floor.stations import Station

PathName = str | os.PathLike[str]

MOST_CELLS = 4_000_000  # of a floor, as a layout file takes them
NAMED = 6  # cells that a sentence names, at most


class FormatError(ValueError):
    """Says what can't be read or written, with the file and the place in it."""


class Note(str):
    """A sentence about how a file was read, which is no loss."""


def text_of(path: PathName) -> str:
    """Returns the text of a file in UTF-8. Raises FormatError."""
    try:
        return user_file.read_text(path, "utf-8-sig")
    except OSError as error:
        raise FormatError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise FormatError(f"{path}: byte {error.start} is not text in UTF-8") from error


def bytes_of(path: PathName) -> bytes:
    """Returns the content of a file. Raises FormatError."""
    try:
        return user_file.read_bytes(path)
    except OSError as error:
        raise FormatError(f"{path}: {error.strerror}") from error


def write_text(path: PathName, text: str) -> None:
    """Writes a file in UTF-8. Raises FormatError."""
    try:
        Path(path).write_text(text, encoding="utf-8")
    except OSError as error:
        raise FormatError(f"{path}: {error.strerror}") from error


def check_size(path: PathName, what: str, height: int, width: int) -> None:
    """Raises FormatError unless a floor has 1 to MOST_CELLS cells."""
    if height < 1 or width < 1 or height * width > MOST_CELLS:
        raise FormatError(
            f"{path}: {what} of {width} x {height} cells; 1 to {MOST_CELLS} cells were expected"
        )


def check_spacing(path: PathName, spacing: float | None) -> float:
    """Returns the edge of a cell [m], 1 m for None. Raises FormatError."""
    spacing = 1.0 if spacing is None else spacing
    if not LEAST_SPACING <= spacing <= MOST_SPACING:
        raise FormatError(
            f"{path}: spacing is {spacing:g}; {LEAST_SPACING} to {MOST_SPACING:g} m were expected"
        )
    return spacing


def cells_of(mask: np.ndarray) -> list[Cell]:
    """Returns the cells (column, row) of a mask (h, w) bool, row by row."""
    return [(column, row) for row, column in np.argwhere(mask).tolist()]


def named(cells: Sequence[Cell]) -> str:
    """Returns the first cells as a sentence names them, and how many more there are."""
    text = ", ".join(f"[{column}, {row}]" for column, row in cells[:NAMED])
    more = len(cells) - NAMED
    return f"{text} and {more} more" if more > 0 else text


def plural(count: int, noun: str) -> str:
    """Returns a count with its noun: '1 cell', '2 cells'."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def within_limits(file: LayoutFile, notes: list[str]) -> tuple[LayoutFile, list[str]]:
    """Returns the file cut to a layout file's limits, and sentences about what was left out."""
    notes = list(notes)
    counts: dict[str, Any] = {}
    for name, most in (
        ("robots", LIMITS["robots"]),
        ("storage_units", LIMITS["shelves"]),
        ("items", LIMITS["items"]),
    ):
        value = getattr(file, name)
        count = len(value) if isinstance(value, tuple) else value
        if count > most:
            notes.append(f"{count} {name.replace('_', ' ')}; a layout has {most} at most")
            counts[name] = value[:most] if isinstance(value, tuple) else most
    name = " ".join("".join(c if c.isprintable() else " " for c in file.name).split())[:60]
    return replace(file, name=name, **counts), notes


def trimmed(file: LayoutFile) -> LayoutFile:
    """Returns the file without rows and columns at its edges that are no floor.

    Its stations have no lanes yet.
    """
    rows, columns = (np.flatnonzero((file.floor != lf.NO_FLOOR).any(axis=a)) for a in (1, 0))
    first, left = int(rows[0]), int(columns[0])

    def moved(cell: Cell) -> Cell:
        return cell[0] - left, cell[1] - first

    at = file.at and (
        round(file.at[0] + left * file.spacing, 6),
        round(file.at[1] + first * file.spacing, 6),
    )
    return replace(
        file,
        at=at,
        floor=file.floor[first : rows[-1] + 1, left : columns[-1] + 1],
        stations=tuple(replace(s, service=moved(s.service)) for s in file.stations),
        robots=tuple(map(moved, file.robots)) if isinstance(file.robots, tuple) else file.robots,
    )


def on_grid(corner: np.ndarray, spacing: float) -> tuple[float, float] | None:
    """Returns where cell (0, 0) lies [m], if that is on the grid points of a world; else None."""
    whole = np.round(corner / spacing)
    if np.abs(corner / spacing - whole).max() > 1e-6:
        return None
    x, y = np.round(whole * spacing, 6).tolist()
    return x, y


def with_letters(file: LayoutFile) -> LayoutFile:
    """Returns the file with its service cells drawn as letters, if there are enough of them."""
    if len(file.stations) > len(lf.SERVICE):
        return file
    floor = file.floor.copy()
    stations = []
    for letter, station in zip(lf.SERVICE, file.stations):
        column, row = station.service
        floor[row, column] = letter
        stations.append(replace(station, key=letter))
    return replace(file, floor=floor, stations=tuple(stations))


def cells_of_short_cuts(station: Station, width: int) -> tuple[tuple[Cell, Cell], ...]:
    """Returns the short cuts of a plan's station as a layout file has them. width: of the plan."""
    pairs = ([divmod(cell, width)[::-1] for cell in cut] for cut in station.short_cuts)
    return tuple((a, b) for a, b in pairs)


def without_twins(names: Iterable[str]) -> list[str]:
    """Returns names that are distinct: later ones get a number, and none has more than a line."""
    out: dict[str, None] = {}
    for name in names:
        clean = "".join(c if c.isprintable() and c != "/" else " " for c in name).strip()[:50]
        base, number = clean or "station", 2
        unique = base
        while unique in out:
            unique, number = f"{base} {number}", number + 1
        out[unique] = None
    return list(out)


def station_entries(
    names: Iterable[str], services: Iterable[Cell], kinds: Iterable[str]
) -> tuple[StationEntry, ...]:
    """Returns stations without lanes, with distinct names."""
    return tuple(
        StationEntry(key=name, service=service, name=name, kind=kind)
        for name, service, kind in zip(without_twins(names), services, kinds)
    )
