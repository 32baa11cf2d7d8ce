# SPDX-License-Identifier: Apache-2.0
"""Reads RAWSim-O's footprints: the figures of a run in one line, values parted by semicolons.

A run's own `footprint.csv` has that line alone, with the 273 entries of RAWSim-O's version of 2025;
a collection of many runs begins with a line of the entries' names.
"""

from pathlib import Path
from typing import NamedTuple

# By our name of a figure: the entry, and its place in a line without a header.
FIGURES = {
    "pieces": ("ItemsHandled", 35),
    "orders": ("OrdersHandled", 37),
    "metres a robot": ("DistanceTraveledPerBot", 44),
    "bundles": ("BundlesHandled", 34),
    "picking visits": ("OverallPodsHandledAtOStations", 59),
    "replenishing visits": ("OverallPodsHandledAtIStations", 58),
}
KEYS = {
    "instance": ("Instance", 0),
    "settings": ("Setting", 1),
    "seconds": ("Duration", 14),
    "robots": ("NBots", 16),
}
ENTRIES = 273  # in a line without a header


class FootprintError(ValueError):
    """Raised for a file that is no footprint; names file and line."""


class Footprint(NamedTuple):
    """The figures of a run of RAWSim-O: `figures` has the order of FIGURES."""

    instance: str
    settings: str  # their Name
    robots: int
    seconds: float
    figures: tuple[float, ...]


def read(path):
    """Returns the Footprints of a file. Raises FootprintError, OSError."""
    lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    rows = [(i, line.split(";")) for i, line in enumerate(lines, 1) if line.strip()]
    if not rows:
        raise FootprintError(f"{path}: it is empty; a footprint of RAWSim-O was expected")
    columns = dict([*FIGURES.values(), *KEYS.values()])
    count = ENTRIES
    if rows[0][1][0] == "Instance":
        header, count = rows[0][1], len(rows[0][1])
        missing = [entry for entry in columns if entry not in header]
        if missing:
            raise FootprintError(f"{path}:1: there is no entry {missing[0]} in the header")
        columns = {entry: header.index(entry) for entry in columns}
        rows = rows[1:]
    return [_footprint(f"{path}:{number}", values, columns, count) for number, values in rows]


def _footprint(place, values, columns, count):
    if len(values) != count:
        raise FootprintError(f"{place}: {len(values)} entries, {count} were expected")

    def number(entry):
        text = values[columns[entry]]
        try:
            return float(text)
        except ValueError:
            raise FootprintError(f"{place}: {entry} is '{text}'; a number was expected") from None

    return Footprint(
        Path(values[columns["Instance"]]).stem,
        values[columns["Setting"]],
        int(number("NBots")),
        number("Duration"),
        tuple(number(entry) for entry, _ in FIGURES.values()),
    )
