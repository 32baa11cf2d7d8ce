# SPDX-License-Identifier: Apache-2.0
"""Lays a graph of nodes and edges on the cells of a floor."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from warehouse_layout.convert import arrows, straight
from warehouse_layout.convert.common import (
    PathName,
    check_size,
    named,
    on_grid,
    station_entries,
    with_letters,
)
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import Cell, LayoutFile, StationEntry
from warehouse_layout.file.layout_reader import LEAST_SPACING, MOST_SPACING
from warehouse_layout.floor.floor_plan import ALL_EXITS, FloorPlan
from warehouse_layout.floor.stations import STEPS

AGREE = 0.95  # least share of nodes that lie on a grid
OFF = 0.25  # cells that a node may be off the middle of its own, without a word
LONGEST = 50  # cells of a lane
LONG = 2.0  # edges from this length on are several cells [m]
DRAWN = {"storage": lf.STORAGE, "parking": lf.PARKING, "charging": lf.CHARGING}


@dataclass
class Node:
    """A node at x, y [m]; its kind is one of DRAWN, or "" for a street."""

    x: float
    y: float
    kind: str = ""


@dataclass(frozen=True)
class Edge:
    """An edge between two nodes, one way."""

    name: str
    start: str
    end: str
    loaded: bool = True  # whether a loaded robot may take it


@dataclass
class Graph:
    """Nodes by name, edges, and stations: name, kind, node."""

    nodes: dict[str, Node] = field(default_factory=dict)
    edges: list[Edge] = field(default_factory=list)
    stations: list[tuple[str, str, str]] = field(default_factory=list)


def floor_of(path: PathName, graph: Graph, name: str) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a graph, and what cells can't say. Raises FormatError."""
    return _Floor(path, graph).layout(name)


class _Floor:
    def __init__(self, path: PathName, graph: Graph) -> None:
        self._graph, self._notes = graph, list[str]()
        at = np.array([(n.x, n.y) for n in graph.nodes.values()])
        self._spacing = self._found_spacing(at)
        phase = np.array([straight.phase_of_centres(v, self._spacing)[0] for v in at.T])
        cells = np.floor((at - phase) / self._spacing + 1e-6)
        low = cells.min(axis=0)
        self._corner = phase + (low + 0.5) * self._spacing  # centre of cell (0, 0)
        width, height = (cells.max(axis=0) - low + 1).astype(int).tolist()
        check_size(path, "a floor", height, width)
        self._cells: dict[str, Cell] = dict(
            zip(graph.nodes, map(tuple, (cells - low).astype(int).tolist()))
        )
        self._note_snapped(at)
        self._exits = np.zeros((height, width), np.uint8)
        self._passable = np.zeros((height, width), bool)

    def layout(self, name: str) -> tuple[LayoutFile, list[str]]:
        floor = np.full(self._exits.shape, lf.NO_FLOOR, "<U1")
        for edge in self._graph.edges:
            self._drive(edge)
        for cell in self._cells.values():
            self._passable[cell[::-1]] = True
        floor[self._passable] = lf.FLOOR
        for number, node in self._graph.nodes.items():
            if node.kind:
                floor[self._cells[number][::-1]] = DRAWN[node.kind]
        entries = self._entries(floor)
        floor = self._with_arrows(floor, entries)
        file = LayoutFile(
            floor=floor,
            name=name[:60],
            spacing=round(self._spacing, 4),
            stations=entries,
            at=on_grid(self._corner, self._spacing),
        )
        return with_letters(file), self._notes

    # --- the grid

    def _found_spacing(self, at: np.ndarray) -> float:
        """Returns the length of the shortest edges if all nodes lie on such a grid, or 1 m.

        Edges of 2 m and more are divided into cells of about 1 m.
        """
        place = dict(zip(self._graph.nodes, at))
        vectors = [place[e.end] - place[e.start] for e in self._graph.edges]
        lengths = np.abs(np.array(vectors).reshape(-1, 2)).max(axis=1)
        lengths = lengths[lengths > LEAST_SPACING / 2]
        if len(lengths):
            shortest = float(np.median(lengths[lengths < 1.25 * lengths.min()]))
            agreed = [straight.phase_of_centres(axis, shortest)[1] for axis in at.T]
            if min(agreed) > AGREE and LEAST_SPACING <= shortest <= MOST_SPACING:
                return shortest / (round(shortest) if shortest >= LONG else 1)
        return 1.0

    def _note_snapped(self, at: np.ndarray) -> None:
        taken: dict[Cell, str] = {}
        for number, cell in self._cells.items():
            if cell in taken:
                self._notes.append(
                    f"nodes {taken[cell]} and {number} fall into one cell: {named([cell])}"
                )
            taken.setdefault(cell, number)
        off = np.abs((at - self._corner) / self._spacing - list(self._cells.values())).max(axis=1)
        names = [n for n, far in zip(self._cells, off) if far > OFF]
        if names:
            more = f" and {len(names) - 6} more" if len(names) > 6 else ""
            self._notes.append(
                f"nodes were moved to the middle of their cells of {self._spacing:g} m:"
                f" {', '.join(names[:6])}{more}"
            )

    def _drive(self, edge: Edge) -> None:
        """Lets robots leave the cells of an edge along it: first along x, then along y."""
        here, there = self._cells[edge.start], self._cells[edge.end]
        if here[0] != there[0] and here[1] != there[1]:
            self._notes.append(f"edge {edge.name} is neither along x nor along y: it got a corner")
        while here != there:
            axis = 0 if here[0] != there[0] else 1
            heading = axis if there[axis] > here[axis] else axis + 2
            column, row = here
            self._exits[row, column] |= np.uint8(1 << heading)
            self._passable[row, column] = True
            here = (column + STEPS[heading][0], row + STEPS[heading][1])

    # --- stations

    def _entries(self, floor: np.ndarray) -> tuple[StationEntry, ...]:
        stations = self._graph.stations
        services = [self._cells[node] for _, _, node in stations]
        entries = station_entries([s[0] for s in stations], services, [s[1] for s in stations])
        free = floor == lf.FLOOR
        out = []
        for entry in entries:
            queue = tuple(self._before(entry.service, free))
            exit_ = tuple(self._after(entry.service, free, {*queue, entry.service}))
            for column, row in (*queue, entry.service, *exit_):
                free[row, column] = False  # a cell belongs to one lane
            out.append(replace(entry, queue=queue[::-1], exit=exit_))
        return tuple(out)

    def _before(self, cell: Cell, free: np.ndarray) -> Iterator[Cell]:
        """Yields the cells of a queue, from the service cell back: those that lead on alone."""
        passed = {cell}
        for _ in range(LONGEST):
            into = self._into(cell)
            if len(into) != 1 or into[0] in passed or not free[into[0][::-1]]:
                return
            if len(self._out_of(into[0])) != 1:
                return
            cell = into[0]
            passed.add(cell)
            yield cell

    def _after(self, cell: Cell, free: np.ndarray, passed: set[Cell]) -> Iterator[Cell]:
        """Yields the cells of a way out: those that can be entered from the one before alone."""
        for _ in range(LONGEST):
            out = self._out_of(cell)
            if len(out) != 1 or out[0] in passed or not free[out[0][::-1]]:
                return
            if len(self._into(out[0])) != 1:
                return
            cell = out[0]
            passed.add(cell)
            yield cell

    def _out_of(self, cell: Cell) -> list[Cell]:
        ways = int(self._exits[cell[::-1]])
        return [_next(cell, heading) for heading in range(4) if ways >> heading & 1]

    def _into(self, cell: Cell) -> list[Cell]:
        height, width = self._exits.shape
        sides = [(_next(cell, h), (h + 2) % 4) for h in range(4)]
        return [
            (c, r)
            for (c, r), back in sides
            if 0 <= c < width and 0 <= r < height and self._exits[r, c] >> back & 1
        ]

    def _with_arrows(self, floor: np.ndarray, entries: tuple[StationEntry, ...]) -> np.ndarray:
        from warehouse_layout.file import station_lanes
        from warehouse_layout.file.drawn_floor import areas

        exits = self._exits.copy()
        exits[np.isin(floor, list(DRAWN.values()))] = ALL_EXITS
        drawn = areas(floor)
        laned = LayoutFile(floor=floor, stations=tuple(e for e in entries if e.queue and e.exit))
        stations, _ = station_lanes.of_file(laned, drawn)
        plan = FloorPlan.laid_out(
            origin=(0.0, 0.0),
            spacing=self._spacing,
            passable=drawn.passable,
            storage=drawn.storage,
            parking=drawn.parking,
            exits=exits,
            stations=stations,
        )
        out, notes = arrows.draw(plan, floor)
        self._notes += notes
        return out


def _next(cell: Cell, heading: int) -> Cell:
    return cell[0] + STEPS[heading][0], cell[1] + STEPS[heading][1]
