# SPDX-License-Identifier: Apache-2.0
"""Reads what stands in an SDF world, as far as a drawing shows it: without running the world."""

import os
import xml.etree.ElementTree as ElementTree
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from warehouse_layout.file import files, user_file
from warehouse_layout.floor import poses
from warehouse_layout.models.models import kind_and_number

DEPTH = 8  # of models within models
POINTS = ("kiva", "storage_unit", "item")  # kinds of which the pose alone is read: they are many


class WorldError(ValueError):
    """Says which file is no world, and why."""


@dataclass(frozen=True)
class Solid:
    """A collision's box, or the box around it: a rectangle on the floor and its heights."""

    pose: np.ndarray  # (7,) in `world`: x y z [m] qx qy qz qw
    size: np.ndarray  # (3,) [m]

    def span(self) -> tuple[float, float]:
        """Returns its lowest and highest z [m]."""
        z = self._corners()[:, 2]
        return float(z.min()), float(z.max())

    def rectangle(self) -> tuple[float, float, float, float, float]:
        """Returns the rectangle x y, half edges [m] and yaw [rad] that it covers on the floor."""
        x, y, _, qx, qy, qz, qw = self.pose
        if abs(qx) + abs(qy) < 1e-9:
            half_x, half_y, _ = self.size / 2
            return float(x), float(y), float(half_x), float(half_y), float(2 * np.arctan2(qz, qw))
        corners = self._corners()[:, :2]
        low, high = corners.min(axis=0), corners.max(axis=0)
        (x, y), (half_x, half_y) = (low + high) / 2, (high - low) / 2
        return float(x), float(y), float(half_x), float(half_y), 0.0

    def _corners(self) -> np.ndarray:
        signs = np.array([(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])
        turned = poses.rotate(np.repeat(self.pose[None, 3:], 8, axis=0), signs * self.size / 2)
        return self.pose[:3] + turned


@dataclass
class Model:
    """A model of a world: where it is, what of it is solid, and its visuals' boxes."""

    name: str
    pose: np.ndarray  # (7,) in `world`
    solids: list[Solid] = field(default_factory=list)
    plane: tuple[float, float] | None = None  # edges of a floor without thickness [m]
    # (link, pose (7,) in the model, size (3,) [m]) each, as World.visuals() has them
    visuals: list[tuple[str, np.ndarray, np.ndarray]] = field(default_factory=list)
    has_meshes: bool = False


@dataclass
class SdfWorld:
    """What a world file says."""

    name: str
    spacing: float  # of its grid [m]
    models: list[Model]
    root: ElementTree.Element
    unknown: list[str]  # includes whose model was not found


def name_of(element: ElementTree.Element) -> str:
    """Returns the name of a <model> or an <include>, which by default is that of its file."""
    if element.tag == "include":
        uri = element.findtext("uri", "").strip().rstrip("/")
        return (element.findtext("name") or uri.rpartition("/")[2]).strip()
    return element.get("name", "")


def read(path: str | Path, points: Collection[str] = POINTS) -> SdfWorld:
    """Reads a world file; of models of the kinds `points` the pose alone. Raises WorldError."""
    try:
        root = user_file.read_xml(path)
    except OSError as error:
        raise WorldError(f"{path}: {error.strerror}") from error
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        raise WorldError(f"{path}: is not XML: {error}") from error
    return _world_of(root, Path(path), points)


def parse(xml: str, path: str | Path, points: Collection[str] = POINTS) -> SdfWorld:
    """Returns what an SDF text says, whose relative files lie beside `path`. Raises WorldError."""
    try:
        root = ElementTree.fromstring(xml)
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        raise WorldError(f"{path}: is not XML: {error}") from error
    return _world_of(root, Path(path), points)


def _world_of(root: ElementTree.Element, path: Path, points: Collection[str]) -> SdfWorld:
    world = root.find("world") if root.tag == "sdf" else None
    if world is None:
        raise WorldError(f"{path}: an <sdf> with a <world> was expected")
    return _Reader(path, points).world(root, world)


class _Reader:
    def __init__(self, path: Path, points: Collection[str]) -> None:
        self._path, self._points = path, points
        self._unknown: list[str] = []
        self._files: dict[Path, ElementTree.Element | None] = {}

    def world(self, root: ElementTree.Element, world: ElementTree.Element) -> SdfWorld:
        models = [self._model(e) for e in world if e.tag in ("model", "include")]
        text = world.findtext("plugin[@name='grid']/spacing", "1")
        spacing = self._numbers(text, 1, "the spacing of the grid")[0]
        if not 0.01 <= spacing <= 1000:
            raise WorldError(f"{self._path}: the spacing of the grid is {spacing:g} m")
        return SdfWorld(world.get("name", ""), float(spacing), models, root, self._unknown)

    def _model(self, element: ElementTree.Element) -> Model:
        out = Model(name_of(element), self._pose(element))
        if kind_and_number(out.name)[0] in self._points:
            return out
        self._collect(element, self._path.parent, out, _identity(), DEPTH)
        for solid in out.solids:
            solid.pose[:] = poses.compose(out.pose[None], solid.pose[None])[0]
        return out

    def _collect(
        self, element: ElementTree.Element, folder: Path, out: Model, frame: np.ndarray, depth: int
    ) -> None:
        """Adds what is in a model or an include, whose pose in the whole model is `frame`."""
        if depth < 0:
            raise WorldError(f"{self._path}: '{out.name}' holds models within models without end")
        if element.tag == "include":
            uri = element.findtext("uri", "").strip()
            file = self._found(uri, folder)
            inner = self._parsed(file) if file else None
            if inner is None or file is None:
                self._unknown.append(f"{out.name} ({uri})")
                return
            own = self._pose(inner) if element.find("pose") is None else _identity()
            self._collect(inner, file.parent, out, self._within(frame, own), depth - 1)
            return
        for link in element.iterfind("link"):
            self._link(link, out, self._within(frame, self._pose(link)))
        for part in element:
            if part.tag in ("model", "include"):
                self._collect(part, folder, out, self._within(frame, self._pose(part)), depth - 1)

    def _link(self, link: ElementTree.Element, out: Model, frame: np.ndarray) -> None:
        for collision in link.iterfind("collision"):
            plane = collision.findtext("geometry/plane/size")
            if plane:
                wide, deep = self._numbers(plane, 2, f"{out.name}: a plane's size")
                out.plane = float(wide), float(deep)
            for size in self._sizes(collision, out):
                out.solids.append(Solid(self._within(frame, self._pose(collision)), size))
        for visual in link.iterfind("visual"):
            size = visual.findtext("geometry/box/size")
            if size:
                edges = self._numbers(size, 3, f"{out.name}: a box's size")
                pose = self._within(frame, self._pose(visual))
                out.visuals.append((link.get("name", ""), pose, edges))

    def _sizes(self, collision: ElementTree.Element, out: Model) -> Iterator[np.ndarray]:
        """Yields the size of the box around a collision's shape [m]."""
        for shape in collision.iterfind("geometry/*"):
            what = f"{out.name}: a {shape.tag}'s size"
            if shape.tag == "box":
                yield self._numbers(shape.findtext("size", ""), 3, what)
            elif shape.tag in ("cylinder", "capsule", "sphere"):
                (radius,) = self._numbers(shape.findtext("radius", ""), 1, what)
                length = self._numbers(shape.findtext("length", "0"), 1, what)[0]
                length += 0 if shape.tag == "cylinder" else 2 * radius
                yield np.array([2 * radius, 2 * radius, length])
            elif shape.tag not in ("plane", "empty"):
                out.has_meshes = True

    def _pose(self, element: ElementTree.Element) -> np.ndarray:
        numbers = self._numbers(element.findtext("pose", "0 0 0 0 0 0"), 6, "a pose")
        x, y, z, roll, pitch, yaw = numbers
        (cr, cp, cy), (sr, sp, sy) = np.cos(numbers[3:] / 2), np.sin(numbers[3:] / 2)
        quaternion = (
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        )
        return np.array([x, y, z, *quaternion])

    def _numbers(self, text: str, count: int, what: str) -> np.ndarray:
        try:
            numbers = np.array([float(part) for part in text.split()])
        except ValueError:
            numbers = np.zeros(0)
        if len(numbers) != count or not np.isfinite(numbers).all():
            raise WorldError(f"{self._path}: {what} is '{text}'; {count} numbers were expected")
        return numbers

    @staticmethod
    def _within(frame: np.ndarray, inner: np.ndarray) -> np.ndarray:
        if not frame[:6].any():  # as for most of the many parts of markings
            return inner.copy()
        composed: np.ndarray = poses.compose(frame[None], inner[None])[0]
        return composed

    def _found(self, uri: str, folder: Path) -> Path | None:
        """Returns the SDF file of an include's uri, if there is one."""
        name = uri.split("://", 1)[-1]
        places: Iterable[Path] = (folder, files.worlds() / "models", *_model_path())
        for place in places:
            for candidate in (place / name / "model.sdf", place / name):
                if candidate.is_file():
                    return candidate
        return None

    def _parsed(self, file: Path) -> ElementTree.Element | None:
        """Returns the <model> in a file, or None; each file is read once."""
        if file not in self._files:
            try:
                self._files[file] = user_file.read_xml(file).find("model")
            except (OSError, ElementTree.ParseError):
                self._files[file] = None
        return self._files[file]


def _model_path() -> Iterator[Path]:
    for folder in os.environ.get("GAZEBO_MODEL_PATH", "").split(":"):
        if folder:
            yield Path(folder)


def _identity() -> np.ndarray:
    return np.array([0, 0, 0, 0, 0, 0, 1.0])
