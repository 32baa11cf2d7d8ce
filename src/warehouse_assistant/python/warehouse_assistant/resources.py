# SPDX-License-Identifier: Apache-2.0
"""Layouts and pages of the documentation as resources of the protocol."""

import json
from typing import Any

from mcp.server import MCPServer
from mcp.server.mcpserver.exceptions import ResourceError

from warehouse_assistant.hub_client import HubClient, Trouble
from warehouse_assistant.library import Library

COUNTS = ("robots", "units", "items", "stations")


def add(server: MCPServer, hub: HubClient, library: Library) -> None:
    """Adds the resources to a server."""

    @server.resource("warehouse://layouts", title="Layouts", mime_type="application/json")
    async def layouts() -> str:
        """The preset layouts with their counts, and the most of each kind."""
        about = await _asked(hub.get("/layout/about"))
        return json.dumps({key: about[key] for key in ("presets", "limits")})

    @server.resource("warehouse://layouts/{preset}", title="Layout", mime_type="application/json")
    async def layout(preset: str) -> str:
        """The drawing of a preset layout: its floor, stations, robots and counts."""
        presets = (await _asked(hub.get("/layout/about")))["presets"]
        if preset not in presets:
            raise ResourceError(f"There is no such preset; {', '.join(presets)} were expected.")
        counts = {name: presets[preset][name] for name in COUNTS}
        return json.dumps(await _asked(hub.send("POST", "/layout/new", counts)))

    @server.resource("warehouse://docs", title="Documentation", mime_type="text/plain")
    async def pages() -> str:
        """The names of all pages of the documentation, a line each."""
        return "\n".join(await _asked(library.pages()))

    @server.resource(
        "warehouse://docs/{room}/{page}", title="Documentation page", mime_type="text/plain"
    )
    async def page(room: str, page: str) -> str:
        """A page of the documentation, such as how-to/http."""
        return await _asked(library.page(f"{room}/{page}"))


async def _asked(asking: Any) -> Any:
    """Returns what a request returns. Raises ResourceError with the text of its Trouble."""
    try:
        return await asking
    except Trouble as error:
        raise ResourceError(str(error)) from error
