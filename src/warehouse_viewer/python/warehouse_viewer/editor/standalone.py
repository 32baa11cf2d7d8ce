# SPDX-License-Identifier: Apache-2.0
"""The application with the page of the editor alone, without ROS."""

from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route

from warehouse_viewer.editor.routes import Editor
from warehouse_viewer.server.site import LAYOUT, Site


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
