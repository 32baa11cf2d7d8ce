# SPDX-License-Identifier: Apache-2.0
"""The screen of a person at a station, and the labels that its scanner reads."""

from collections.abc import Awaitable, Callable
from pathlib import Path

from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import BaseRoute, Route

from warehouse_viewer.server import labels
from warehouse_viewer.server.static_files import FreshFiles
from warehouse_viewer.shared_files import WEB

# Finds how many totes a station has; 0: it has none. None: there is no such station.
ToteCount = Callable[[str], Awaitable[int | None]]


class StationPages:
    """Serves /station/NAME, and /station/NAME/labels to print."""

    def __init__(self, totes: ToteCount, folder: Path = WEB) -> None:
        self._totes, self._files = totes, FreshFiles(directory=folder)

    def routes(self) -> list[BaseRoute]:
        """Returns the routes, to be added to an application."""
        return [
            Route("/station-worker.js", self._worker),
            Route("/station", _overview),
            Route("/station/", _overview),
            Route("/station/{name}", self._screen),
            Route("/station/{name}/labels", self._labels),
        ]

    async def _screen(self, request: Request) -> Response:
        return await self._files.get_response("station.html", request.scope)

    async def _worker(self, request: Request) -> Response:
        """Answers with the page's worker, at a place from which it may serve /station."""
        return await self._files.get_response("js/station/worker.js", request.scope)

    async def _labels(self, request: Request) -> Response:
        name = request.path_params["name"]
        count = await self._totes(name)
        if count is None:
            return HTMLResponse(labels.no_station(name), 404)
        skus = request.query_params.getlist("sku")
        if fault := labels.fault_of(skus):
            return HTMLResponse(labels.page_of_fault(fault), 422)
        return HTMLResponse(labels.page(name, count, skus))


async def _overview(_: Request) -> Response:
    return RedirectResponse("/operations")
