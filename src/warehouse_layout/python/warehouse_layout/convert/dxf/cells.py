# SPDX-License-Identifier: Apache-2.0
"""Divides the shapes of a drawing into the cells of a floor.

The cells lie so that places are in their middles; without places, as the walls begin. What walls
enclose is floor, or what the layer `floor` outlines.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterable

import numpy as np

from warehouse_layout.convert import straight
from warehouse_layout.convert.common import (
    FormatError,
    PathName,
    check_size,
    named,
    station_entries,
    trimmed,
    with_letters,
)
from warehouse_layout.convert.dxf.shapes import Drawing, Shape
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import Cell, LayoutFile

ONE = 1.5  # cells: what is no longer and no wider is one place
AGREE = 0.9  # least share of places that lie on a grid
NEAR = 2.0  # largest distance of a name from its station [cells]
EDGE = 1e-6  # cells: what lies on an edge belongs to the upper one, in spite of rounding

# By layer, in the order of painting.
PAINTED = {
    "keep_out": lf.KEEP_OUT,
    "belts": lf.BELT,
    "storage": lf.STORAGE,
    "parking": lf.PARKING,
    "charging": lf.CHARGING,
}
STATIONS = {"stations": "pick", "replenish": "replenish"}


def layout_of(path: PathName, drawing: Drawing, spacing: float) -> LayoutFile:
    """Returns the layout of a drawing; notes in it what was left out.

    `spacing` is the edge of a cell [m]. Raises FormatError.
    """
    return _Cells(path, drawing, spacing).layout()


class _Cells:
    def __init__(self, path: PathName, drawing: Drawing, spacing: float) -> None:
        self._path, self._drawing, self._spacing = path, drawing, spacing
        points = np.concatenate([s.points for s in drawing.shapes])
        self._corner = self._phase()
        self._corner = (
            self._corner + np.floor((points.min(axis=0) - self._corner) / spacing) * spacing
        )
        width, height = (np.floor(np.ptp(points, axis=0) / spacing) + 2).astype(int).tolist()
        check_size(path, "a drawing", height, width)
        self._floor = np.full((height, width), lf.NO_FLOOR, "<U1")

    def layout(self) -> LayoutFile:
        self._draw_hall()
        for kind, character in PAINTED.items():
            self._paint(kind, character)
        self._draw_streets()
        stations = [s for s in self._drawing.shapes if s.kind in STATIONS]
        cells = self._distinct("station", [self._cell(s.centre) for s in stations])
        robots = self._distinct(
            "robot", [self._cell(s.centre) for s in self._drawing.shapes if s.kind == "robots"]
        )
        for column, row in [*cells, *robots]:
            if self._floor[row, column] in (lf.NO_FLOOR, lf.WALL, lf.BELT, lf.KEEP_OUT):
                self._floor[row, column] = lf.FLOOR
        entries = station_entries(
            self._names(stations), cells, [STATIONS[s.kind] for s in stations]
        )
        if (self._floor == lf.NO_FLOOR).all():
            raise FormatError(f"{self._path}: nothing in it makes a floor: walls enclose none")
        file = LayoutFile(
            floor=self._floor,
            spacing=self._spacing,
            stations=entries,
            robots=tuple(robots) or 0,
        )
        return with_letters(trimmed(file))

    # --- where cells lie

    def _phase(self) -> np.ndarray:
        """Returns a corner of cells [m] from which places lie in the middle of theirs."""
        places = [s for s in self._drawing.shapes if s.kind in (*PAINTED, *STATIONS)]
        anchors = [self._anchor(s) for s in places if self._is_one(s) or s.closed]
        if not anchors:
            walls = [s.points for s in self._drawing.shapes if s.kind == "walls"]
            return np.concatenate(walls).min(axis=0) if walls else np.zeros(2)
        phases = [straight.phase_of_centres(axis, self._spacing) for axis in np.array(anchors).T]
        if min(agreement for _, agreement in phases) < AGREE:
            self._drawing.notes.append(
                f"places are not whole cells of {self._spacing:g} m apart: each went to the cell"
                " that holds its middle"
            )
        return np.array([phase for phase, _ in phases])

    def _is_one(self, shape: Shape) -> bool:
        return bool((shape.size <= ONE * self._spacing).all())

    def _anchor(self, shape: Shape) -> np.ndarray:
        """Returns the middle of a place; for a larger area that of the cell at its corner."""
        return shape.centre if self._is_one(shape) else shape.points.min(axis=0) + self._spacing / 2

    def _cells(self, points: np.ndarray) -> np.ndarray:
        """Returns the columns and rows (2, n) of points."""
        at = np.floor((points - self._corner) / self._spacing + EDGE).astype(int)
        height, width = self._floor.shape
        return np.clip(at, 0, (width - 1, height - 1)).T

    def _cell(self, point: np.ndarray) -> Cell:
        column, row = self._cells(point[None]).ravel().tolist()
        return column, row

    # --- the hall

    def _draw_hall(self) -> None:
        walls = np.zeros(self._floor.shape, bool)
        for shape in self._of("walls"):
            if shape.filled:
                walls[self._inside(shape)] = True
            column, row = self._cells(shape.along(self._spacing / 4))
            walls[row, column] = True
        outlines = [s for s in self._of("floor") if s.closed]
        inside = np.zeros_like(walls) if outlines else self._within(walls)
        for outline in outlines:
            inside[self._inside(outline)] = True
        self._floor[inside & ~walls] = lf.FLOOR
        self._floor[walls] = lf.WALL

    def _within(self, walls: np.ndarray) -> np.ndarray:
        """Returns the cells that walls enclose; where these have gaps, those of the drawing."""
        from scipy import ndimage

        labels, _ = ndimage.label(np.pad(~walls, 1, constant_values=True))
        outside = (labels == labels[0, 0])[1:-1, 1:-1]
        places = [s for s in self._drawing.shapes if s.kind not in ("walls", "floor")]
        without = [s for s in places if outside[tuple(self._cells(s.centre[None])[::-1, 0])]]
        if places and not without:
            return ~outside
        if (walls | outside).all() or without:
            self._drawing.notes.append(
                "walls do not enclose all places: the floor is the rectangle about the drawing"
            )
            return self._about(places)
        return ~outside

    def _about(self, places: Iterable[Shape]) -> np.ndarray:
        """Returns the cells of the rectangle about walls and places, one cell wider."""
        points = np.concatenate([s.points for s in [*self._of("walls"), *places]])
        (left, right), (low, high) = ((int(a.min()), int(a.max())) for a in self._cells(points))
        out = np.zeros(self._floor.shape, bool)
        out[low : high + 1, left : right + 1] = True
        return out

    def _of(self, kind: str) -> list[Shape]:
        return [s for s in self._drawing.shapes if s.kind == kind]

    def _inside(self, shape: Shape) -> tuple[np.ndarray, np.ndarray]:
        """Returns rows and columns of the cells whose middles a closed line encloses."""
        (left, right), (low, high) = (
            (int(a.min()), int(a.max()) + 1) for a in self._cells(shape.points)
        )
        x = self._corner[0] + (np.arange(left, right) + 0.5) * self._spacing
        y = self._corner[1] + (np.arange(low, high) + 0.5)[:, None] * self._spacing
        part = np.zeros((high - low, right - left), bool)
        for (x0, y0), (x1, y1) in zip(shape.points, np.roll(shape.points, -1, axis=0)):
            if y0 != y1:
                crossed = (y0 <= y) != (y1 <= y)
                part ^= crossed & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
        rows, columns = np.nonzero(part)
        return rows + low, columns + left

    # --- what stands in it

    def _paint(self, kind: str, character: str) -> None:
        twice: list[Cell] = []
        blocked: list[Cell] = []
        for shape in self._of(kind):
            row, column = self._taken(shape)
            there = self._floor[row, column]
            is_free = there != lf.WALL
            blocked += zip(column[~is_free].tolist(), row[~is_free].tolist())
            if self._is_one(shape):
                again = there == character
                twice += zip(column[again].tolist(), row[again].tolist())
            self._floor[row[is_free], column[is_free]] = character
        if blocked:
            self._drawing.notes.append(f"{kind} left out where a wall is: {named(blocked)}")
        if twice:
            self._drawing.notes.append(f"{kind}: two fall into one cell at {named(twice)}")

    def _taken(self, shape: Shape) -> tuple[np.ndarray, np.ndarray]:
        """Returns rows and columns of the cells of a place, an area or a line, each but once."""
        if self._is_one(shape):
            column, row = self._cells(shape.centre[None])
            return row, column
        if shape.closed:
            return self._inside(shape)
        column, row = np.unique(self._cells(shape.along(self._spacing / 4)), axis=1)
        return row, column

    def _draw_streets(self) -> None:
        """Draws one-way streets along lines, in the direction in which these are drawn."""
        for shape in self._of("streets"):
            points = shape.along(self._spacing / 4)
            for a, b in zip(points, points[1:]):
                column, row = self._cell((a + b) / 2)
                heading = round(math.atan2(b[1] - a[1], b[0] - a[0]) / (math.pi / 2)) % 4
                if self._floor[row, column] in (lf.FLOOR, *lf.ONE_WAY):
                    self._floor[row, column] = lf.ONE_WAY[heading]

    def _distinct(self, what: str, cells: list[Cell]) -> list[Cell]:
        twice = sorted(cell for cell, count in Counter(cells).items() if count > 1)
        if twice:
            raise FormatError(f"{self._path}: two {what}s fall into one cell: {named(twice)}")
        return cells

    def _names(self, stations: list[Shape]) -> list[str]:
        """Returns the stations' names: of their attributes, written beside them, or by number."""
        out, counts = [], dict.fromkeys(STATIONS, 0)
        for shape in stations:
            counts[shape.kind] += 1
            number = f"{STATIONS[shape.kind]}{counts[shape.kind]}"
            out.append(shape.name or self._written(shape) or number)
        return out

    def _written(self, shape: Shape) -> str:
        key: Callable[[tuple[np.ndarray, str]], float] = lambda t: math.dist(t[0], shape.centre)  # noqa: E731
        at, text = min(self._drawing.texts, key=key, default=(np.full(2, np.inf), ""))
        return text if math.dist(at, shape.centre) <= NEAR * self._spacing else ""
