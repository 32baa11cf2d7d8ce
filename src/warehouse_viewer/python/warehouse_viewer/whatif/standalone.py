# SPDX-License-Identifier: Apache-2.0
"""Serves the page on this machine, with the layout editor beside it, without ROS."""

from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route

from warehouse_viewer.editor.routes import Editor
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.connections import listen_near
from warehouse_viewer.server.http_server import Server, config_of
from warehouse_viewer.server.site import LAYOUT, WHATIF, Site
from warehouse_viewer.whatif.routes import routes
from warehouse_viewer.whatif.workshop import Workshop

HOST = "127.0.0.1"


def application(workshop: Workshop) -> Starlette:
    """Returns the ASGI application with both pages."""
    return Starlette(
        routes=[
            Route("/", _to_page),
            *routes(workshop),
            *Editor(compares=True).routes(),
            *Site(WHATIF, LAYOUT).routes(),
        ]
    )


async def _to_page(_: Request) -> Response:
    return RedirectResponse(WHATIF.path)


class WhatifServer:
    """Listens at `port` of this machine or one of the next. Raises OSError if none is free, and
    ScenarioError where the folder can't be used."""

    def __init__(self, port: int, folder: Path) -> None:
        self._workshop = Workshop(folder)
        self._workshop.open()
        self._listener = listen_near(HOST, port)
        self.url = f"http://localhost:{self._listener.getsockname()[1]}{WHATIF.path}"
        application_ = AccessControl(application(self._workshop))
        self.server = Server(config_of(application_, ws="none"), lambda: None)

    def run(self) -> None:
        """Serves until it is stopped; what runs then is ended."""
        try:
            self.server.run(sockets=[self._listener])
        finally:
            self._workshop.close()
