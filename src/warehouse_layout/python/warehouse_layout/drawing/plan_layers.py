# SPDX-License-Identifier: Apache-2.0
"""What is drawn on a plan: floor, places, walls, belts, lanes, arrows, robots, units, names."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from warehouse_layout.file import drawn_floor, station_lanes
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.floor import outlines as shapes
from warehouse_layout.floor.palette import PLAN
from warehouse_layout.floor.stations import PICK, STEPS, Station, lane_mask
from warehouse_layout.place import placement
from warehouse_layout.place.layout import Layout

CHUNK = 1500  # shapes of one path: the rasterizer has a limit
ARROW_ROOM = 0.19  # [in]: arrows are this far apart, at least
FINE = 0.06  # [in]: smaller cells have no grid
LETTER = 0.62  # width of a letter, of its size
LANE = 3  # cells that a lane is wide
_ALIGNMENT = dict(
    zip(STEPS, (("left", "center"), ("center", "bottom"), ("right", "center"), ("center", "top")))
)


@dataclass(frozen=True)
class Subject:
    """A layout file, and what stands where in its warehouse."""

    file: LayoutFile
    drawn: drawn_floor.DrawnFloor
    stations: Sequence[Station]
    layout: Layout | None  # None: not all that it asks for can be placed
    fault: str = ""  # why not

    @classmethod
    def of_file(cls, file: LayoutFile) -> "Subject":
        """Places what a file describes."""
        drawn = drawn_floor.areas(file.floor)
        stations, faults = station_lanes.of_file(file, drawn)
        try:
            return cls(file, drawn, stations, placement.place(file))
        except LayoutFileError as error:
            text = faults[0].text if faults else str(error)
            return cls(file, drawn, stations, None, text)

    def cells(self, points: np.ndarray) -> np.ndarray:
        """Returns points x y in `world` [m] as column and row, (n, 2)."""
        origin = placement.origin(self.file)
        return (np.reshape(points, (-1, 2)) - origin) / self.file.spacing

    def lane_part(self, part: str) -> np.ndarray:
        """Returns the cells of all lanes' "queue", "service" or "exit", (h, w) bool."""
        out = np.zeros(self.file.shape, bool)
        for station in self.stations:
            out.flat[station.parts[part]] = True
        return out


class Layers:
    """Draws a Subject on axes whose unit is a cell; `cell` is the size of one [in]."""

    def __init__(self, axes: Axes, subject: Subject, cell: float) -> None:
        self._axes, self._subject, self._cell = axes, subject, cell

    def draw(self) -> None:
        """Draws all, what lies lowest first."""
        self._floor()
        self._places()
        self._solids()
        self._lanes()
        self._arrows()
        self._elevators()
        self._units()
        self._robots()
        for station in self._subject.stations:
            self._name(station)

    def _add(self, outlines: np.ndarray, colour: str, **style: object) -> None:
        add(self._axes, outlines, **{"facecolor": PLAN[colour], **style})

    def _floor(self) -> None:
        drawn = self._subject.drawn
        is_floor = self._subject.file.floor != lf.NO_FLOOR
        self._add(shapes.boxes(is_floor), "floor", zorder=0.5)
        if self._cell >= FINE:
            height, width = is_floor.shape
            # Lines between the cells of the floor: those of one row's columns, and of both.
            mesh = [shapes.borders(is_floor & (np.arange(width) % 2 == i)) for i in (0, 1)]
            mesh += [shapes.borders(is_floor & (np.arange(height)[:, None] % 2 == 0))]
            style = {"colors": PLAN["grid"], "linewidths": 0.4, "zorder": 0.6}
            self._axes.add_collection(LineCollection(np.concatenate(mesh), **style))
        keep_out = self._subject.file.floor == lf.KEEP_OUT
        self._add(shapes.boxes(keep_out), "keep_out")
        self._add(shapes.stripes(keep_out), "stripe")
        outline = shapes.borders(is_floor & ~drawn.walls & ~drawn.belts)
        self._axes.add_collection(LineCollection(outline, colors=PLAN["faint"], linewidths=0.6))

    def _places(self) -> None:
        drawn = self._subject.drawn
        inset = 0.05 if self._cell >= FINE else 0.0
        self._add(shapes.boxes(drawn.storage, inset), "storage")
        self._add(shapes.boxes(drawn.parking & ~drawn.charging, inset), "parking")
        self._add(shapes.boxes(drawn.charging, inset), "charging")
        charging = np.argwhere(drawn.charging)[:, ::-1]
        self._add(shapes.placed(shapes.BOLT, charging, 0.34), "bolt")

    def _solids(self) -> None:
        drawn = self._subject.drawn
        self._add(shapes.boxes(drawn.walls), "wall")
        self._add(shapes.boxes(drawn.belts), "belt")

    def _elevators(self) -> None:
        """Draws the cells of elevators with their names."""
        for elevator in self._subject.file.elevators:
            cells = np.array(elevator.cells)
            self._add(shapes.placed(shapes.SQUARE, cells, 0.5), "elevator", zorder=3)
            self._add(shapes.placed(shapes.UP_DOWN, cells, 0.4), "paper", zorder=3)
            for column, row in elevator.cells:
                self._axes.text(
                    column,
                    row + 0.55,
                    elevator.name,
                    ha="center",
                    va="bottom",
                    fontsize=name_size(self._cell) * 0.8,
                    color=PLAN["elevator"],
                    zorder=5,
                )

    def _lanes(self) -> None:
        subject = self._subject
        for part in ("queue", "exit"):
            self._add(shapes.boxes(subject.lane_part(part)), part)
        for station in subject.stations:
            cells = self._lane_cells(station)
            colour = "service" if station.kind == PICK else "replenish"
            at = cells[[station.service]]
            self._add(shapes.placed(shapes.SQUARE, at, 0.46), colour)
            line = max(0.5, min(1.4, self._cell * 5))
            self._axes.plot(*cells.T, color=PLAN["lane"], linewidth=line, zorder=1.5)
            yaw = shapes.heading(cells[-2], cells[-1]) if len(cells) > 1 else 0.0
            end = cells[-1] + 0.25 * np.array([math.cos(yaw), math.sin(yaw)])
            self._add(shapes.placed(shapes.ARROW[2:5], end[None], 0.3, yaw), "lane", zorder=2)
            self._add(shapes.placed(shapes.DISC, cells[[0]], 0.13), "lane", zorder=2)
        for entry in subject.file.stations:
            if entry.name not in {station.name for station in subject.stations}:
                at = np.array([entry.service])
                self._add(shapes.placed(shapes.SQUARE, at, 0.46), "fault")

    def _lane_cells(self, station: Station) -> np.ndarray:
        row, column = np.divmod(station.cells, self._subject.file.shape[1])
        return np.column_stack([column, row])

    def _arrows(self) -> None:
        floor = self._subject.file.floor
        street = self._subject.drawn.streets & ~lane_mask(self._subject.stations, floor.shape)
        tile = max(1, math.ceil(ARROW_ROOM / self._cell))
        size = 0.3 * max(1.0, min(tile / 2, 1.5))
        characters = (*lf.ONE_WAY, lf.ALONG_X, lf.ALONG_Y)
        for i, character in enumerate(characters):
            at = shapes.thinned(street & (floor == character), tile)
            outline = shapes.ARROW if i < 4 else shapes.BOTH_WAYS
            self._add(shapes.placed(outline, at, size, i % 4 * math.pi / 2), "arrow")

    def _units(self) -> None:
        layout = self._subject.layout
        if layout and len(layout.units):
            cells = self._subject.cells(layout.units)
            self._add(shapes.placed(shapes.SQUARE, cells, 0.36), "unit", zorder=2.5)
            if self._cell >= 2 * FINE:
                self._add(shapes.placed(shapes.SQUARE, cells, 0.27), "storage", zorder=2.5)
                self._add(shapes.placed(shapes.SQUARE, cells, 0.2), "unit", zorder=2.5)

    def _robots(self) -> None:
        layout = self._subject.layout
        if layout and len(layout.robots):
            cells, yaw = self._subject.cells(layout.robots[:, :2]), layout.robots[:, 2]
            style = {"edgecolor": PLAN["paper"], "linewidth": min(0.6, self._cell * 3), "zorder": 3}
            self._add(shapes.placed(shapes.DISC, cells, 0.34), "robot", **style)
            tips = shapes.placed(shapes.TIP, cells, 0.3, yaw)
            self._add(tips, "paper", zorder=3)

    def _name(self, station: Station) -> None:
        """Writes a station's name beyond its service cell and belt, off its lane."""
        out = _outward(self._lane_cells(station), station.service)
        row, column = divmod(station.service_cell, self._subject.file.shape[1])
        at = np.array([column, row]) + out
        while self._is_belt(at):
            at = at + out
        horizontal, vertical = _ALIGNMENT[tuple(out.tolist())]
        self._axes.text(
            *(at - out * 0.3),
            station.name,
            ha=horizontal,
            va=vertical,
            rotation=90 if out[1] and is_wide(station.name, self._cell) else 0,
            fontsize=name_size(self._cell),
            fontweight="bold",
            color=PLAN["ink"],
            zorder=5,
            bbox={"facecolor": PLAN["paper"], "alpha": 0.8, "linewidth": 0, "pad": 0.8},
        )

    def _is_belt(self, cell: np.ndarray) -> bool:
        (x, y), belts = cell, self._subject.drawn.belts
        return 0 <= x < belts.shape[1] and 0 <= y < belts.shape[0] and bool(belts[y, x])


def add(axes: Axes, outlines: np.ndarray, **style: object) -> None:
    """Adds closed outlines (n, corners, 2) to axes."""
    for begin in range(0, len(outlines), CHUNK):
        part = outlines[begin : begin + CHUNK]
        closed = np.concatenate([part, part[:, :1]], axis=1)
        codes = np.full(closed.shape[:2], Path.LINETO, Path.code_type)
        codes[:, 0], codes[:, -1] = Path.MOVETO, Path.CLOSEPOLY
        path = Path(closed.reshape(-1, 2), codes.ravel())
        # The limits of the axes are known: add_patch() would search all shapes for them.
        axes.add_artist(PathPatch(path, **{"linewidth": 0, **style}))


def _outward(lane: np.ndarray, service: int) -> np.ndarray:
    """Returns the step (x, y) from a lane's service cell away from its other cells (n, 2)."""
    taken = set(map(tuple, lane.tolist()))
    away = lane[service] - lane.mean(axis=0)
    free = [step for step in STEPS if (*(lane[service] + step),) not in taken]
    return max(map(np.array, free or STEPS), key=lambda step: float(step @ away))


def name_width(name: str, cell: float) -> float:
    """Returns the approximate width of a station's name [in] for cells of `cell` inches."""
    return len(name) * LETTER * name_size(cell) / 72


def is_wide(name: str, cell: float) -> bool:
    """Returns whether a name reaches over the lanes beside its own."""
    return name_width(name, cell) > LANE * cell


def name_size(cell: float) -> float:
    """Returns the size of stations' names [pt] for cells of `cell` inches."""
    return max(5.0, min(9.0, cell * 72 * 0.6))
