# SPDX-License-Identifier: Apache-2.0
"""The world in which a layout's warehouse is built: an empty floor with its grid, or its hall."""

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.file import files
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.floor.plan_reader import is_taken
from warehouse_layout.generate.layout_choice import building_of
from warehouse_layout.models.world_file import with_values
from warehouse_layout.place import placement
from warehouse_layout.place.layout import Layout

NAMED = 6  # cells that a sentence names, at most
ROUNDING = 1e-6  # of a spacing: maps have it in single precision


def world_of(file: LayoutFile, folder: str | Path) -> Path:
    """Returns the world file of a layout; one with another grid than 1 m is written into `folder`.

    Raises LayoutFileError.
    """
    hall = building_of(file, files.worlds())
    if hall:
        return hall
    empty = files.worlds() / "empty.sdf"
    if file.spacing == 1:
        return empty
    path = Path(folder) / f"empty-{file.spacing!r}.sdf"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        text = empty.read_text(encoding="utf-8")
        path.write_text(with_values(text, spacing=file.spacing), encoding="utf-8")
    except OSError as error:
        raise LayoutFileError(f"{path}: {error.strerror}") from error
    return path


def check_grid(file: LayoutFile, spacing: float) -> None:
    """Raises LayoutFileError unless the grid of a world [m] is that of the layout."""
    if abs(spacing - file.spacing) > ROUNDING * spacing:
        raise LayoutFileError(
            f"{file.path or file.title}: spacing is {file.spacing:g} m, but the grid of the world"
            f" is {spacing:g} m: only a launch with layout:= begins a world with another grid"
        )


def check_room(
    file: LayoutFile, laid: Layout, x: float, y: float, spacing: float, occupancy: ArrayLike
) -> None:
    """Raises LayoutFileError where something of a hall stands on the floor of the layout.

    x, y, spacing, occupancy: the map of the hall without the warehouse, as World.occupancy() has
    it.
    """
    check_grid(file, spacing)
    if laid.plan is None or laid.has_own_floor:
        return
    needed = np.argwhere(laid.plan.passable | _belts(file))
    low = np.round(np.subtract(laid.plan.origin, (x, y)) / spacing).astype(int)
    free = ~is_taken(occupancy)
    row, column = (needed + low[::-1]).T
    inside = (row >= 0) & (row < free.shape[0]) & (column >= 0) & (column < free.shape[1])
    inside[inside] = free[row[inside], column[inside]]
    if not inside.all():
        raise LayoutFileError(_in_the_way(file, [(int(c), int(r)) for r, c in needed[~inside]]))


def _belts(file: LayoutFile) -> np.ndarray:
    return placement.drawn_floor.areas(file.floor).belts


def _in_the_way(file: LayoutFile, cells: list[tuple[int, int]]) -> str:
    named = ", ".join(f"[{column}, {row}]" for column, row in cells[:NAMED])
    more = f" and {len(cells) - NAMED} more" if len(cells) > NAMED else ""
    return (
        f"{file.path or file.title}: something of {file.building} stands at {named}{more}, or its"
        " floor ends there; move the drawing by 'at', or draw 'x' or '#' there"
    )
