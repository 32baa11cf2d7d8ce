# SPDX-License-Identifier: Apache-2.0
"""The pages beneath the hub: of simulations, of recordings; and the assistant."""

import asyncio
import time
from collections.abc import Callable

from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.types import Receive, Scope, Send

from warehouse_sim.hub.api.proxy import Proxy
from warehouse_sim.hub.api.simulations import RECORDED
from warehouse_sim.hub.assistant import Assistant
from warehouse_sim.hub.recordings import Recordings, UnknownRecording
from warehouse_sim.hub.simulations import Missing, Simulations
from warehouse_viewer.json_text import JSONResponse
from warehouse_viewer.replay.blocks import RecordingError

PREFIX = "/s"


async def to_recording(request: Request) -> Response:
    """Redirects to a recording's page."""
    return RedirectResponse(f"{RECORDED}/{request.path_params['name']}/")


class RecordedPages:
    """ASGI application: the page of each recording, by its name."""

    def __init__(self, recordings: Recordings) -> None:
        self._recordings = recordings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        name = scope["path_params"]["name"]
        try:
            application = await asyncio.to_thread(self._recordings.application, name)
        except UnknownRecording as error:
            await _refused(404, error.args[0], scope, receive, send)
            return
        except RecordingError as error:
            await _refused(409, str(error), scope, receive, send)
            return
        path = "/" + scope["path_params"]["rest"]
        inner = {**scope, "path": path, "raw_path": path.encode(), "root_path": ""}
        await application(inner, receive, send)


async def to_pages(request: Request) -> Response:
    """Redirects to a simulation's pages."""
    return RedirectResponse(f"{PREFIX}/{request.path_params['name']}/")


class SimulationPages:
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


class AssistantPages:
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
