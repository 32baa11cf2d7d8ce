# SPDX-License-Identifier: Apache-2.0
"""Serves an application with a page on this machine, without ROS."""

from starlette.types import ASGIApp

from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.connections import listen_near
from warehouse_viewer.server.http_server import Server, config_of

HOST = "127.0.0.1"


class PageServer:
    """Listens at `port` of this machine or one of the next. Raises OSError if none is free.

    path: of the page. ws: the WebSockets that uvicorn speaks.
    """

    def __init__(self, application: ASGIApp, port: int, path: str = "/", ws: str = "none") -> None:
        self._listener = listen_near(HOST, port)
        self.url = f"http://localhost:{self._listener.getsockname()[1]}{path}"
        self.server = Server(config_of(AccessControl(application), ws=ws), lambda: None)

    def run(self) -> None:
        """Serves until it is stopped."""
        self.server.run(sockets=[self._listener])
