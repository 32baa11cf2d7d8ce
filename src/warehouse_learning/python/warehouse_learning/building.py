# SPDX-License-Identifier: Apache-2.0
"""Worlds to learn in: robots with or without lasers, quick or slow, and as many worlds as asked
for, all alike."""

import tempfile
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from typing import Any

from kiva_plugin_cpp import World, Worlds, layouts, worlds_folder
from warehouse_layout.file import request
from warehouse_layout.generate import generated, layout_choice, layout_world
from warehouse_layout.place import layout, placement
from warehouse_learning.options import Options


def build(n: int, options: Options, threads: int = 0) -> tuple[Worlds, Any]:
    """Returns (Worlds, checkpoint): n worlds before an episode, and that state to return to."""
    with tempfile.TemporaryDirectory() as folder:
        write_kiva(Path(folder), options.acceleration, options.lift_time, options.lasers)
        laid, hall = _laid_out(options, folder)
        first = World.of_layout(laid, world=hall, model_paths=[folder])
    first.step_size = options.physics_step
    checkpoint = first.checkpoint()
    others = [World() for _ in range(n - 1)]
    for world in others:
        world.restore(checkpoint)
    return Worlds.of([first, *others], threads), checkpoint


def _laid_out(options: Options, folder: str) -> tuple[layout.Layout, str | Path]:
    """Returns a Layout without items, which nothing asks for here, and the world around it."""
    if not options.layout:
        resolved = request.resolve("", robots=options.robots, shelves=options.shelves)
        return generated.plan(resolved), "empty"
    file = replace(layout_choice.chosen(options.layout), items=0, stock="")
    laid = placement.place(file, robots=options.robots)
    hall = layout_world.world_of(file, folder)
    if not laid.has_own_floor:
        layouts.check_hall(World(hall), file, laid)
    return laid, hall


def _part(element: ElementTree.Element, tag: str) -> ElementTree.Element:
    """The first child of that tag. Raises ValueError."""
    child = element.find(tag)
    if child is None:
        raise ValueError(f"<{element.tag}> has no <{tag}>")
    return child


def write_kiva(folder: Path, acceleration: float, lift_time: float, lasers: bool) -> None:
    """Writes the Kiva of worlds/models with another lift, another acceleration [m/s², s], and maybe
    without a laser, as folder/kiva."""
    own = worlds_folder() / "models" / "kiva"
    document = ElementTree.parse(own / "model.sdf")
    model = _part(document.getroot(), "model")
    plugins = {plugin.get("name"): plugin for plugin in model.findall("plugin")}
    _part(plugins["motion"], "acceleration").text = repr(float(acceleration))
    _part(plugins["lift"], "time").text = repr(float(lift_time))
    if not lasers:
        model.remove(plugins["laser"])
    (folder / "kiva").mkdir()
    document.write(folder / "kiva" / "model.sdf", encoding="unicode")
    (folder / "kiva" / "model.config").write_text((own / "model.config").read_text())
