# SPDX-License-Identifier: Apache-2.0
"""Places the warehouses of layout files in the running world."""

import os

import numpy as np

from warehouse_client.engine import Engine
from warehouse_layout.file import files, layout_file
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.floor.plan_reader import UNIT, occupancy_of
from warehouse_layout.generate import layout_choice, layout_world
from warehouse_layout.models import models
from warehouse_layout.place import placement
from warehouse_layout.place.layout import SEED, Layout

TAKEN = 100  # in the world's map: a cell of an object outside warehouses


def is_file(name: str) -> bool:
    """Returns whether a warehouse's name is that of a layout file."""
    if layout_choice.is_preset(name):
        return False
    return name.endswith(layout_file.SUFFIX) or os.sep in name


def _whole(name: str) -> str:
    """Returns the whole path of a layout file, and the name of a preset as it is."""
    return str(layout_choice.path_of(name)) if is_file(name) else name


class LayoutBuilding:
    """Places layouts. `world` is the world's file, if it was named; `seed` draws parking and
    contents.

    `launched`: the layout with which the launch began, a file or a preset. `robots` overrides its
    number of robots, if not empty. Raises LayoutFileError for a layout that can't be read.
    """

    def __init__(
        self, seed: int = SEED, world: str = "", launched: str = "", robots: str = ""
    ) -> None:
        self._seed = seed
        is_path = launched and not layout_choice.is_preset(launched)
        self._launched = str(layout_choice.path_of(launched)) if is_path else launched
        self._robots = int(robots) if robots else None
        self._world = world or self._building()

    def _building(self) -> str:
        """Returns the hall of the launched layout; "" if it names none."""
        if not is_file(self._launched):
            return ""
        hall = layout_choice.building_of(layout_choice.chosen(self._launched), files.worlds())
        return str(hall or "")

    @property
    def launched(self) -> str:
        """The preset or the whole path of the layout with which the launch began."""
        return self._launched

    @property
    def has_hall(self) -> bool:
        """Whether warehouses stand on the floor of a world with its own file."""
        return bool(self._world)

    def takes(self, name: str) -> bool:
        """Returns whether place() builds a warehouse of that name: a layout file, or the launched
        preset with a number of robots of its own."""
        return is_file(name) or bool(name and name == self._launched and self._robots)

    def place(self, name: str, engine: Engine) -> tuple[str, str, Layout]:
        """Returns a warehouse's name, the path of its file, and its Layout.

        The path of a preset is "". Raises LayoutFileError.
        """
        name = _whole(name)
        file = self._in_hall(layout_choice.chosen(name))
        robots = self._robots if name == self._launched else None
        layout_choice.check(file, robots)
        laid = placement.place(file, self._seed, robots)
        self._check_room(file, laid, engine)
        return file.title, name if is_file(name) else "", laid

    def check_grid(self, engine: Engine) -> None:
        """Raises LayoutFileError where the world's grid is not that of presets."""
        if self._launched:
            grid = engine.map().info.resolution
            layout_world.check_grid(LayoutFile(np.zeros((1, 1)), name="a preset"), grid)

    def _in_hall(self, file: LayoutFile) -> LayoutFile:
        """Returns the file as it stands in the hall of this world, or unchanged without a hall."""
        hall = layout_choice.world_named(self._world) if self._world else None
        own = layout_choice.building_of(file, files.worlds())
        if own and not (hall and own.samefile(hall)):
            raise LayoutFileError(
                f"{file.path}: it stands in {own}, which is not this world: launch it by layout:="
            )
        return layout_choice.in_building(file, hall) if hall and not own else file

    def _check_room(self, file: LayoutFile, laid: Layout, engine: Engine) -> None:
        grid = engine.map()
        info, corner = grid.info, grid.info.origin.position
        occupancy = occupancy_of(grid)
        # Belts and units are replaced with their warehouse; its walls look like the hall's.
        occupancy[occupancy < TAKEN] = UNIT
        if f"{models.WALLS}1" in engine.names():
            occupancy[:] = UNIT
        half = info.resolution / 2
        layout_world.check_room(
            file, laid, corner.x + half, corner.y + half, info.resolution, occupancy
        )
