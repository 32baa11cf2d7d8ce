# SPDX-License-Identifier: Apache-2.0
"""Serves the page on this machine, without ROS."""

from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route

from warehouse_viewer.editor.routes import Editor
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.connections import listen_near
from warehouse_viewer.server.http_server import Server, config_of
from warehouse_viewer.server.site import LAYOUT, Site

HOST = "127.0.0.1"


def application(file: Path | None = None) -> Starlette:
    """Returns the ASGI application with the page alone; file: the one that it edits."""
    return Starlette(
        routes=[
            Route("/", _to_page),
            *Editor(file).routes(),
            *Site(LAYOUT).routes(),
        ]
    )


async def _to_page(_: Request) -> Response:
    return RedirectResponse(LAYOUT.path)


class EditorServer:
    """Listens at `port` of this machine or one of the next. Raises OSError if none is free."""

    def __init__(self, port: int, file: Path | None = None) -> None:
        self._listener = listen_near(HOST, port)
        self.url = f"http://localhost:{self._listener.getsockname()[1]}{LAYOUT.path}"
        self.server = Server(config_of(AccessControl(application(file)), ws="none"), lambda: None)

    def run(self) -> None:
        """Serves until it is stopped."""
        self.server.run(sockets=[self._listener])
