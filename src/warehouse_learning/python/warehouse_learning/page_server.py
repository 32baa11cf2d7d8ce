# SPDX-License-Identifier: Apache-2.0
"""Serves the page of warehouse_viewer without ROS: the files, what is to be shown, and
the few requests of the HTTP API that a program which steps its own world can meet."""

import asyncio
import threading

import uvicorn
from starlette.applications import Starlette
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute

from warehouse_viewer.page.hub import Hub
from warehouse_viewer.page.model import Model
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.connections import listen
from warehouse_viewer.server.static_files import Files, FreshFiles
from warehouse_viewer.shared_files import THREE, WEB

HOST, TRIES = "127.0.0.1", 20
PATIENCE = 10.0  # with a server that begins or ends [s, wall]
DECIDES = "the program that steps this warehouse decides that"
LACKS = ("reset", "reset_poses", "checkpoint", "restore", "undo", "create", "person")


class PageServer:
    """In a thread of its own: shows a LiveWorld and a Journal, and lets whoever looks set a Pace.

    OSError if neither `port` nor one of the next is free.
    """

    def __init__(self, name, step_size, live, journal, pace, port):
        self._name, self._step_size = name, step_size
        self._journal, self._pace = journal, pace
        self.hub = Hub(live, Model(), journal, self)
        self._listener = _first_free(port)
        self.url = "http://{}:{}/".format(*self._listener.getsockname())
        self._server = _Server(self._application(), self.hub)
        run = {"target": self._server.run, "args": ([self._listener],)}
        self._thread = threading.Thread(**run, daemon=True)
        self._thread.start()
        self._server.serves.wait(PATIENCE)

    def close(self):
        self._server.should_exit = self._server.force_exit = True
        self._thread.join(PATIENCE)
        self._listener.close()

    # --- what the hub asks of a simulation
    def offers(self):
        return dict.fromkeys(LACKS, DECIDES)

    def state(self):
        pace = self._pace
        state = {"paused": pace.paused, "target_factor": pace.factor}
        return state | {"step_size": self._step_size}

    def warehouse(self):
        return self._name, 0

    # --- over HTTP
    def _application(self):
        web = FreshFiles(directory=WEB)

        async def page(request):
            return await web.get_response("index.html", request.scope)

        routes = [
            Route("/", page),
            WebSocketRoute("/live", self._live),
            Route("/api/v1/simulation/{action}", self._steer, methods=["POST"]),
            Route("/api/v1/events", self._events),
            Route("/api/v1/events.csv", self._events_csv),
            Mount("/web", web),
            Mount("/three", Files(directory=THREE)),
            Route("/{path:path}", _refuse, methods=["GET", "POST", "PUT", "DELETE"]),
        ]
        return AccessControl(Starlette(routes=routes))

    async def _live(self, socket):
        await socket.accept()
        await self.hub.serve(socket)

    async def _events(self, _):
        return JSONResponse({"events": self._journal.since(0)})

    async def _events_csv(self, _):
        return Response(self._journal.csv(), media_type="text/csv")

    async def _steer(self, request):
        """Pause, resume, step or speed, with the body that the HTTP API wants."""
        action, pace = request.path_params["action"], self._pace
        try:
            if action == "step":
                pace.step(int((await request.json())["steps"]) * self._step_size)
            elif action == "speed":
                pace.run_at(max(0.0, float((await request.json())["factor"])))
            elif action in ("pause", "resume"):
                getattr(pace, action)()
            else:
                return await _refuse(request)
        except (KeyError, TypeError, ValueError) as error:
            return JSONResponse({"detail": f"{action}: {error!r}"}, 422)
        return JSONResponse({"message": ""})


async def _refuse(_):
    return JSONResponse({"detail": DECIDES}, 409)


def _first_free(port):
    for k in range(TRIES):
        try:
            return listen(HOST, port + k if port else 0)
        except OSError as error:
            last = error
    raise OSError(f"no port from {port} to {port + TRIES - 1} is free for the page: {last}")


class _Server(uvicorn.Server):
    def __init__(self, application, hub):
        super().__init__(
            uvicorn.Config(
                application,
                http="h11",
                ws="wsproto",
                lifespan="off",
                log_level="warning",
                access_log=False,
            )
        )
        self._hub, self.serves = hub, threading.Event()

    async def startup(self, sockets=None):
        await super().startup(sockets)
        self._running = asyncio.create_task(self._hub.run())
        self.serves.set()
