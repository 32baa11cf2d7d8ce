# SPDX-License-Identifier: Apache-2.0
"""The pages of a server, and the files that they are made of."""

from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import NamedTuple

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Mount, Route

from warehouse_layout.floor import palette
from warehouse_viewer.json_text import JSONResponse
from warehouse_viewer.server import documentation, font
from warehouse_viewer.server.static_files import Files, FreshFiles
from warehouse_viewer.shared_files import CHART, THREE, WEB


class Page(NamedTuple):
    """A page: where it is, what the way to it is called, and its file in the folder web.

    `counted`: a JSON resource whose `total` counts what waits there for a person; may be empty.
    Without a file another server serves the page, and only the link is shown, if it answers.
    """

    path: str
    title: str
    file: str
    counted: str = ""
    is_there: Callable[[], bool] = lambda: True


HUB = Page("/", "Simulations", "hub.html")
FLOOR = Page("/", "Floor", "index.html")
OPERATIONS = Page("/operations", "Operations", "operations.html")
LAYOUT = Page("/layout", "Layout", "layout.html")
WHATIF = Page("/whatif", "What-if", "whatif.html")
API = Page("/api/docs", "API", "docs.html")
DOCS = Page("/docs/", "Docs", "", is_there=documentation.is_built)


class Site:
    """The pages of a server, which link to each other."""

    def __init__(self, *pages: Page, folder: Path = WEB) -> None:
        self._pages, self._files = pages, FreshFiles(directory=folder)

    def routes(self) -> list[BaseRoute]:
        """Returns the routes of the pages and their files, to be added to an application."""
        return [
            *(Route(page.path, self._endpoint(page.file)) for page in self._pages if page.file),
            Route("/pages", self._list),
            Route("/fonts/inter.woff2", font.serve),
            Route("/web/palette.css", _palette),
            Mount("/web", self._files),
            # Modules of three import this one; the page has the same as a script of half the size.
            Route("/three/build/three.module.js", self._endpoint("js/base/three.js")),
            Mount("/three", Files(directory=THREE, check_dir=False)),
            Mount("/chart", Files(directory=CHART, check_dir=False)),
        ]

    def _endpoint(self, name: str) -> Callable[[Request], Awaitable[Response]]:
        async def get(request: Request) -> Response:
            return await self._files.get_response(name, request.scope)

        return get

    async def _list(self, _: Request) -> Response:
        pages = [
            {"path": page.path, "title": page.title}
            | ({"count": page.counted} if page.counted else {})
            for page in self._pages
            if page.is_there()
        ]
        return JSONResponse(pages, headers={"cache-control": "no-cache"})


async def _palette(_: Request) -> Response:
    headers = {"cache-control": "no-cache"}
    return Response(palette.css(), headers=headers, media_type="text/css")
