# SPDX-License-Identifier: Apache-2.0
"""The endpoints of sizings."""

import asyncio

from starlette.requests import Request
from starlette.responses import HTMLResponse, Response

from warehouse_sim.hub.api.answers import Book, body_of, shown
from warehouse_sim.hub.journal import Journal
from warehouse_sim.hub.sizings import Sizings
from warehouse_viewer.json_text import JSONResponse
from warehouse_viewer.server.csp import REPORT_CONTENT

SIZINGS = "/api/v1/sizings"


class SizingsApi:
    """Endpoints of sizings; each start and end is written down."""

    def __init__(self, sizings: Sizings, journal: Journal) -> None:
        self._sizings, self._book = sizings, Book(journal)

    async def list(self, _: Request) -> Response:
        """Lists all sizings."""
        return JSONResponse({"sizings": await asyncio.to_thread(self._sizings.rows)})

    async def create(self, request: Request) -> Response:
        """Starts a sizing."""
        body = await body_of(request)
        starting = asyncio.to_thread(self._sizings.start, body)
        row = await self._book.written(request, "size a warehouse", shown(body), starting, "-")
        return JSONResponse(row, 202, headers={"location": f"{SIZINGS}/{row['id']}"})

    async def get(self, request: Request) -> Response:
        """Returns a sizing."""
        number = request.path_params["number"]
        return JSONResponse(await asyncio.to_thread(self._sizings.row, number))

    async def delete(self, request: Request) -> Response:
        """Ends a sizing, and deletes what it wrote."""
        number = request.path_params["number"]
        deleting = asyncio.to_thread(self._sizings.delete, number)
        about = {"sizing": number}
        return JSONResponse(
            await self._book.written(request, "delete a sizing", about, deleting, "-")
        )

    async def report(self, request: Request) -> Response:
        """Returns the report of a sizing that is over."""
        text = await asyncio.to_thread(self._sizings.report, request.path_params["number"])
        return HTMLResponse(text, headers={"content-security-policy": REPORT_CONTENT})
