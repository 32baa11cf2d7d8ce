# SPDX-License-Identifier: Apache-2.0
"""What a world needs to hold the warehouse of a layout file."""

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Protocol

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.generate import layout_choice, layout_world
from warehouse_layout.models import models
from warehouse_layout.place import placement
from warehouse_layout.place.layout import SEED, Layout


class Hall(Protocol):
    """A world around a warehouse: what stands there can be read and deleted, as of World."""

    @property
    def names(self) -> Sequence[str]:
        """The names of all models."""
        ...

    def delete(self, name: str) -> Any:
        """Deletes a model."""
        ...

    def occupancy(self) -> tuple[Any, ...]:
        """Returns x, y [m] of cell (0, 0), the spacing [m] and the cells' values, (h, w) uint8."""
        ...


def preset_of(named: LayoutFile | str | os.PathLike[str]) -> str:
    """Returns the name of a preset; "" where a layout file is named."""
    if isinstance(named, LayoutFile):
        return ""
    name = os.fspath(named)
    return name if layout_choice.is_preset(name) else ""


@contextmanager
def laid_out(
    named: LayoutFile | str | os.PathLike[str], robots: int | None, options: dict[str, Any]
) -> Iterator[tuple[LayoutFile, Layout, dict[str, Any]]]:
    """Yields a layout's file, the Layout, and the options of the World in which it is to stand.

    The world's file is there within the `with` block. robots: overrides the file's count. Raises
    ValueError.
    """
    if "world" in options:
        raise ValueError("world: a layout names its own, as `building`")
    file = named if isinstance(named, LayoutFile) else layout_choice.chosen(named)
    layout_choice.check(file, robots)
    if file.measured and options.get("realism") is None:
        options = options | {"realism": file.beside_file(file.measured)}
    laid = placement.place(file, options.get("seed", SEED), robots)
    with tempfile.TemporaryDirectory() as made:
        yield file, laid, options | {"world": layout_world.world_of(file, made)}


def check_hall(world: Hall, file: LayoutFile, laid: Layout) -> None:
    """Raises LayoutFileError where something of a hall stands on the floor of the layout.

    world: the hall; the models of a warehouse that stand in it are deleted.
    """
    clear(world)
    layout_world.check_room(file, laid, *world.occupancy())


def clear(world: Hall) -> None:
    """Deletes the models of a warehouse from a world; those with other names stay."""
    for kind in models.PLACED:
        # Asked for again each time: items go with the storage unit on which they lie.
        for name in list(world.names):
            if models.kind_and_number(name)[0] == kind:
                world.delete(name)
