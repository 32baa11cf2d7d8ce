# SPDX-License-Identifier: Apache-2.0
"""Reads the YAML of a layout file, and names line and column of what is wrong."""

import difflib
import math
from collections.abc import Collection, Iterator, Sequence
from typing import Any, NoReturn

import numpy as np
import yaml

from warehouse_layout.file import layout_data as lf
from warehouse_layout.file.layout_data import (
    Cell,
    ElevatorEntry,
    LayoutFile,
    LayoutFileError,
    StationEntry,
)
from warehouse_layout.file.request import LIMITS
from warehouse_layout.file.station_settings import SETTINGS, StationSettingError, check_setting

VERSION = 1
MOST_CELLS = 4_000_000
LEAST_SPACING, MOST_SPACING = 0.1, 10.0  # [m], as the world takes them
MOST_TIERS, MOST_RIDE = 100, 3600.0  # of an elevator; of one of its rides [s]

Node = Any  # of PyYAML, which has no types: a ScalarNode, SequenceNode or MappingNode

_KEYS = (
    "layout",
    "name",
    "spacing",
    "floor",
    "stations",
    "elevators",
    "storage_units",
    "robots",
    "items",
    "stock",
    "policies",
    "measured",
    "building",
    "at",
)
_STATION_KEYS = ("name", "kind", "service", "queue", "exit", "short_cuts", *SETTINGS)


class LayoutReader:
    """Reads one text; `path` names it in errors."""

    def __init__(self, text: str, path: str) -> None:
        self._text, self._path = text, path
        self._floor = np.zeros((0, 0), "<U1")
        self._lines: list[tuple[int, int]] = []  # line and column in the file of each row

    def read(self) -> LayoutFile:
        """Returns what the text says. Raises LayoutFileError."""
        top = self._mapping(self._composed(), _KEYS, "a layout file")
        self._version(top)
        if "floor" not in top:
            self._fail(None, "'floor' is missing: a drawing with a character a cell")
        self._read_floor(top["floor"])
        return LayoutFile(
            floor=self._floor,
            name=self._text_of(top.get("name"), "name", ""),
            spacing=self._spacing(top.get("spacing")),
            stations=self._stations(top.get("stations")),
            elevators=self._elevators(top.get("elevators")),
            storage_units=self._units(top.get("storage_units")),
            robots=self._robots(top.get("robots")),
            items=self._items(top),
            **self._stock(top),
            policies=self._policies(top.get("policies")),
            measured=self._text_of(top.get("measured"), "measured", ""),
            building=self._text_of(top.get("building"), "building", ""),
            at=self._at(top.get("at")),
            path=self._path,
        )

    # --- YAML

    def _composed(self) -> Node:
        try:
            node = yaml.compose(self._text, Loader=yaml.SafeLoader)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            self._fail_at(mark.line, mark.column, f"is not YAML: {error.problem or error.context}")
        except (yaml.YAMLError, RecursionError, ValueError) as error:
            self._fail(None, f"is not YAML: {' '.join(str(error).split())}")
        if node is None:
            self._fail(None, "is empty; a layout was expected")
        return node

    def _mapping(self, node: Node, keys: Collection[str], what: str) -> dict[str, Node]:
        """Returns the values of a mapping by its keys, all of which must be known."""
        out: dict[str, Node] = {}
        for key, value in self._pairs(node, what):
            if key.value not in keys:
                near = difflib.get_close_matches(str(key.value), keys, 1)
                hint = f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(keys)}"
                self._fail(key, f"'{key.value}' is not a key of {what}{hint}")
            if key.value in out:
                self._fail(key, f"'{key.value}' is there twice")
            out[key.value] = value
        return out

    def _pairs(self, node: Node, what: str) -> Iterator[tuple[Node, Node]]:
        if not isinstance(node, yaml.MappingNode):
            self._fail(node, f"{what}: keys with values were expected")
        yield from node.value

    def _value(self, node: Node) -> Any:
        """Returns a node's value in Python."""
        try:
            return yaml.constructor.SafeConstructor().construct_object(node, deep=True)
        except (yaml.YAMLError, RecursionError, ValueError, OverflowError) as error:
            problem = getattr(error, "problem", None) or error
            self._fail(node, f"can't be read: {problem}")

    def _number(self, node: Node, what: str, low: float, high: float) -> float:
        value = self._value(node)
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not is_number or not math.isfinite(value) or not low <= value <= high:
            self._fail(node, f"{what} is {value!r}; a number from {low:g} to {high:g} was expected")
        return value

    def _count(self, node: Node, what: str, most: int) -> int:
        value = self._value(node)
        if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= most:
            self._fail(node, f"{what} is {value!r}; a whole number from 0 to {most} was expected")
        return value

    def _text_of(self, node: Node | None, what: str, default: str) -> str:
        value = default if node is None else self._value(node)
        if isinstance(value, (dict, list)) or value is None:
            self._fail(node, f"{what}: a text was expected")
        return str(value)

    def _cell(self, node: Node, what: str) -> Cell:
        value = self._value(node)
        whole = isinstance(value, list) and len(value) == 2
        if not whole or any(not isinstance(v, int) or isinstance(v, bool) for v in value):
            self._fail(node, f"{what}: a cell [column, row] was expected, not {value!r}")
        column, row = value
        height, width = self._floor.shape
        if not (0 <= column < width and 0 <= row < height):
            self._fail(
                node,
                f"{what}: [{column}, {row}] is off the drawing of {width} x {height} cells:"
                " columns count from the left, rows from the bottom, both from 0",
            )
        return column, row

    def _cells(self, node: Node, what: str, most: int) -> tuple[Cell, ...]:
        if not isinstance(node, yaml.SequenceNode):
            self._fail(node, f"{what}: a list of cells [column, row] was expected")
        if len(node.value) > most:
            self._fail(node, f"{what}: {len(node.value)} cells; the limit is {most}")
        cells: dict[Cell, None] = {}
        for part in node.value:
            cell = self._cell(part, what)
            if cell in cells:
                self._fail(part, f"{what}: [{cell[0]}, {cell[1]}] is there twice")
            cells[cell] = None
        return tuple(cells)

    # --- the floor

    def _read_floor(self, node: Node) -> None:
        if not isinstance(node, yaml.ScalarNode):
            self._fail(node, "floor: a drawing, '|' with lines below it, was expected")
        lines = node.value.rstrip("\n").split("\n")
        self._lines = self._places_in_file(node, lines)
        width = len(lines[0])
        for line, (at, column) in zip(lines, self._lines):
            if len(line) != width:
                self._fail_at(
                    at,
                    column + min(len(line), width),
                    f"this line of the drawing has {len(line)} cells, the first has {width}",
                )
            for i, character in enumerate(line):
                if character not in lf.CHARACTERS:
                    known = " ".join(lf.CHARACTERS.replace(lf.NO_FLOOR, "").rstrip(lf.SERVICE))
                    self._fail_at(
                        at,
                        column + i,
                        f"{character!r} is not a cell of a drawing; known: {known}, space, A…Z",
                    )
        if not width or width * len(lines) > MOST_CELLS:
            self._fail(node, f"floor: 1 to {MOST_CELLS} cells were expected")
        self._floor = lf.rows_of(lines)

    def _places_in_file(self, node: Node, lines: list[str]) -> list[tuple[int, int]]:
        """Returns line and column, from 0, at which each line of the drawing begins."""
        first = node.start_mark.line
        if node.style == "|":
            first += 1
        source = self._text.split("\n")
        out = []
        for i, line in enumerate(lines):
            text = source[first + i] if first + i < len(source) else ""
            out.append((first + i, max(text.find(line), 0) if line.strip() else 0))
        indent = max((column for _, column in out), default=0)
        return [(at, column or indent) for at, column in out]

    # --- what stands on it

    def _version(self, top: dict[str, Node]) -> None:
        if "layout" not in top:
            self._fail(None, f"'layout: {VERSION}' is missing: the version of the format")
        if self._value(top["layout"]) != VERSION:
            version = self._value(top["layout"])
            self._fail(top["layout"], f"layout is {version!r}; this reads version {VERSION}")

    def _spacing(self, node: Node | None) -> float:
        return (
            1.0
            if node is None
            else float(self._number(node, "spacing", LEAST_SPACING, MOST_SPACING))
        )

    def _at(self, node: Node | None) -> tuple[float, float] | None:
        if node is None:
            return None
        if not isinstance(node, yaml.SequenceNode) or len(node.value) != 2:
            self._fail(node, "at: [x, y] in metres was expected")
        x, y = (float(self._number(part, "at", -1e5, 1e5)) for part in node.value)
        return x, y

    def _units(self, node: Node | None) -> float | int | tuple[Cell, ...]:
        if node is None:
            return 0.85
        if isinstance(node, yaml.SequenceNode):
            return self._cells(node, "storage_units", LIMITS["shelves"])
        value = self._value(node)
        if isinstance(value, float):
            return float(self._number(node, "storage_units (a share)", 0, 1))
        return self._count(node, "storage_units", LIMITS["shelves"])

    def _robots(self, node: Node | None) -> int | tuple[Cell, ...]:
        if node is None:
            return 0
        if isinstance(node, yaml.SequenceNode):
            return self._cells(node, "robots", LIMITS["robots"])
        return self._count(node, "robots", LIMITS["robots"])

    def _items(self, top: dict[str, Node]) -> int:
        node = top.get("items")
        if node is None or isinstance(node, yaml.MappingNode):
            return 0
        return self._count(node, "items", LIMITS["items"])

    def _stock(self, top: dict[str, Node]) -> dict[str, str]:
        """Returns the files of the stock, and of the SKUs in it."""
        node, stock, skus = top.get("items"), top.get("stock"), None
        if isinstance(node, yaml.MappingNode):
            if stock is not None:
                self._fail(stock, "stock stands within items already")
            files = self._mapping(node, ("stock", "skus"), "items")
            stock, skus = files.get("stock"), files.get("skus")
            if skus is not None and stock is None:
                self._fail(skus, "skus: `stock` was expected beside it, whose SKUs it describes")
        elif node is not None and stock is not None:
            self._fail(stock, "items are counted already: either a count or a stock file")
        return {
            "stock": self._text_of(stock, "stock", ""),
            "skus": self._text_of(skus, "skus", ""),
        }

    def _policies(self, node: Node | None) -> dict[str, Any]:
        value = {} if node is None else self._value(node)
        if not isinstance(value, dict):
            self._fail(node, "policies: names with values were expected")
        return value

    # --- stations

    def _stations(self, node: Node | None) -> tuple[StationEntry, ...]:
        drawn = self._drawn()
        out: list[StationEntry] = []
        for key, value in [] if node is None else self._pairs(node, "stations"):
            name = str(key.value)
            if name in {s.key for s in out}:
                self._fail(key, f"station '{name}' is there twice")
            out.append(self._station(key, value, drawn.pop(name, None)))
            if out[-1].name in {s.name for s in out[:-1]}:
                self._fail(value, f"two stations have the name '{out[-1].name}'")
        for letter, (column, row) in drawn.items():
            line, begin = self._lines[len(self._floor) - 1 - row]
            self._fail_at(
                line, begin + column, f"'{letter}' is drawn, but 'stations' has no '{letter}'"
            )
        return tuple(out)

    def _drawn(self) -> dict[str, Cell]:
        """Returns the service cells in the drawing by their letters."""
        out: dict[str, Cell] = {}
        for row, column in np.argwhere(np.isin(self._floor, list(lf.SERVICE))).tolist():
            letter = str(self._floor[row, column])
            if letter in out:
                line, begin = self._lines[len(self._floor) - 1 - row]
                self._fail_at(
                    line,
                    begin + column,
                    f"'{letter}' is drawn twice; a station has one service cell",
                )
            out[letter] = (column, row)
        return out

    def _station(self, key: Node, node: Node, drawn: Cell | None) -> StationEntry:
        label = f"station '{key.value}'"
        entry = self._mapping(node, _STATION_KEYS, "a station")
        service = self._cell(entry["service"], f"{label}: service") if "service" in entry else drawn
        if service is None:
            self._fail(key, f"{label} is not drawn; draw its letter or give service: [column, row]")
        if drawn and service != drawn:
            self._fail(entry["service"], f"{label} is drawn at [{drawn[0]}, {drawn[1]}]")
        kind = self._text_of(entry.get("kind"), f"{label}: kind", "pick")
        if kind not in lf.KINDS:
            self._fail(entry["kind"], f"{label}: kind is '{kind}'; known: {', '.join(lf.KINDS)}")
        queue = self._lane(entry, label, "queue")
        return StationEntry(
            key=str(key.value),
            service=service,
            name=self._station_name(entry.get("name"), str(key.value)),
            kind=kind,
            queue=queue,
            exit=self._lane(entry, label, "exit"),
            short_cuts=tuple(self._short_cuts(entry.get("short_cuts"), label, [*queue, service])),
            settings=self._settings(entry, label),
        )

    def _station_name(self, node: Node | None, key: str) -> str:
        name = self._text_of(node, "name", key)
        if not name or "/" in name or not name.isprintable() or len(name) > 60:
            self._fail(node, f"station name {name!r}: up to 60 characters without '/' expected")
        return name

    def _lane(self, entry: dict[str, Node], label: str, part: str) -> tuple[Cell, ...]:
        return self._cells(entry[part], f"{label}: {part}", 1000) if part in entry else ()

    def _short_cuts(
        self, node: Node | None, label: str, way: list[Cell]
    ) -> Iterator[tuple[Cell, Cell]]:
        """Yields steps that lead farther ahead on a way to a service cell: from a street beside it,
        or from one of its own cells."""
        what = f"{label}: short_cuts"
        if node is not None and not isinstance(node, yaml.SequenceNode):
            self._fail(node, f"{what}: a list of pairs of cells was expected")
        for part in node.value if node is not None else ():
            pair = self._cells(part, what, 2)
            if len(pair) != 2 or sum(abs(a - b) for a, b in zip(*pair)) != 1:
                self._fail(part, f"{what}: two cells [column, row] beside each other were expected")
            (column, row), end = pair
            at = way.index(pair[0]) if pair[0] in way else -1
            is_street = at >= 0 or str(self._floor[row, column]) in lf.STREETS
            if not is_street or end not in way[max(at + 2, 1) :]:
                self._fail(
                    part,
                    f"{what}: from [{column}, {row}] to [{end[0]}, {end[1]}]; from a street, or a"
                    " cell of the queue, to one farther ahead in it was expected",
                )
            yield pair[0], end

    def _settings(self, entry: dict[str, Node], label: str) -> dict[str, Any]:
        out = {}
        for name in SETTINGS:
            if name not in entry:
                continue
            try:
                out[name] = check_setting(name, self._value(entry[name]))
            except StationSettingError as error:
                self._fail(entry[name], f"{label}: {error}")
        return out

    # --- elevators

    def _elevators(self, node: Node | None) -> tuple[ElevatorEntry, ...]:
        out: list[ElevatorEntry] = []
        for key, value in [] if node is None else self._pairs(node, "elevators"):
            label = f"elevator '{key.value}'"
            if any(key.value == each.name for each in out):
                self._fail(key, f"{label} is there twice")
            entry = self._mapping(value, ("cells", "seconds"), "an elevator")
            for name in ("cells", "seconds"):
                if name not in entry:
                    self._fail(value, f"{label}: '{name}' is missing")
            cells = self._landings(entry["cells"], label, out)
            seconds = self._ride_times(entry["seconds"], label, len(cells))
            out.append(ElevatorEntry(str(key.value), cells, seconds))
        return tuple(out)

    def _landings(
        self, node: Node, label: str, others: Sequence[ElevatorEntry]
    ) -> tuple[Cell, ...]:
        """Returns the cells of an elevator: streets, and of no other one."""
        cells = self._cells(node, f"{label}: cells", MOST_TIERS)
        if len(cells) < 2:
            self._fail(node, f"{label}: a cell on each of two tiers or more was expected")
        for column, row in cells:
            character = str(self._floor[row, column])
            if character not in lf.STREETS:
                self._fail(node, f"{label}: [{column}, {row}] is {character!r}, not a street")
            if any((column, row) in other.cells for other in others):
                self._fail(node, f"{label}: [{column}, {row}] is a cell of another elevator")
        return cells

    def _ride_times(
        self, node: Node, label: str, count: int
    ) -> float | tuple[tuple[float, ...], ...]:
        """Returns the times of an elevator: one for each tier, or a table for all rides."""
        what = f"{label}: seconds"
        if not isinstance(node, yaml.SequenceNode):
            return float(self._number(node, what, 0, MOST_RIDE))
        rows = [row.value for row in node.value if isinstance(row, yaml.SequenceNode)]
        if len(rows) != len(node.value) or [len(row) for row in rows] != [count] * count:
            self._fail(node, f"{what}: a number, or a row of {count} for each cell was expected")
        return tuple(
            tuple(float(self._number(time, what, 0, MOST_RIDE)) for time in row) for row in rows
        )

    # --- errors

    def _fail(self, node: Node | None, text: str) -> NoReturn:
        if node is None:
            raise LayoutFileError(f"{self._path}: {text}")
        self._fail_at(node.start_mark.line, node.start_mark.column, text)

    def _fail_at(self, line: int, column: int, text: str) -> NoReturn:
        raise LayoutFileError(f"{self._path}:{line + 1}:{column + 1}: {text}")
