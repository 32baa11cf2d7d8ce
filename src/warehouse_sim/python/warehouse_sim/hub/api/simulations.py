# SPDX-License-Identifier: Apache-2.0
"""The endpoints of simulations: start, stop, insert, save, keep, log."""

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse

from warehouse_sim.hub import forms
from warehouse_sim.hub.api.answers import Book, body_of, shown
from warehouse_sim.hub.journal import Journal
from warehouse_sim.hub.simulation import Simulation
from warehouse_sim.hub.simulations import Conflict, Simulations
from warehouse_sim.hub.wish import WishError
from warehouse_viewer.json_text import JSONResponse

SIMULATIONS = "/api/v1/simulations"
WORLDS = "/api/v1/worlds"
RECORDED = "/recordings"
FOLLOWING = 0.2  # between two looks at a log [s, wall]


class SimulationsApi:
    """Endpoints of simulations; each person's change is written down."""

    def __init__(self, simulations: Simulations, journal: Journal) -> None:
        self._simulations, self._book = simulations, Book(journal)

    async def list(self, _: Request) -> Response:
        """Lists all simulations."""
        return JSONResponse({"simulations": self._simulations.rows()})

    async def arguments(self, _: Request) -> Response:
        """Lists what a request for a simulation takes."""
        about = await asyncio.to_thread(forms.arguments)
        return JSONResponse(about | {"worlds": self._simulations.worlds.names()})

    async def create(self, request: Request) -> Response:
        """Starts a simulation."""
        body = await body_of(request)
        creating = self._simulations.create(body)
        name = str(body.get("name", ""))
        simulation = await self._book.written(request, "start", shown(body), creating, name)
        headers = {"location": f"{SIMULATIONS}/{simulation.wish.name}"}
        return JSONResponse(simulation.row(), 202, headers=headers)

    async def get(self, request: Request) -> Response:
        """Returns a simulation."""
        return JSONResponse(self._named(request).row())

    async def join(self, request: Request) -> Response:
        """Lists a warehouse that runs elsewhere."""
        guest = await self._simulations.join(request.path_params["name"], await body_of(request))
        return JSONResponse(guest.row(), 201)

    async def delete(self, request: Request) -> Response:
        """Ends a simulation, and deletes its files if that is asked for."""
        text = request.query_params.get("forget", "false")
        if text not in ("true", "false"):
            raise WishError("forget", "true or false was expected")
        stopping = self._simulations.stop(request.path_params["name"], text == "true")
        about = {"forget": True} if text == "true" else ""
        return JSONResponse((await self._book.written(request, "stop", about, stopping)).row())

    async def start(self, request: Request) -> Response:
        """Starts a simulation that has stopped."""
        starting = self._simulations.start_again(request.path_params["name"])
        simulation = await self._book.written(request, "start again", "", starting)
        return JSONResponse(simulation.row(), 202)

    async def restart(self, request: Request) -> Response:
        """Ends a simulation and starts it again."""
        starting = self._simulations.restart(request.path_params["name"])
        simulation = await self._book.written(request, "restart", "", starting)
        return JSONResponse(simulation.row(), 202)

    async def insert(self, request: Request) -> Response:
        """Adds the models of a world."""
        body = await body_of(request)
        inserting = self._simulations.insert(request.path_params["name"], body)
        added = await self._book.written(request, "insert a world", shown(body), inserting)
        return JSONResponse({"message": added}, 201)

    async def save(self, request: Request) -> Response:
        """Saves the world that runs under a name."""
        body = await body_of(request)
        saving = self._simulations.save_world(request.path_params["name"], body)
        saved = await self._book.written(request, "save the world", body, saving)
        headers = {"location": f"{WORLDS}/{saved['world']}"}
        return JSONResponse(saved, 201, headers=headers)

    async def keep(self, request: Request) -> Response:
        """Keeps the last hour as a recording."""
        name = request.path_params["name"]
        keeping = self._simulations.keep_recording(name)
        size = await self._book.written(request, "keep the recording", "", keeping)
        if not size:
            raise Conflict(f"nothing of '{name}' is recorded yet")
        url = f"{RECORDED}/{name}/"
        return JSONResponse({"url": url, "bytes": size}, 201, headers={"location": url})

    async def log(self, request: Request) -> Response:
        """Returns the log, or follows it to its end."""
        simulation = self._named(request)
        path = simulation.folder / "log.txt"
        if request.query_params.get("follow", "false") == "true":
            lines = _followed(path, simulation)
            return StreamingResponse(lines, media_type="text/plain; charset=utf-8")
        text = await asyncio.to_thread(_read, path, 0)
        return Response(text, media_type="text/plain; charset=utf-8")

    def _named(self, request: Request) -> Simulation:
        return self._simulations[request.path_params["name"]]


def _read(path: Path, begin: int) -> bytes:
    try:
        with path.open("rb") as file:
            file.seek(begin)
            return file.read(8 << 20)
    except FileNotFoundError:
        return b""


async def _followed(path: Path, simulation: Simulation) -> AsyncIterator[bytes]:
    """Yields a log as it grows, to the end of its simulation."""
    begin = 0
    while True:
        lives = simulation.lives
        piece = await asyncio.to_thread(_read, path, begin)
        begin += len(piece)
        if piece:
            yield piece
        elif not lives:
            return
        else:
            await asyncio.sleep(FOLLOWING)
