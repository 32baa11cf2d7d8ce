# SPDX-License-Identifier: Apache-2.0
"""Builds a Site without a world, as of an instance, as a world with physics."""

import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout.models.world_file import with_values

if TYPE_CHECKING:
    from kiva_plugin_cpp import World
    from warehouse_operations.stock.site import Site


def world_of(site: "Site", **options: Any) -> "tuple[World, Site]":
    """Returns a kiva_plugin_cpp.World of a Site, and the Site as it stands there.

    Cell (0, 0) is at the origin of world. Robots have the Site's kinematics and face +x. options:
    those of World.of_layout().
    """
    from kiva_plugin_cpp import World, worlds_folder
    from warehouse_layout.place import layout

    plan = replace(site.plan, origin=(0.0, 0.0))
    (height, width), spacing = plan.shape, plan.spacing

    def points(cells: Mapping[int, int]) -> np.ndarray:
        return np.column_stack(plan.point_of(np.array(list(cells.values()), int)))

    low = -spacing / 2
    laid = layout.Layout(
        floor=layout.Floor(low, low + width * spacing, low, low + height * spacing),
        robots=np.pad(points(site.robots), ((0, 0), (0, 1))),
        units=points(site.units),
        plan=plan,
    )
    folder = worlds_folder()
    with tempfile.TemporaryDirectory() as made:
        world_file = Path(made, "instance.sdf")
        text = (folder / "empty.sdf").read_text(encoding="utf-8")
        world_file.write_text(with_values(text, spacing=spacing), encoding="utf-8")
        robot = Path(made, "kiva")
        robot.mkdir()
        for part in (folder / "models" / "kiva").iterdir():
            (robot / part.name).write_bytes(part.read_bytes())
        _set_kinematics(robot / "model.sdf", site.kinematics)
        world = World.of_layout(laid, world=world_file, model_paths=[made], **options)
    return world, replace(site, plan=plan)


def _set_kinematics(path: Path, kinematics: Kinematics) -> None:
    text = with_values(
        path.read_text(encoding="utf-8"),
        speed=kinematics.speed,
        acceleration=kinematics.acceleration,
        quarter_turn_time=kinematics.quarter_turn,
        time=kinematics.lift,
    )
    path.write_text(text, encoding="utf-8")
