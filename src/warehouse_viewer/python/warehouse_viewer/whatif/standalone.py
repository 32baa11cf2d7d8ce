# SPDX-License-Identifier: Apache-2.0
"""Serves the page on this machine, with the layout editor beside it, without ROS."""

from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route

from warehouse_viewer.editor.routes import Editor
from warehouse_viewer.server.page_server import PageServer
from warehouse_viewer.server.site import LAYOUT, WHATIF, Site
from warehouse_viewer.whatif.routes import routes
from warehouse_viewer.whatif.workshop import Workshop


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


class WhatifServer(PageServer):
    """A PageServer with a Workshop. Raises ScenarioError too where the folder can't be used."""

    def __init__(self, port: int, folder: Path) -> None:
        self._workshop = Workshop(folder)
        self._workshop.open()
        super().__init__(application(self._workshop), port, WHATIF.path)

    def run(self) -> None:
        """Serves until it is stopped; what runs then is ended."""
        try:
            super().run()
        finally:
            self._workshop.close()
