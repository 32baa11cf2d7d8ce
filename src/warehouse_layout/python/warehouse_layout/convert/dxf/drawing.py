# SPDX-License-Identifier: Apache-2.0
"""Drawings, `.dxf`: layers named walls, storage, station and so on (see dxf_layers) become cells.

The cells lie so that places are in their middles; without places, as the walls begin. What walls
enclose is floor, or what the layer `floor` outlines.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from warehouse_layout.convert import straight
from warehouse_layout.convert.common import FormatError, PathName, check_spacing
from warehouse_layout.convert.dxf import cells as dxf_cells
from warehouse_layout.convert.dxf import layers as dxf_layers
from warehouse_layout.convert.dxf import shapes as dxf_shapes
from warehouse_layout.convert.dxf.shapes import Drawing
from warehouse_layout.file.layout_file import LayoutFile

MOST_NAMED = 20  # layers that a sentence names, at most


def read(
    path: PathName,
    layers: Path | None = None,
    spacing: float | None = None,
    angle: float | None = None,
) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a drawing, and what was left out or changed.

    `layers` is a YAML file that maps layers to ours; `spacing` the edge of a cell [m], 1 m by
    default; `angle` [rad] by which the drawing is turned about z, by default as its walls lie.
    Raises FormatError.
    """
    spacing = check_spacing(path, spacing)
    drawing = dxf_shapes.read(path, dxf_layers.read(layers))
    if not drawing.shapes:
        raise FormatError(f"{path}: {_unnamed(drawing)}")
    angle = _angle(drawing) if angle is None else angle
    if angle:
        drawing.notes.append(f"turned by {math.degrees(angle):.2f} degrees")
        drawing.shapes = [
            replace(s, points=straight.turned(s.points, angle)) for s in drawing.shapes
        ]
        drawing.texts = [(straight.turned(at, angle), text) for at, text in drawing.texts]
    return dxf_cells.layout_of(path, drawing, spacing), drawing.notes


def _unnamed(drawing: Drawing) -> str:
    """Returns a sentence about a drawing that has no layer of ours, and what to write."""
    ours = f"no layer is named as one of ours: {', '.join(dxf_layers.NAMES)}"
    layers = dxf_shapes.by_layer(drawing.unknown)
    if not layers:
        return f"{ours}; its model space is empty"
    shown = [f"'{layer}' ({sorts})" for layer, sorts in list(layers.items())[:MOST_NAMED]]
    more = [f"{len(layers) - MOST_NAMED} more"] if len(layers) > MOST_NAMED else []
    there = ", ".join([*shown, *more])
    return f"{ours}; there are {there}. --layers FILE maps them, with {dxf_layers.proposed(layers)}"


def _angle(drawing: Drawing) -> float:
    lines = [np.diff(s.points, axis=0) for s in drawing.shapes if s.kind == "walls"]
    return straight.angle_of_lines(np.concatenate(lines)) if sum(map(len, lines)) else 0.0
