# SPDX-License-Identifier: Apache-2.0
"""Reads and writes layouts in the formats of others, recognised by the content of a file.

Where the content is ambiguous, the suffix decides; what is written goes by the name.

    notes = formats.convert(Path("hall.dxf"), Path("hall.layout.yaml"))
    for sentence in notes:                         # what could not be carried over
        print(sentence)

In: .layout.yaml, .sdf, .world, .xinst, .xlayo, .map, map.yaml, .lif.json, .dxf, .xml (openTCS),
.csv, .xlsx.
Out: .layout.yaml, .sdf, .map, .lif.json, .svg, .png.
"""

import importlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from warehouse_layout.convert import detect
from warehouse_layout.convert.common import FormatError, Note, within_limits
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile

__all__ = ["FormatError", "Note", "convert", "read", "write"]

LAYOUT = lf.SUFFIX
# By the end of a file's name, the longest first: the module that reads it, and that which writes.
READERS = {
    LAYOUT: "file.layout_file",
    ".lif.json": "convert.graphs.lif",
    ".xinst": "convert.rawsim.xinst",
    ".xlayo": "convert.rawsim.xlayo",
    ".world": "convert.from_world",
    ".yaml": "convert.maps.ros_map",
    ".yml": "convert.maps.ros_map",
    ".sdf": "convert.from_world",
    ".map": "convert.maps.grid_map",
    ".dxf": "convert.dxf.drawing",
    ".lif": "convert.graphs.lif",
    ".json": "convert.graphs.lif",
    ".xml": "convert.graphs.opentcs",
    ".xlsx": "convert.maps.grid_table",
    ".csv": "convert.maps.grid_table",
    ".tsv": "convert.maps.grid_table",
}
WRITERS = {
    LAYOUT: "file.layout_file",
    ".lif.json": "convert.graphs.lif_writer",
    ".lif": "convert.graphs.lif_writer",
    ".sdf": "models.world_export",
    ".map": "convert.maps.grid_map",
    ".svg": "drawing.draw",
    ".png": "drawing.draw",
}
WITHOUT_ELEVATORS = (".lif.json", ".lif", ".map")


def convert(
    source: Path,
    target: Path,
    layers: Path | None = None,
    spacing: float | None = None,
    angle: float | None = None,
) -> list[str]:
    """Reads a layout in one format and writes it in another; see read() for the options.

    Returns sentences about what could not be carried over. Raises FormatError, and writes nothing,
    for a file that can't be read.
    """
    _module(target, WRITERS, "written")
    file, notes = read(source, layers, spacing, angle)
    return [*notes, *write(file, target)]


def read(
    path: Path, layers: Path | None = None, spacing: float | None = None, angle: float | None = None
) -> tuple[LayoutFile, list[str]]:
    """Returns the layout in a file, and sentences about what could not be carried over.

    `layers` is a YAML file that maps layers of a .dxf to ours. `spacing` is the edge of a cell [m]
    for drawings and maps without cells (1 m by default), `angle` [rad] by which they are turned
    about z to lie along the axes (by default as their walls are). Raises FormatError.
    """
    path = Path(path)
    held = detect.module_of(path)
    module = _imported(path, held) if held else _module(path, READERS, "read")
    kind = module.__name__.rpartition(".")[2]
    options: dict[str, Any] = {}
    if kind in ("drawing", "ros_map", "grid_table"):
        options["spacing"] = spacing
    if kind in ("drawing", "ros_map"):
        options["angle"] = angle
    if kind == "drawing":
        options["layers"] = layers
    file, notes = _checked(path, lambda: _with_notes(module.read(path, **options)))
    if module is lf:
        return file, notes
    file = replace(file, name=file.name or path.name.split(".")[0])
    return within_limits(file, notes)


def write(file: LayoutFile, path: Path) -> list[str]:
    """Writes a layout; returns what the format can't hold. Raises FormatError."""
    path = Path(path)
    module = _module(path, WRITERS, "written")
    writer = module.draw if module.__name__.endswith(".draw") else module.write
    notes = _checked(path, lambda: list(writer(file, path) or []))
    if file.elevators and path.name.lower().endswith(WITHOUT_ELEVATORS):
        names = ", ".join(elevator.name for elevator in file.elevators)
        notes.append(f"elevators are left out, and tiers lie beside each other: {names}")
    return notes


def _with_notes(answer: Any) -> tuple[LayoutFile, list[str]]:
    return (answer, []) if isinstance(answer, LayoutFile) else answer


def _checked(path: Path, action: Callable[[], Any]) -> Any:
    """Returns what the action does; what is wrong with the file becomes a FormatError."""
    try:
        return action()
    except FormatError:
        raise
    except (MemoryError, RecursionError) as error:
        raise FormatError(f"{path}: it is too large or too deep to be read") from error
    except ModuleNotFoundError as error:
        raise FormatError(f"{path}: for this format the package {error.name} is missing") from error
    except (ValueError, OSError) as error:
        text = str(error)
        raise FormatError(text if text.startswith(str(path)) else f"{path}: {text}") from error


def _imported(path: Path, module: str) -> Any:
    return _checked(path, lambda: importlib.import_module(f"warehouse_layout.{module}"))


def _module(path: Path, modules: dict[str, str], verb: str) -> Any:
    name = Path(path).name.lower()
    for suffix, module in modules.items():
        if name.endswith(suffix):
            return _imported(path, module)
    if verb == "read" and not Path(path).exists():
        raise FormatError(f"{path}: No such file or directory")
    known = ", ".join(modules)
    raise FormatError(f"{path}: no format that can be {verb}: known are {known}")
