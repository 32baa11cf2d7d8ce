# SPDX-License-Identifier: Apache-2.0
"""The application with the floor's page for a recording, without ROS."""

from contextlib import suppress

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from warehouse_viewer.json_text import JSONResponse
from warehouse_viewer.replay.forecasts import RecordedForecasts
from warehouse_viewer.replay.routes import Recording, RecordingRoutes
from warehouse_viewer.server.site import FLOOR, Site
from warehouse_viewer.server.sockets import SocketLimit

RECORDED = "this is a recording: it can be watched, and not commanded"


def application(recording: Recording, forecasts: RecordedForecasts | None = None) -> Starlette:
    """Returns the ASGI application with the floor's page and the recording, and forecasts from its
    moments."""
    sockets = SocketLimit()

    async def live(socket: WebSocket) -> None:
        await sockets.admit(socket, _wait)

    return Starlette(
        routes=[
            WebSocketRoute("/live", live),
            *RecordingRoutes(recording, forecasts=bool(forecasts)).routes(),
            *(forecasts.routes() if forecasts else ()),
            *Site(FLOOR).routes(),
            Route("/{path:path}", _refuse, methods=["GET", "POST", "PUT", "DELETE"]),
        ]
    )


async def _wait(socket: WebSocket) -> None:
    """Does nothing: a page asks what there is, and leaves."""
    with suppress(WebSocketDisconnect, RuntimeError):
        while True:
            await socket.receive_text()


async def _refuse(_: Request) -> Response:
    return JSONResponse({"detail": RECORDED}, 409)
