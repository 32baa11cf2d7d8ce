# SPDX-License-Identifier: Apache-2.0
"""The markings on the floor of a world, read from its Scenery."""

from collections.abc import Iterable

from warehouse_layout import FloorError
from warehouse_layout.floor import floor_markings
from warehouse_layout.floor.floor_markings import Mark
from warehouse_layout.floor.interfaces import Scenery


def marks(scenery: Scenery) -> list[Mark]:
    """Returns the Marks in a Scenery; none where they can't be read."""
    try:
        return floor_markings.of_scenery(scenery)
    except FloorError:
        return []


def served(marks: Iterable[Mark]) -> list[Mark]:
    """Returns the Marks at which units are served."""
    return [m for m in marks if m.kind == floor_markings.SERVICE]
