# SPDX-License-Identifier: Apache-2.0
"""The argument layout:= of the launch files, and its conflicts with others."""

import os
from collections.abc import Mapping
from pathlib import Path

from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.generate import layout_choice, layout_world
from warehouse_layout.place import placement

NONE = "none"


def fault(text: str, cwd: Path) -> str:
    """Returns the reasons why no warehouse can be built of it, a sentence a line; "" without
    any."""
    if not text or layout_choice.is_preset(text):
        return ""
    try:
        file = layout_choice.chosen(text, cwd)
        layout_choice.check(file)
        return _fault_of_shift(file)
    except LayoutFileError as error:
        return str(error)


def _fault_of_shift(file: LayoutFile) -> str:
    if not file.policies:
        return ""
    from warehouse_operations.runs import layout_site

    return layout_site.fault(file)


def conflicts(values: Mapping[str, str], worlds: Path, cwd: Path) -> list[str]:
    """Returns sentences about valid arguments {name: text} that contradict layout:=."""
    layout, robots = values.get("layout", ""), values.get("robots", "")
    if not layout:
        return [f"robots:={robots}: it is for layout:="] if robots else []
    faults = [
        f"{name}:={values[name]}: with layout:={layout} it was expected to be left out"
        for name in ("size", "at", "replay")
        if values.get(name, "") not in ("", NONE)
    ]
    try:
        return faults or _in_world(layout, values.get("world", ""), int(robots or -1), worlds, cwd)
    except LayoutFileError as error:
        return [f"layout:={layout}: {error}"]


def _in_world(layout: str, world: str, robots: int, worlds: Path, cwd: Path) -> list[str]:
    if layout_choice.is_preset(layout) and robots < 0:
        return [f"world:={world}: a layout file was expected, or size:={layout}"] if world else []
    file = layout_choice.chosen(layout, cwd)
    if robots >= 0:
        layout_choice.check(file, robots)
    hall = layout_choice.building_of(file, worlds)
    named = layout_choice.world_named(world, cwd) if world else None
    if named and hall and not hall.samefile(named):
        return [f"world:={world}: layout:={layout} stands in {hall}"]
    if named or hall:
        _check_hall(layout_choice.in_building(file, named) if named else file, robots)
    return []


def _check_hall(file: LayoutFile, robots: int) -> None:
    from kiva_plugin_cpp import World, layouts

    hall = layout_world.world_of(file, Path())
    laid = placement.place(file, robots=robots if robots >= 0 else None)
    layouts.check_hall(World(hall), file, laid)


def world_of(layout: str, world: str, cwd: Path, home: Path) -> str:
    """Returns the world for a layout, in the form of the world node's argument.

    A world with another grid than 1 m is written into a folder below `home`. Raises
    LayoutFileError.
    """
    if world or layout_choice.is_preset(layout):
        return world
    return os.fspath(layout_world.world_of(layout_choice.chosen(layout, cwd), home / "warehouse"))
