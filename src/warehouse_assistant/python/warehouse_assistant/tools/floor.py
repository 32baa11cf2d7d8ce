# SPDX-License-Identifier: Apache-2.0
"""Tool: the floor as a picture."""

import asyncio
from typing import Any

from mcp.server.mcpserver import Image

from warehouse_assistant.hub_client import Simulation as Client
from warehouse_assistant.toolbox import Simulation, Toolbox
from warehouse_assistant.words import count, quoted

MOST_ROWS, MOST_PAGES = 1000, 20


def add(box: Toolbox) -> None:
    """Adds the tool to a Toolbox."""

    @box.reads("Show the floor")
    async def picture_of_floor(simulation: Simulation = "") -> list[Any]:
        """Draws the floor from above as PNG: robots by what they do, storage units, stations."""
        warehouse = await box.hub.simulation(simulation)
        robots = await _rows(warehouse, "robots", "robots")
        units = await _rows(warehouse, "storage_units", "things")
        stations = ((await warehouse.get_or_none("stations")) or {}).get("stations", [])
        picture = await asyncio.to_thread(_png, robots, units, stations)
        about = f"{count(len(robots), 'robot')} and {count(len(units), 'storage unit')}"
        return [f"{quoted(warehouse.name)}: {about}.", Image(data=picture, format="png")]


def _png(*rows: Any) -> bytes:
    # Pillow takes 10 MB, and most assistants never ask for a picture.
    from warehouse_assistant import floor_picture

    return floor_picture.png(*rows)


async def _rows(warehouse: Client, path: str, key: str) -> list[Any]:
    """Returns all rows of a list that comes in pages."""
    out: list[Any] = []
    for page in range(MOST_PAGES):
        answer = await warehouse.get(path, limit=MOST_ROWS, offset=page * MOST_ROWS)
        out += answer[key]
        if len(out) >= answer["total"] or not answer[key]:
            break
    return out
