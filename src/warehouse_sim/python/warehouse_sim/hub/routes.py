# SPDX-License-Identifier: Apache-2.0
"""The hub's HTTP API: simulations, their logs, and their pages beneath /s/NAME/."""

import asyncio
import json
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import RedirectResponse, Response, StreamingResponse
from starlette.routing import BaseRoute, Route, WebSocketRoute
from starlette.types import Receive, Scope, Send

from warehouse_sim.hub import forms
from warehouse_sim.hub.assistant import Assistant
from warehouse_sim.hub.insertion import InTheWay
from warehouse_sim.hub.proxy import Proxy
from warehouse_sim.hub.simulation import Simulation
from warehouse_sim.hub.simulations import Conflict, Missing, Simulations
from warehouse_sim.hub.wish import WishError
from warehouse_viewer.json_text import JSONResponse

Endpoint = Callable[[Request], Awaitable[Response]]

SIMULATIONS = "/api/v1/simulations"
PREFIX = "/s"
PAGES = f"{PREFIX}/{{name}}/{{rest:path}}"
FOLLOWING = 0.2  # between two looks at a log [s, wall]


def routes(simulations: Simulations, assistant: Callable[[], Assistant]) -> list[BaseRoute]:
    """Returns the routes of the API, of the simulations' pages, and of the assistant."""
    api = _Api(simulations)
    return [
        Route(SIMULATIONS, _answered(api.list), methods=["GET"]),
        Route(SIMULATIONS, _answered(api.create), methods=["POST"]),
        Route("/api/v1/simulation-arguments", _answered(api.arguments), methods=["GET"]),
        Route(f"{SIMULATIONS}/{{name}}", _answered(api.get), methods=["GET"]),
        Route(f"{SIMULATIONS}/{{name}}", _answered(api.join), methods=["PUT"]),
        Route(f"{SIMULATIONS}/{{name}}", _answered(api.delete), methods=["DELETE"]),
        Route(f"{SIMULATIONS}/{{name}}/start", _answered(api.start), methods=["POST"]),
        Route(f"{SIMULATIONS}/{{name}}/worlds", _answered(api.insert), methods=["POST"]),
        Route(f"{SIMULATIONS}/{{name}}/log", _answered(api.log), methods=["GET"]),
        Route(f"{PREFIX}/{{name}}", _to_pages),
        Route(PAGES, _Pages(simulations)),
        WebSocketRoute(PAGES, _Pages(simulations)),
        Route("/mcp", _Assistant(assistant)),
    ]


def _answered(action: Endpoint) -> Endpoint:
    """Returns an endpoint that answers errors with 404, 409, 422, 400 or 503."""

    async def endpoint(request: Request) -> Response:
        try:
            return await action(request)
        except Missing as error:
            return JSONResponse({"detail": error.args[0]}, 404)
        except (Conflict, InTheWay) as error:
            return JSONResponse({"detail": str(error)}, 409)
        except WishError as error:
            fault = {"field": error.field, "reason": error.reason, "nearest": error.nearest}
            return JSONResponse({"detail": str(error), **fault}, 422)
        except OSError as error:
            return JSONResponse({"detail": f"it can't be started: {error}"}, 503)

    return endpoint


class _Api:
    def __init__(self, simulations: Simulations) -> None:
        self._simulations = simulations

    async def list(self, _: Request) -> Response:
        return JSONResponse({"simulations": self._simulations.rows()})

    async def arguments(self, _: Request) -> Response:
        return JSONResponse(await asyncio.to_thread(forms.arguments))

    async def create(self, request: Request) -> Response:
        simulation = await self._simulations.create(await _body(request))
        headers = {"location": f"{SIMULATIONS}/{simulation.wish.name}"}
        return JSONResponse(simulation.row(), 202, headers=headers)

    async def get(self, request: Request) -> Response:
        return JSONResponse(self._named(request).row())

    async def join(self, request: Request) -> Response:
        guest = await self._simulations.join(request.path_params["name"], await _body(request))
        return JSONResponse(guest.row(), 201)

    async def delete(self, request: Request) -> Response:
        text = request.query_params.get("forget", "false")
        if text not in ("true", "false"):
            raise WishError("forget", "true or false was expected")
        name = request.path_params["name"]
        return JSONResponse((await self._simulations.stop(name, text == "true")).row())

    async def start(self, request: Request) -> Response:
        simulation = await self._simulations.start_again(request.path_params["name"])
        return JSONResponse(simulation.row(), 202)

    async def insert(self, request: Request) -> Response:
        body = await _body(request)
        added = await self._simulations.insert(request.path_params["name"], body)
        return JSONResponse({"message": added}, 201)

    async def log(self, request: Request) -> Response:
        simulation = self._named(request)
        path = simulation.folder / "log.txt"
        if request.query_params.get("follow", "false") == "true":
            lines = _followed(path, simulation)
            return StreamingResponse(lines, media_type="text/plain; charset=utf-8")
        text = await asyncio.to_thread(_read, path, 0)
        return Response(text, media_type="text/plain; charset=utf-8")

    def _named(self, request: Request) -> Simulation:
        return self._simulations[request.path_params["name"]]


async def _body(request: Request) -> dict[str, Any]:
    try:
        body = json.loads(await request.body() or b"{}")
    except (ValueError, RecursionError) as error:
        raise WishError("body", f"JSON was expected: {error}") from error
    if not isinstance(body, dict):
        raise WishError("body", "an object with a field for each argument was expected")
    return body


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


async def _to_pages(request: Request) -> Response:
    return RedirectResponse(f"{PREFIX}/{request.path_params['name']}/")


class _Pages:
    """ASGI application: the pages, API and WebSockets of each simulation, by its name."""

    def __init__(self, simulations: Simulations) -> None:
        self._simulations = simulations

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        name = scope["path_params"]["name"]
        try:
            simulation = self._simulations[name]
        except Missing as error:
            await _refused(404, error.args[0], scope, receive, send)
            return
        simulation.used = time.monotonic()
        if not simulation.viewer:
            text = f"'{name}' is {simulation.state.value}: its pages are not served"
            await _refused(503, text, scope, receive, send)
        else:
            await Proxy(simulation.viewer, f"{PREFIX}/{name}")(scope, receive, send)


class _Assistant:
    """ASGI application: passes requests on to the assistant's server; 503 without it."""

    def __init__(self, assistant: Callable[[], Assistant]) -> None:
        self._assistant = assistant

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        assistant = self._assistant()
        await assistant.wait()
        if fault := assistant.fault():
            await _refused(503, fault, scope, receive, send)
        else:
            client = scope["client"][0] if scope.get("client") else ""
            headers = assistant.headers(scope["headers"], client)
            await Proxy(assistant.address, "")({**scope, "headers": headers}, receive, send)


async def _refused(status: int, text: str, scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1013})
        return
    await JSONResponse({"detail": text}, status)(scope, receive, send)
