# SPDX-License-Identifier: Apache-2.0
"""The layout that a person names, by a file or by a preset, checked before anything is built."""

import os
from dataclasses import replace
from pathlib import Path

from warehouse_layout.file import files, layout_file
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator
from warehouse_layout.models import world_file
from warehouse_layout.place import file_check

EMPTY = "empty"


def is_preset(name: str) -> bool:
    """Returns whether it is the name of a preset, not of a file."""
    return name in PRESETS


def path_of(name: str | os.PathLike[str], folder: str | Path | None = None) -> Path:
    """Returns the whole path of a file that a person named; see chosen()."""
    base = Path(folder) if folder else Path(os.environ.get("PWD", "."))
    return base / Path(name).expanduser()


def chosen(name: str | os.PathLike[str], folder: str | Path | None = None) -> LayoutFile:
    """Returns the LayoutFile of a path or a preset, without checking that a fleet can work there.

    A relative path starts at `folder`: PWD by default, for roslaunch starts its nodes in another
    one than that in which a person typed. Raises LayoutFileError.
    """
    name = os.fspath(name)
    if name == EMPTY:
        raise LayoutFileError("the preset 'empty' has nothing that could be laid out")
    if is_preset(name):
        return generator.of_request(PRESETS[name], name)
    path = path_of(name, folder)
    if not path.exists() and not Path(name).suffix and os.sep not in name:
        raise LayoutFileError(
            f"{path}: there is no such layout file, and '{name}' is not a preset; known are"
            f" {', '.join(PRESETS)}"
        )
    return layout_file.read(path)


def check(file: LayoutFile, robots: int | None = None) -> None:
    """Raises LayoutFileError with a sentence a line about all that hinders a fleet there.

    robots: as many instead of the file's.
    """
    if robots is not None:
        file = replace(file, robots=robots)
    faults = file_check.faults(file)
    if faults:
        name = file.path or file.title
        raise LayoutFileError("\n".join(f"{name}: {fault.text}" for fault in faults))


def world_named(world: str, folder: str | Path | None = None) -> Path:
    """Returns the whole path of a world: a file, or a name in worlds/. Raises LayoutFileError.

    A relative path starts at `folder`: PWD by default.
    """
    try:
        return world_file.find(world, files.worlds(), folder).resolve()
    except world_file.WorldFileError as error:
        raise LayoutFileError(str(error)) from error


def in_building(file: LayoutFile, hall: Path) -> LayoutFile:
    """Returns a file as it stands in a world of others, which is its building then."""
    return replace(file, building=str(hall))


def building_of(file: LayoutFile, worlds: str | Path) -> Path | None:
    """Returns the world file of the hall around a layout, or None.

    Relative paths start at the layout's folder; `worlds` has worlds by name. Raises
    LayoutFileError.
    """
    if not file.building:
        return None
    try:
        return world_file.find(file.building, worlds, file.beside_file(""))
    except world_file.WorldFileError as error:
        raise LayoutFileError(f"{file.path or file.title}: building: {error}") from error
