# SPDX-License-Identifier: Apache-2.0
"""What is painted on the floor, as the world's Scenery tells it."""

from warehouse_layout import FloorError, floor_markings


def marks(scenery):
    """floor_markings.Marks; none where they can't be read."""
    try:
        return floor_markings.of_scenery(scenery)
    except FloorError:
        return []


def served(marks):
    """Those at which units are served."""
    return [m for m in marks if m.kind == floor_markings.SERVICE]
