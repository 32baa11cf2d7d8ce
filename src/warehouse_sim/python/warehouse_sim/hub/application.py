# SPDX-License-Identifier: Apache-2.0
"""The hub behind one address: its page, its API, and the pages of what runs."""

import asyncio
import socket
from collections.abc import Awaitable, Callable
from pathlib import Path
from types import FrameType

from starlette.applications import Starlette
from starlette.routing import Route
from starlette.types import ASGIApp

from warehouse_sim.hub.api.routes import routes
from warehouse_sim.hub.assistant import Assistant
from warehouse_sim.hub.journal import Journal
from warehouse_sim.hub.recordings import Recordings
from warehouse_sim.hub.simulations import Simulations
from warehouse_sim.hub.sizings import Sizings
from warehouse_sim.hub.what_if import WhatIf
from warehouse_viewer.editor.routes import Editor
from warehouse_viewer.server import documentation
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.http_server import Server, config_of
from warehouse_viewer.server.site import API, DOCS, HUB, LAYOUT, WHATIF, Site

# Requests a second of each address: the pages of several simulations and the assistant's own
# requests come from one.
RATE = 400.0


class Hub:
    """Simulations, recordings, sizings, what-if, editor and documentation.

    run() serves until it is stopped. tokens: the token that every client needs, "": without, and an
    alternative one.
    """

    def __init__(
        self,
        simulations: Simulations,
        recordings: Recordings,
        journal: Journal,
        sizings: Sizings,
        what_if: WhatIf,
        assistant: Callable[[], Assistant],
        tokens: tuple[str, str] = ("", ""),
    ) -> None:
        self._simulations, self._what_if = simulations, what_if
        self._recordings, self._sizings = recordings, sizings
        self._make_assistant = assistant
        self._assistant: Assistant | None = None
        application = Starlette(
            routes=[
                *routes(
                    simulations,
                    recordings,
                    journal,
                    sizings,
                    lambda: self._assistant or Assistant(None, ""),
                ),
                Route(f"{WHATIF.path}/{{rest:path}}", what_if),
                *Editor(compares=True, starts=True).routes(),
                *Site(HUB, LAYOUT, WHATIF, API, DOCS).routes(),
                *documentation.routes(),
            ]
        )
        token, other = tokens
        access = AccessControl(application, token, RATE, other_token=other)
        self.server = _HubServer(access, self._begin, self._end)

    def _begin(self) -> None:
        self._assistant = self._make_assistant()
        self._watching = asyncio.create_task(self._simulations.watch())

    async def _end(self) -> None:
        self._watching.cancel()
        await self._simulations.close()
        if self._assistant:
            await self._assistant.close()

    def run(self, listener: socket.socket) -> None:
        """Serves at a listening socket until it is stopped; ends what runs."""
        try:
            self.server.run(sockets=[listener])
        finally:
            self._recordings.close()
            self._what_if.close()
            self._sizings.close()


class _HubServer(Server):
    """Ends the simulations first; a second signal does not wait for them."""

    def __init__(
        self,
        application: ASGIApp,
        on_start: Callable[[], None],
        on_end: Callable[[], Awaitable[None]],
    ) -> None:
        super().__init__(config_of(application), on_start)
        self._on_end = on_end

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Stops serving (uvicorn's hook)."""
        self.stop()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Ends what runs (uvicorn's hook)."""
        await super().shutdown(sockets)
        await self._on_end()


def folder_of(ros_home: str) -> Path:
    """Returns the folder in which a hub keeps its simulations."""
    return Path(ros_home) / "warehouse" / "hub"
