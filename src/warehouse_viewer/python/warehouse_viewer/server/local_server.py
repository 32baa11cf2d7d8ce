# SPDX-License-Identifier: Apache-2.0
"""Serves the page for a world of this process: its files, its WebSocket, and the few requests of
the HTTP API that such a world can answer."""

import threading
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket

from warehouse_viewer.json_text import JSONResponse
from warehouse_viewer.page.hub import Hub
from warehouse_viewer.page.model import Model
from warehouse_viewer.page.source import RefusedError, Source
from warehouse_viewer.page.world_source import DECIDES
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.connections import listen_near
from warehouse_viewer.server.http_server import HubTask, Server, config_of
from warehouse_viewer.server.site import FLOOR, Site
from warehouse_viewer.server.sockets import SocketLimit

HOST = "127.0.0.1"
PATIENCE = 10.0  # with a server that starts or stops [s, wall]


class LocalServer:
    """Shows a Source on this machine, in a thread of its own, until it is closed.

    Listens at `port` or one of the next. Raises OSError if none of them is free.
    """

    def __init__(self, source: Source, port: int) -> None:
        self.hub = Hub(source, Model())
        self._listener = listen_near(HOST, port)
        self.url = "http://{}:{}/".format(*self._listener.getsockname())
        config = config_of(AccessControl(application(source, self.hub)), ws="wsproto")
        self._server = Server(config, HubTask(self.hub).start)
        run, listeners = self._server.run, [self._listener]
        self._thread = threading.Thread(target=run, args=(listeners,), daemon=True)
        self._thread.start()
        self._server.is_serving.wait(PATIENCE)

    def close(self) -> None:
        """Stops serving."""
        self._server.stop()
        self._thread.join(PATIENCE)
        self._listener.close()


def application(source: Source, hub: Hub) -> Starlette:
    """Returns the ASGI application with the page, its WebSocket and what a Source can answer."""
    api, sockets = _Api(source), SocketLimit()

    async def live(socket: WebSocket) -> None:
        await sockets.admit(socket, hub.serve)

    return Starlette(
        routes=[
            WebSocketRoute("/live", live),
            Route("/api/v1/simulation/{action}", api.control, methods=["POST"]),
            Route("/api/v1/events", api.events),
            Route("/api/v1/events.csv", api.events_csv),
            *Site(FLOOR).routes(),
            Route("/{path:path}", _refuse, methods=["GET", "POST", "PUT", "DELETE"]),
        ]
    )


class _Api:
    """What the page asks of the HTTP API, answered from a Source."""

    def __init__(self, source: Source) -> None:
        self._simulation, self._journal = source.simulation, source.journal

    async def events(self, _: Request) -> Response:
        return JSONResponse({"events": self._journal.since(0)})

    async def events_csv(self, _: Request) -> Response:
        return Response(self._journal.csv(), media_type="text/csv")

    async def control(self, request: Request) -> Response:
        """Pause, resume, step or speed, with the same body as in the HTTP API behind ROS."""
        action = request.path_params["action"]
        try:
            message = self._do(action, await request.json() if action in _FIELDS else {})
        except RefusedError as error:
            return JSONResponse({"detail": str(error)}, 409)
        except (KeyError, TypeError, ValueError) as error:
            return JSONResponse({"detail": f"{action}: {error!r}"}, 422)
        return JSONResponse({"message": message})

    def _do(self, action: str, body: dict[str, Any]) -> str:
        if action not in ("pause", "resume", *_FIELDS):
            raise RefusedError(self._simulation.offers().get(action) or DECIDES)
        values = [kind(body[name]) for name, kind in _FIELDS.get(action, {}).items()]
        return getattr(self._simulation, action)(*values)


_FIELDS: dict[str, dict[str, type]] = {
    "step": {"steps": int},
    "speed": {"factor": float},
}  # of the bodies


async def _refuse(_: Request) -> Response:
    return JSONResponse({"detail": DECIDES}, 409)
