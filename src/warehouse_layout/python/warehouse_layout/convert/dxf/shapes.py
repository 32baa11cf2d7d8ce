# SPDX-License-Identifier: Apache-2.0
"""Reads the entities of a DXF drawing, by layer, as shapes in metres."""

import logging
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.convert.common import FormatError, PathName, plural
from warehouse_layout.convert.dxf import outlines as dxf_outlines
from warehouse_layout.convert.dxf.layers import Layers
from warehouse_layout.convert.dxf.outlines import PLACES, Shape

MILLIMETRE = 0.001
SMALL = 2.0  # edge of a hall that was not drawn in millimetres [m]
FINE = 0.02  # largest distance between a curve and its polyline [m]
DEEP = 8  # blocks within blocks, at most
MOST_SHAPES = 1_000_000
FAR = 1e6  # [m] from the origin, at most
TEXTS = ("TEXT", "MTEXT")
NAME_TAGS = ("NAME", "STATION", "ID", "LABEL")


@dataclass
class Drawing:
    """The shapes of a drawing, the texts on layers of stations, and what was left out.

    unknown: what lies on layers that mean nothing here: counts of entities, by layer and sort.
    """

    shapes: list[Shape] = field(default_factory=list)
    texts: list[tuple[np.ndarray, str]] = field(default_factory=list)  # where [m], what
    notes: list[str] = field(default_factory=list)
    unknown: Counter[tuple[str, str]] = field(default_factory=Counter)


def read(path: PathName, layers: Layers) -> Drawing:
    """Returns what a drawing's model space holds. Raises FormatError."""
    flaws: list[str] = []
    document = _document(Path(path), flaws)
    scale = _scale(document)
    out = _drawing(path, document, layers, scale or MILLIMETRE)
    if not scale:
        unit = "millimetres"
        if (
            out.shapes
            and np.ptp(np.concatenate([s.points for s in out.shapes]), axis=0).max() < SMALL
        ):
            out, unit = _drawing(path, document, layers, 1.0), "metres"
        flaws.append(f"$INSUNITS names no unit of length: {unit} were assumed")
    out.notes[:0] = flaws
    return out


def _drawing(path: PathName, document: Any, layers: Layers, scale: float) -> Drawing:
    """Returns what a drawing holds; scale: metres of a unit. Raises FormatError."""
    out = Drawing()
    reader = _Reader(path, layers, scale, out)
    try:
        for entity in document.modelspace():
            reader.take(entity, str(entity.dxf.get("layer", "0")), 0)
    except FormatError:
        raise
    except Exception as error:  # ezdxf raises whatever its reading of a broken entity led to
        raise FormatError(f"{path}: an entity can't be read: {_sentence(error)}") from error
    out.notes += reader.left_out()
    out.shapes = dxf_outlines.joined(out.shapes)
    return out


def _document(path: Path, notes: list[str]) -> Any:
    import ezdxf
    from ezdxf import recover

    # What it mends it writes to the log, which goes to the terminal unless there is a handler.
    logging.getLogger("ezdxf").addHandler(logging.NullHandler())
    try:
        return ezdxf.readfile(str(path))
    except OSError as error:
        why = error.strerror or f"is not a DXF drawing: {_begin(path)}"
        raise FormatError(f"{path}: {why}") from error
    except Exception:  # a flawed file: ezdxf can mend many
        try:
            document, auditor = recover.readfile(str(path))
        except ezdxf.DXFError as error:
            raise FormatError(f"{path}: is not a DXF drawing: {_sentence(error)}") from error
        except Exception as error:  # ezdxf stumbled: its words say nothing about the file
            raise FormatError(f"{path}: is not a DXF drawing: {_begin(path)}") from error
    faults = len(auditor.errors) + len(auditor.fixes)
    notes.append(f"the file is flawed: {plural(faults, 'fault')} mended or left out")
    return document


def _begin(path: Path) -> str:
    """Returns what a file begins with instead of a drawing's first section."""
    with open(path, "rb") as file:
        head = file.read(6)
    if re.fullmatch(rb"AC10\d\d", head):
        return "it is a DWG, which only CAD programs read; save it as DXF there"
    return f"it begins with {head!r}, and has no section of entities" if head else "it is empty"


def _sentence(error: Exception) -> str:
    return " ".join(str(error).split())[:120] or type(error).__name__


def _scale(document: Any) -> float:
    """Returns the metres of a unit of the drawing, 0 where it names none."""
    from ezdxf import units

    unit = document.header.get("$INSUNITS", 0)
    try:
        return float(units.conversion_factor(unit, units.M)) if unit else 0.0
    except (KeyError, TypeError, ValueError, IndexError):
        return 0.0


class _Reader:
    def __init__(self, path: PathName, layers: Layers, scale: float, out: Drawing) -> None:
        self._path, self._layers, self._scale, self._out = path, layers, scale, out
        self._unread: Counter[tuple[str, str]] = Counter()
        self._extents: dict[tuple[str, ...], np.ndarray] = {}  # of blocks, about their places

    def take(self, entity: Any, layer: str, depth: int) -> None:
        """Adds an entity on a layer, or those of its block."""
        kind = self._layers.kind(layer)
        what = entity.dxftype()
        if what == "INSERT":
            self._insert(entity, layer, kind, depth)
        elif not kind:
            self._out.unknown[layer, what] += 1
        elif what in TEXTS:
            self._text(entity)
        else:
            self._figure(entity, kind, layer)
        if len(self._out.shapes) > MOST_SHAPES:
            raise FormatError(f"{self._path}: more than {MOST_SHAPES} shapes")

    def left_out(self) -> Iterator[str]:
        """Yields a sentence for each layer and each sort of entity that means nothing here."""
        for layer, sorts in by_layer(self._out.unknown).items():
            yield f"layer '{layer}': {sorts} left out; --layers can say what it holds"
        for (layer, what), count in self._unread.items():
            yield f"layer '{layer}': {plural(count, what)} left out; it has no shape in the plane"

    def _insert(self, insert: Any, layer: str, kind: str, depth: int) -> None:
        if depth > DEEP:
            raise FormatError(f"{self._path}: blocks lie in blocks, more than {DEEP} deep")
        for copy in insert.multi_insert() if insert.mcount > 1 else [insert]:
            if kind in PLACES:
                self._place(copy, kind)
                continue
            for part in copy.virtual_entities():
                inner = str(part.dxf.get("layer", "0"))
                # What lies on layer 0 of a block takes the layer of its insert.
                self.take(part, layer if inner == "0" else inner, depth + 1)

    def _place(self, insert: Any, kind: str) -> None:
        """Adds a block: the rectangle about what is drawn in it."""
        at = np.array(tuple(insert.dxf.insert)[:2])
        how = (insert.dxf.xscale, insert.dxf.yscale, insert.dxf.rotation, insert.dxf.extrusion)
        key = (insert.dxf.name, *map(str, how))
        if key not in self._extents:  # thousands of shelves are of one block
            self._extents[key] = _extent(insert) - at
        metres = self._metres(self._extents[key] + at, insert)
        name = next((a.dxf.text for a in insert.attribs if a.dxf.tag.upper() in NAME_TAGS), "")
        self._add(Shape(kind, metres, closed=True, name=name))

    def _text(self, entity: Any) -> None:
        text = entity.plain_text() if entity.dxftype() == "MTEXT" else entity.dxf.text
        at = self._metres([tuple(entity.dxf.insert)[:2]], entity)[0]
        self._out.texts.append((at, " ".join(text.split())))

    def _figure(self, entity: Any, kind: str, layer: str) -> None:
        from ezdxf import path as paths

        what = entity.dxftype()
        if what == "POINT":
            self._add(Shape(kind, self._metres([tuple(entity.dxf.location)[:2]], entity)))
            return
        try:
            outlines = (
                list(paths.from_hatch(entity)) if what == "HATCH" else [paths.make_path(entity)]
            )
        except TypeError:
            self._unread[layer, what] += 1
            return
        for outline in outlines:
            points = (
                [(p.x, p.y) for p in outline.flattening(FINE / self._scale)] if len(outline) else []
            )
            if points:
                filled = what in ("HATCH", "SOLID", "TRACE")
                metres = self._metres(points, entity)
                self._add(Shape(kind, metres, closed=outline.is_closed or filled, filled=filled))

    def _metres(self, points: Iterable[Iterable[float]], entity: Any) -> np.ndarray:
        out = np.array([list(p) for p in points], float) * self._scale
        if not (np.abs(out) <= FAR).all():
            raise FormatError(
                f"{self._path}: {entity.dxftype()} {entity.dxf.get('handle', '')} is not within"
                f" {FAR:g} m of the origin"
            )
        return out

    def _add(self, shape: Shape) -> None:
        self._out.shapes.append(shape)


def _extent(insert: Any) -> np.ndarray:
    """Returns the corners (4, 2) of the rectangle about a block, where it is inserted."""
    from ezdxf import bbox

    drawn = [p for p in insert.virtual_entities() if p.dxftype() not in (*TEXTS, "ATTDEF")]
    box = bbox.extents(drawn)
    (x, y, _), (u, v, _) = (box.extmin, box.extmax) if box.has_data else 2 * (insert.dxf.insert,)
    return np.array([(x, y), (u, y), (u, v), (x, v)])


def by_layer(counts: Counter[tuple[str, str]]) -> dict[str, str]:
    """Returns what lies on each layer: `12 LINE, 1 CIRCLE`."""
    out: dict[str, list[str]] = {}
    for (layer, sort), count in counts.items():
        out.setdefault(layer, []).append(f"{count} {sort}")
    return {layer: ", ".join(texts) for layer, texts in out.items()}
