# SPDX-License-Identifier: Apache-2.0
"""Layouts, reports and pages of the documentation as resources of the protocol."""

import json
from typing import Any
from urllib.parse import quote, unquote

from mcp.server import MCPServer
from mcp.server.mcpserver.exceptions import ResourceError

from warehouse_assistant.hub_client import HubClient, Trouble
from warehouse_assistant.library import Library

REPORTED = ("kpis", "figures", "stations")
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

    @server.resource("warehouse://reports", title="Reports", mime_type="text/plain")
    async def reports() -> str:
        """The addresses of the reports of shifts that run and of what-if runs, a line each."""
        rows = (await _asked(hub.get("/api/v1/simulations")))["simulations"]
        shifts = [f"warehouse://reports/shift/{row['name']}" for row in rows if row.get("orders")]
        runs = (await _asked(hub.get("/whatif/scenarios")))["scenarios"]
        names = (quote(row["name"], safe="") for row in runs if row.get("summary"))
        return "\n".join([*shifts, *(f"warehouse://reports/what-if/{name}" for name in names)])

    @server.resource(
        "warehouse://reports/shift/{simulation}", title="Report", mime_type="application/json"
    )
    async def shift_report(simulation: str) -> str:
        """The figures of a shift so far, its stations, and figures against targets."""
        warehouse = await _asked(hub.simulation(simulation))
        parts = {name: await _asked(warehouse.get_or_none(name)) for name in REPORTED}
        if parts["kpis"] is None:
            raise ResourceError(f"No shift runs in {simulation}. List warehouse://reports.")
        return json.dumps(parts)

    @server.resource(
        "warehouse://reports/what-if/{name}", title="Report", mime_type="application/json"
    )
    async def what_if_report(name: str) -> str:
        """The settings and figures of a what-if run."""
        runs = (await _asked(hub.get("/whatif/scenarios")))["scenarios"]
        for row in runs:
            if row["name"] == unquote(name) and row.get("summary"):
                return json.dumps({key: row[key] for key in ("name", "settings", "summary")})
        raise ResourceError(
            "There is no such what-if run that has ended. List warehouse://reports."
        )

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
