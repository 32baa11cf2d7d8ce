# SPDX-License-Identifier: Apache-2.0
"""Grid maps, `.map`: MovingAI's `type octile`, and those of the League of Robot Runners.

In the League's maps `E` is where tasks end (a station), and `S` is where goods are taken: cells
around blocks of shelves, which become storage places, or storage places themselves. Maps of games
have no `E`; there `S` is a swamp, which is floor here.
"""

import numpy as np

from warehouse_layout.convert.common import (
    MOST_CELLS,
    FormatError,
    PathName,
    cells_of,
    named,
    plural,
    station_entries,
    text_of,
    with_letters,
    write_text,
)
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile, rows_of

HEADER = ("type", "height", "width", "map")
STATION, SERVICE = "E", "S"
BLOCKED = "@T"
# What a map's characters are in a drawing; `W`, water, is passable from water alone.
MEANING = {".": ".", "G": ".", SERVICE: ".", STATION: ".", "@": "#", "T": "#", "O": " ", "W": "x"}

# What a drawing's characters are in a map; the others are floor.
WRITTEN = {lf.WALL: "@", lf.NO_FLOOR: "O", lf.BELT: "T", lf.KEEP_OUT: "T", lf.STORAGE: SERVICE}
LOST = {
    lf.BELT: ("conveyor belt", "obstacles"),
    lf.KEEP_OUT: ("keep-out area", "obstacles"),
    lf.PARKING: ("parking", "floor"),
    lf.CHARGING: ("charging places", "floor"),
}


def read(path: PathName) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a .map file, and what it can't hold. Raises FormatError."""
    notes: list[str] = []
    grid = _grid(path)
    floor = np.full(grid.shape, lf.FLOOR, "<U1")
    for character, drawn in MEANING.items():
        floor[grid == character] = drawn
    service, stations = grid == SERVICE, grid == STATION
    if stations.any():
        shelves = _enclosed(np.isin(grid, list(BLOCKED)), service, stations)
        floor[shelves if shelves.any() else service] = lf.STORAGE
    elif service.any():
        notes.append(f"{plural(int(service.sum()), 'cell')} of swamp 'S' became floor")
    if (grid == "W").any():
        notes.append(f"{plural(int((grid == 'W').sum()), 'cell')} of water 'W' became keep-out 'x'")
    places = cells_of(stations)
    names = [f"E{number}" for number in range(1, len(places) + 1)]
    file = LayoutFile(
        floor=floor,
        stations=station_entries(names, places, ["pick"] * len(places)),
        path="",
    )
    return with_letters(file), notes


def _grid(path: PathName) -> np.ndarray:
    """Returns the characters of a map, (h, w), row 0 the lowest. Raises FormatError."""
    lines = text_of(path).splitlines()
    height, width, first = _header(path, lines)
    rows = lines[first : first + height]
    if len(rows) < height:
        raise FormatError(f"{path}: {len(rows)} lines of map; height says {height}")
    for at, line in enumerate(rows, first + 1):
        if len(line.rstrip()) != width:
            raise FormatError(f"{path}:{at}: {len(line.rstrip())} cells; width says {width}")
    extra = [
        at for at, line in enumerate(lines[first + height :], first + height + 1) if line.strip()
    ]
    if extra:
        raise FormatError(f"{path}:{extra[0]}: a line after the map's {height}")
    grid = rows_of(line.rstrip() for line in rows)
    unknown = ~np.isin(grid, list(MEANING))
    if unknown.any():
        row, column = np.argwhere(unknown[::-1])[0].tolist()
        raise FormatError(
            f"{path}:{first + 1 + row}:{column + 1}: {rows[row][column]!r} is not a cell of a map;"
            f" known: {' '.join(MEANING)}"
        )
    return grid


def _header(path: PathName, lines: list[str]) -> tuple[int, int, int]:
    """Returns height, width and the index of the map's first line."""
    values: dict[str, str] = {}
    for at, line in enumerate(lines[:20]):
        key, _, value = line.strip().partition(" ")
        if key not in HEADER or key in values:
            raise FormatError(f"{path}:{at + 1}: '{line[:40]}'; {', '.join(HEADER)} were expected")
        values[key] = value.strip()
        if key == "map":
            return _size(path, values, "height"), _checked_width(path, values), at + 1
    raise FormatError(f"{path}:1: no map; lines with {', '.join(HEADER)} were expected")


def _checked_width(path: PathName, values: dict[str, str]) -> int:
    width = _size(path, values, "width")
    if width * _size(path, values, "height") > MOST_CELLS:
        raise FormatError(
            f"{path}: {width} x {values['height']} cells; {MOST_CELLS} at most were expected"
        )
    return width


def _size(path: PathName, values: dict[str, str], name: str) -> int:
    text = values.get(name, "")
    if not text.isascii() or not text.isdigit() or not 0 < len(text) < 8 or not int(text):
        raise FormatError(f"{path}: {name} is '{text[:20]}'; a whole number above 0 was expected")
    return int(text)


def _enclosed(blocked: np.ndarray, service: np.ndarray, stations: np.ndarray) -> np.ndarray:
    """Returns the blocks of obstacles that service cells surround: shelves, (h, w) bool."""
    from scipy import ndimage

    labels, count = ndimage.label(blocked)
    edge = np.ones_like(blocked)
    edge[1:-1, 1:-1] = False
    beside = {
        mask_name: np.unique(labels[mask])
        for mask_name, mask in (
            ("service", ndimage.binary_dilation(service) & blocked),
            ("wall", (ndimage.binary_dilation(stations) | edge) & blocked),
        )
    }
    chosen = np.isin(np.arange(count + 1), beside["service"])
    chosen &= ~np.isin(np.arange(count + 1), beside["wall"])
    chosen[0] = False
    return chosen[labels]


def write(file: LayoutFile, path: PathName) -> list[str]:
    """Writes a layout as a map; returns what that can't hold. Raises FormatError."""
    grid = np.full(file.floor.shape, ".", "<U1")
    for drawn, character in WRITTEN.items():
        grid[file.floor == drawn] = character
    for station in file.stations:
        column, row = station.service
        grid[row, column] = STATION
    height, width = grid.shape
    lines = [f"type octile\nheight {height}\nwidth {width}\nmap", *lf.lines_of(grid)]
    write_text(path, "\n".join(lines) + "\n")
    return list(_lost(file))


def _lost(file: LayoutFile) -> list[str]:
    floor = file.floor
    out = [
        f"{what} became {instead} at {named(cells)}"
        for character, (what, instead) in LOST.items()
        if (cells := cells_of(floor == character))
    ]
    ruled = cells_of(np.isin(floor, list(lf.ONE_WAY + lf.ALONG_X + lf.ALONG_Y)))
    out += [f"directions of streets are lost at {named(ruled)}"] if ruled else []
    out += [
        f"station {s.name}: its cell is an E; name, kind, lane and times are lost"
        for s in file.stations
    ]
    if file.spacing != 1:
        out.append(f"a map has no size: the spacing of {file.spacing:g} m is lost")
    if (floor == lf.STORAGE).any() and not file.stations:
        out.append("storage places are 'S', which a map without stations 'E' reads as swamp")
    held = [
        word
        for word, there in (
            ("robots", file.robots),
            ("storage units", file.storage_units),
            ("items", file.items or file.stock),
            ("policies", file.policies),
            ("measured", file.measured),
            ("building", file.building),
        )
        if there
    ]
    return [*out, f"a map holds none of: {', '.join(held)}"] if held else out
