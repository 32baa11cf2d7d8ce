# SPDX-License-Identifier: Apache-2.0
"""Worlds in which the warehouse of a layout file stands."""

import os
import tempfile
from typing import TYPE_CHECKING, Any

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.generate import layout_choice, layout_world
from warehouse_layout.models import models
from warehouse_layout.place import placement
from warehouse_layout.place.layout import SEED, Layout

if TYPE_CHECKING:
    from kiva_plugin_cpp import World


def world_of(
    kind: "type[World]",
    named: LayoutFile | str | os.PathLike[str],
    robots: int | None = None,
    **options: Any,
) -> "World":
    """Returns a world of that class; see World.layout."""
    if "world" in options:
        raise ValueError("world: a layout names its own, as `building`")
    if isinstance(named, LayoutFile):
        file = named
    elif robots is None and layout_choice.is_preset(os.fspath(named)):
        return kind.preset(os.fspath(named), **options)
    else:
        file = layout_choice.chosen(named)
    layout_choice.check(file, robots)
    laid = placement.place(file, options.get("seed", SEED), robots)
    with tempfile.TemporaryDirectory() as made:
        options["world"] = layout_world.world_of(file, made)
        if laid.has_own_floor:
            return kind.of_layout(laid, own_models=True, **options)
        check_hall(kind(**options), file, laid)
        return kind.of_layout(laid, own_models=True, **options)


def check_hall(world: "World", file: LayoutFile, laid: Layout) -> None:
    """Raises LayoutFileError where something of a hall stands on the floor of the layout.

    world: the hall; the models of a warehouse that stand in it are deleted.
    """
    clear(world)
    layout_world.check_room(file, laid, *world.occupancy())


def clear(world: "World") -> None:
    """Deletes the models of a warehouse from a world; those with other names stay."""
    for kind in models.PLACED:
        # Asked for again each time: items go with the storage unit on which they lie.
        for name in list(world.names):
            if models.kind_and_number(name)[0] == kind:
                world.delete(name)
