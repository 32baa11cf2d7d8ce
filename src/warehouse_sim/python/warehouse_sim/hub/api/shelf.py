# SPDX-License-Identifier: Apache-2.0
"""The endpoints of what a hub keeps: worlds, recordings, the journal, its description."""

import asyncio

from starlette.requests import Request
from starlette.responses import Response

from warehouse_sim.hub.api import description
from warehouse_sim.hub.api.answers import Book, body_of, whole
from warehouse_sim.hub.journal import KEPT, Journal
from warehouse_sim.hub.recordings import Recordings
from warehouse_sim.hub.wish import WishError
from warehouse_sim.hub.worlds import Worlds
from warehouse_viewer.json_text import JSONResponse

NOTED = frozenset(("who", "action", "simulation", "arguments", "outcome", "done"))


class WorldsApi:
    """Endpoints of worlds by name."""

    def __init__(self, worlds: Worlds, journal: Journal) -> None:
        self._worlds, self._book = worlds, Book(journal)

    async def list(self, _: Request) -> Response:
        """Lists all worlds."""
        return JSONResponse({"worlds": await asyncio.to_thread(self._worlds.rows)})

    async def get(self, request: Request) -> Response:
        """Returns the SDF of a world."""
        name = request.path_params["name"]
        text = await asyncio.to_thread(self._worlds.text, name)
        headers = {"content-disposition": f'attachment; filename="{name}.sdf"'}
        return Response(text, headers=headers, media_type="application/xml")

    async def put(self, request: Request) -> Response:
        """Saves an SDF text under a name."""
        body, name = await body_of(request), request.path_params["name"]
        if unknown := sorted(body.keys() - {"text", "replace"}):
            raise WishError(unknown[0][:100], "text and replace were expected")
        replaces = body.get("replace", False)
        saving = asyncio.to_thread(self._worlds.save, name, body.get("text"), replaces)
        await self._book.written(request, "save a world", {"world": name}, saving, "-")
        return JSONResponse({"world": name}, 201)

    async def delete(self, request: Request) -> Response:
        """Deletes a saved world."""
        name = request.path_params["name"]
        deleting = asyncio.to_thread(self._worlds.delete, name)
        await self._book.written(request, "delete a world", {"world": name}, deleting, "-")
        return JSONResponse({"world": name})


class ShelfApi:
    """Endpoints of recordings, of the journal, and of the API's description."""

    def __init__(self, recordings: Recordings, journal: Journal) -> None:
        self._recordings, self._journal = recordings, journal

    async def recordings(self, _: Request) -> Response:
        """Lists the recordings."""
        return JSONResponse({"recordings": await asyncio.to_thread(self._recordings.rows)})

    async def description(self, _: Request) -> Response:
        """Returns the API in words of OpenAPI."""
        return JSONResponse(await asyncio.to_thread(description.described))

    async def journal(self, request: Request) -> Response:
        """Lists entries of the journal."""
        query = request.query_params
        since = whole("since", query.get("since", "0"), 2**53)
        limit = whole("limit", query.get("limit", "200"), KEPT)
        entries = self._journal.since(since, query.get("simulation", ""), limit)
        return JSONResponse({"entries": entries})

    async def note(self, request: Request) -> Response:
        """Takes an entry of an assistant. What it says of itself counts as little as a name."""
        body = await body_of(request)
        if unknown := sorted(body.keys() - NOTED):
            raise WishError(unknown[0][:100], f"{', '.join(sorted(NOTED))} were expected")
        for key in ("who", "action"):
            if not isinstance(body.get(key), str) or not body[key]:
                raise WishError(key, "a text was expected")
        if not isinstance(body.get("done", True), bool):
            raise WishError("done", "true or false was expected")
        is_done = body.pop("done", True)
        entry = await asyncio.to_thread(self._journal.add, "assistant", body, is_done)
        return JSONResponse(entry, 201)
