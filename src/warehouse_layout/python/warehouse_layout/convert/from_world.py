# SPDX-License-Identifier: Apache-2.0
"""Reads a layout from an SDF world: from the markings on its floor and the models that stand there.

A world without markings has streets wherever nothing stands, and stations where belts have room for
a lane. A world that world_export wrote gives the same drawing, as long as it still says the same.
"""

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from warehouse_layout.convert import arrows
from warehouse_layout.convert.common import cells_of_short_cuts, with_letters
from warehouse_layout.file import drawn_floor, station_lanes
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import (
    Cell,
    ElevatorEntry,
    LayoutFile,
    LayoutFileError,
    StationEntry,
)
from warehouse_layout.floor import floor_markings, plan_reader
from warehouse_layout.floor.floor_plan import FloorError, FloorPlan
from warehouse_layout.floor.masks import labelled
from warehouse_layout.floor.plan_reader import BELT, UNIT
from warehouse_layout.floor.stations import PICK, Station
from warehouse_layout.models.models import FLOOR, WALLS, kind_and_number
from warehouse_layout.models.sdf_world import Model, SdfWorld, Solid, WorldError
from warehouse_layout.models.sdf_world import read as read_sdf
from warehouse_layout.models.world_export import DRAWING
from warehouse_layout.place import placement

TAKEN = 100  # in a map, as World.occupancy() has it
TURNING, HIGH, STEP = 0.57, 2.5, 0.03  # [m]: as the world takes them for its map
ROUNDING = 1e-6  # [m]


def read(path: str | Path) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a world file, and sentences about what a layout can't hold.

    Raises LayoutFileError.
    """
    try:
        return _Drawing(read_sdf(path), str(path)).file()
    except (WorldError, FloorError) as error:
        text = str(error)
        raise LayoutFileError(text if text.startswith(str(path)) else f"{path}: {text}") from error


@dataclass(frozen=True)
class _Raster:
    """The cells of a drawing: where cell (0, 0) is [m], and how many there are."""

    origin: tuple[float, float]
    shape: tuple[int, int]  # along y and x
    spacing: float

    def cells(self, points: Iterable[Sequence[float]]) -> np.ndarray:
        """Returns the cells (n, 2) column, row that are nearest to points [m]."""
        offset = np.reshape(list(points), (-1, 2)) - self.origin
        return np.round(offset / self.spacing).astype(int)

    def has(self, cells: np.ndarray) -> np.ndarray:
        """Returns which cells (n, 2) are on the drawing, (n,) bool."""
        return ((cells >= 0) & (cells < self.shape[::-1])).all(axis=1)

    def cover(self, mask: np.ndarray, solid: Solid, turning: float, half_cell: float) -> None:
        """Adds to a mask (h, w) the cells that a solid reaches into, or in which a robot that needs
        `turning` [m] from the middle can't turn. Of a cell counts what is within `half_cell` [m] of
        its middle."""
        x, y, half_x, half_y, angle = solid.rectangle()
        reach = np.hypot(half_x, half_y) + max(turning, self.spacing)
        low = np.floor((np.array([x, y]) - reach - self.origin) / self.spacing).astype(int)
        high = np.ceil((np.array([x, y]) + reach - self.origin) / self.spacing).astype(int) + 1
        columns, rows = (
            np.arange(max(0, first), max(0, min(last, size)))
            for first, last, size in zip(low, high, self.shape[::-1])
        )
        dx = self.origin[0] + columns * self.spacing - x
        dy = (self.origin[1] + rows * self.spacing - y)[:, None]
        mask[np.ix_(rows, columns)] |= _reached(dx, dy, half_x, half_y, angle, turning, half_cell)


def _reached(
    dx: np.ndarray,
    dy: np.ndarray,
    half_x: float,
    half_y: float,
    angle: float,
    turning: float,
    half_cell: float,
) -> np.ndarray:
    """Returns where a rectangle about (0, 0) is nearer than `turning` to the middle of a cell, or
    reaches into the cell."""
    cos, sin = np.cos(angle), np.sin(angle)
    along, across = np.abs(cos * dx + sin * dy) - half_x, np.abs(cos * dy - sin * dx) - half_y
    near = np.hypot(np.maximum(along, 0), np.maximum(across, 0)) < turning
    half = max(half_cell - ROUNDING, 0.0)
    slanted = half * (abs(cos) + abs(sin))
    wide, deep = (abs(cos) * a + abs(sin) * b for a, b in ((half_x, half_y), (half_y, half_x)))
    within = (along <= slanted) & (across <= slanted)
    within &= (np.abs(dx) <= wide + half) & (np.abs(dy) <= deep + half)
    return near | within


class _Drawing:
    def __init__(self, world: SdfWorld, path: str) -> None:
        self._world, self._path = world, path
        self._notes = [f"{name}: its model was not found" for name in world.unknown]
        self._kinds: dict[str | None, list[Model]] = {}
        for model in world.models:
            self._kinds.setdefault(kind_and_number(model.name)[0], []).append(model)
        self._hint = _hint(world.root)
        self._raster = self._find_raster()

    def file(self) -> tuple[LayoutFile, list[str]]:
        """Returns the layout, and sentences about what it can't hold."""
        half = self._raster.spacing / 2
        belts = self._covered(self._kinds.get("conveyor_belt", ()), 0.0, half)
        # A layout's walls are drawn narrow enough for robots to pass: only the centres count.
        walls = self._covered(self._kinds.get(WALLS, ()), 0.0, 0.0)
        walls |= self._covered(self._obstacles(), TURNING, half)
        plan = self._plan(belts, walls)
        floor = _areas(plan, belts, walls)
        file = LayoutFile(
            floor=floor,
            name=self._world.name,
            spacing=self._world.spacing,
            stations=_stations(plan),
            storage_units=self._standing("storage_unit", plan.storage, "storage place"),
            robots=self._standing("kiva", plan.passable, "floor"),
            items=len(self._kinds.get("item", ())),
            path=self._path,
            elevators=tuple(ElevatorEntry.of_elevator(e, plan.width) for e in plan.elevators),
        )
        centred = np.allclose(placement.origin(file), plan.origin)
        file = file if centred else replace(file, at=plan.origin)
        self._notes += [f"belt {text}" for text in plan.without_lane]
        if self._hint and _same(self._hint, file, plan):
            file = replace(file, floor=self._hint.floor, stations=self._hint.stations)
        else:
            drawn, unsaid = arrows.draw(plan, floor)
            self._notes += unsaid
            file = with_letters(replace(file, floor=drawn))
        return (self._as_hinted(file, self._hint) if self._hint else file), self._notes

    def _find_raster(self) -> _Raster:
        if self._hint:
            return _Raster(placement.origin(self._hint), self._hint.shape, self._hint.spacing)
        spacing = self._world.spacing
        low, high = self._extent()
        first = np.ceil((low - ROUNDING) / spacing + 0.5).astype(int)
        last = np.floor((high + ROUNDING) / spacing - 0.5).astype(int)
        width, height = (last - first + 1).tolist()
        if width < 1 or height < 1:
            raise WorldError(f"{self._path}: no floor of a cell of {spacing:g} m was found")
        if width * height > 4_000_000:
            raise WorldError(f"{self._path}: its floor has {width} x {height} cells")
        x, y = (first * spacing).tolist()
        return _Raster((x, y), (height, width), spacing)

    def _extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns the lowest and highest x y [m] of the floor, or of all that stands there."""
        for model in self._world.models:
            if model.plane:
                return model.pose[:2] - np.divide(model.plane, 2), model.pose[:2] + np.divide(
                    model.plane, 2
                )
        boxes = [solid.rectangle() for model in self._world.models for solid in model.solids]
        if not boxes:
            raise WorldError(f"{self._path}: neither a floor nor anything solid was found")
        x, y, half_x, half_y, _ = np.array(boxes).T
        reach = np.hypot(half_x, half_y) + self._world.spacing
        corners = np.stack([x - reach, y - reach]), np.stack([x + reach, y + reach])
        return corners[0].min(axis=1), corners[1].max(axis=1)

    def _covered(
        self, solids: Iterable[Model | Solid], turning: float, half_cell: float
    ) -> np.ndarray:
        """Returns the cells that solids, or those of models, cover, (h, w) bool; see cover()."""
        out = np.zeros(self._raster.shape, bool)
        for body in solids:
            for solid in body.solids if isinstance(body, Model) else [body]:
                self._raster.cover(out, solid, turning, half_cell)
        return out

    def _obstacles(self) -> Iterator[Solid]:
        """Yields what else robots can't drive through or beneath."""
        if self._hint and self._hint.building:
            return  # the hall around is not part of the drawing
        for model in self._kinds.get(None, ()):
            if model.name == FLOOR or model.plane:
                continue
            for solid in model.solids:
                low, high = solid.span()
                if high > STEP and low < HIGH:
                    yield solid
            if model.has_meshes:
                self._notes.append(f"{model.name}: its mesh is not drawn")

    def _plan(self, belts: np.ndarray, taken: np.ndarray) -> FloorPlan:
        raster = self._raster
        occupancy = np.zeros(raster.shape, np.uint8)
        units = raster.cells(m.pose[:2] for m in self._kinds.get("storage_unit", ()))
        units = units[raster.has(units)]
        occupancy[units[:, 1], units[:, 0]] = UNIT
        occupancy[belts], occupancy[taken] = BELT, TAKEN
        marks = [
            mark
            for model in self._kinds.get(floor_markings.NAME, ())
            for mark in floor_markings.read(model.visuals, model.pose, model.name)
        ]
        at = {m.name: m.pose[:2].tolist() for m in self._kinds.get("conveyor_belt", ())}
        return plan_reader.of_parts(*raster.origin, raster.spacing, occupancy, marks, at)

    def _standing(self, kind: str, allowed: np.ndarray, where: str) -> tuple[Cell, ...]:
        """Returns the cells in which models of a kind stand; notes those that stand elsewhere."""
        models = sorted(self._kinds.get(kind, ()), key=lambda m: kind_and_number(m.name)[1])
        cells = self._raster.cells(model.pose[:2] for model in models)
        inside = self._raster.has(cells)
        out: dict[Cell, None] = {}
        for model, (column, row), is_inside in zip(models, cells.tolist(), inside):
            if not is_inside or not allowed[row, column]:
                self._notes.append(f"{model.name} stands on no {where}")
            elif (column, row) in out:
                self._notes.append(f"{model.name} stands in one cell with another {kind}")
            else:
                out[column, row] = None
        return tuple(out)

    def _as_hinted(self, file: LayoutFile, hint: LayoutFile) -> LayoutFile:
        """Returns the file completed from the hint by what a world does not contain."""
        settings = {s.name: s.settings for s in hint.stations}
        stations = tuple(replace(s, settings=settings.get(s.name, {})) for s in file.stations)
        file = replace(file, stations=stations, name=hint.name, at=hint.at, building=hint.building)
        return self._with_counts(replace(file, policies=hint.policies), hint)

    def _with_counts(self, file: LayoutFile, hint: LayoutFile) -> LayoutFile:
        """Returns the file with the hint's counts, where what stands there is what they give."""
        try:
            layout = placement.place(hint)
        except LayoutFileError:
            return file
        cells = {
            name: tuple(map(tuple, self._raster.cells(points).tolist()))
            for name, points in (("storage_units", layout.units), ("robots", layout.robots[:, :2]))
        }
        same = {n: getattr(hint, n) for n, at in cells.items() if getattr(file, n) == at}
        if len(layout.item_unit) == file.items:
            same |= {"items": hint.items, "stock": hint.stock, "skus": hint.skus}
        return replace(file, **same)


def _hint(root: ElementTree.Element) -> LayoutFile | None:
    """Returns the layout file whose text is in a world; None if there is none that can be read."""
    text = root.findtext(f"world/{DRAWING}")
    try:
        return lf.parse(text) if text else None
    except LayoutFileError:
        return None


def _same(hint: LayoutFile, file: LayoutFile, plan: FloorPlan) -> bool:
    """Returns whether a layout file means the plan that was read, and the file drawn of it."""
    drawn, now = drawn_floor.areas(hint.floor), drawn_floor.areas(file.floor)
    stations, faults = station_lanes.of_file(hint, drawn)
    if faults or hint.shape != plan.shape:
        return False
    hinted = placement.plan_of(hint, drawn, stations)
    arrays = ("passable", "storage", "parking", "exits")
    same = all((getattr(hinted, a) == getattr(plan, a)).all() for a in arrays)
    same &= bool((drawn.walls == now.walls).all() and (drawn.belts == now.belts).all())
    same &= np.array_equal(hinted.charging, plan.charging)
    return same and list(map(_key, hinted.stations)) == list(map(_key, plan.stations))


def _key(station: Station) -> tuple[object, ...]:
    cuts = sorted(station.short_cuts)
    return station.name, station.kind, station.service, station.cells.tolist(), cuts


def _stations(plan: FloorPlan) -> tuple[StationEntry, ...]:
    out = []
    for station in plan.stations:
        cells = [divmod(int(cell), plan.width)[::-1] for cell in station.cells]
        out.append(
            StationEntry(
                key=station.name,
                name=station.name,
                kind="pick" if station.kind == PICK else "replenish",
                service=cells[station.service],
                queue=tuple(cells[: station.service]),
                exit=tuple(cells[station.service + 1 :]),
                short_cuts=cells_of_short_cuts(station, plan.width),
            )
        )
    return tuple(out)


def _areas(plan: FloorPlan, belts: np.ndarray, walls: np.ndarray) -> np.ndarray:
    """Returns the drawing (h, w) of a plan, but for the directions of its streets."""
    closed = ~plan.passable & ~walls & ~belts
    floor = np.full(plan.shape, lf.FLOOR, "<U1")
    floor[~plan.passable] = lf.WALL
    floor[closed] = lf.KEEP_OUT
    floor[closed & _from_edge(closed)] = lf.NO_FLOOR
    floor[belts & ~plan.passable] = lf.BELT
    floor[plan.parking] = lf.PARKING
    floor.flat[list(plan.charging)] = lf.CHARGING
    floor[plan.storage] = lf.STORAGE
    return floor


def _from_edge(mask: np.ndarray) -> np.ndarray:
    """Returns the cells of a mask that are joined with the edge by others of it, (h, w) bool."""
    labels = labelled(mask)
    edge = np.unique(np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]]))
    joined: np.ndarray = mask & np.isin(labels, edge)
    return joined
