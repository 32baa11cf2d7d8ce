# SPDX-License-Identifier: Apache-2.0
"""The web application: the page, its WebSocket, the API; and the server it runs in."""

import asyncio
import os
import threading
from contextlib import suppress

import uvicorn
from fastapi import FastAPI, Request, WebSocket
from fastapi.responses import Response

from warehouse_viewer.api import api, catalogue, changes, metrics, sockets, stream
from warehouse_viewer.api.change_book import ChangeBook
from warehouse_viewer.api.transport_book import TransportBook
from warehouse_viewer.api.work import Work
from warehouse_viewer.page.hub import Hub
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.model import Model
from warehouse_viewer.ros.commander import Commander
from warehouse_viewer.ros.coordination import Coordination
from warehouse_viewer.ros.feed import Feed
from warehouse_viewer.ros.shift_feed import ShiftFeed
from warehouse_viewer.ros.simulation import Simulation
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.connections import BoundedConnection
from warehouse_viewer.server.static_files import Files, FreshFiles
from warehouse_viewer.shared_files import THREE

MOST_SOCKETS = 50
MOST_MESSAGE = 64 * 1024  # from a page [bytes]
TRY_AGAIN, UNSUPPORTED = 1013, 1003  # a WebSocket's close codes
MOST_REASON = 120  # characters beside one
METRICS = {200: {"content": {"text/plain": {"schema": {"type": "string"}}}}}


class Viewer:
    """Everything behind one address. `ros` is rospy, `web` the folder of the page."""

    def __init__(self, ros, web):
        self.journal, self.model = Journal(), Model()
        self.simulation, self.commander = Simulation(ros), Commander(ros)
        self.coordination, self.transports = Coordination(ros), TransportBook()
        self._loop, self.changes = None, ChangeBook()
        self.feed = Feed(ros, self._on_event, self._on_transport, self._on_news)
        self.hub = Hub(self.feed, self.model, self.journal, self.simulation, catalogue.coordinator)
        parts = (self.feed, self.model, self.journal, self.simulation, self.commander)
        work = Work(ros, ShiftFeed(ros, self.changes))
        self.metrics = metrics.Metrics(self.feed, work)
        self.backend = api.ApiBackend(
            *parts, self.coordination, self.transports, work, self.changes
        )
        self._web, self._sockets = web, 0

    def _on_event(self, event):
        entry = self.journal.add(catalogue.event(event))
        with suppress(RuntimeError):  # the loop has ended
            if self._loop:
                self._loop.call_soon_threadsafe(self._note, entry)

    def _note(self, entry):
        self.commander.note(entry)
        self.hub.news()

    def _on_transport(self, event):
        self.changes.note("transports", event.transport_id, self.transports.add(event))

    def _on_news(self):
        self.hub.news()

    def application(self, token="", rate=100):
        """The ASGI application."""
        app = FastAPI(
            title="Kiva warehouse",
            version="1",
            description="The simulated warehouse over HTTP. States and events come as JSON over "
            "WebSockets, and figures for Prometheus at /metrics.",
            docs_url=None,
            redoc_url=None,
            openapi_url="/openapi.json",
        )
        app.include_router(api.router(self.backend))
        app.openapi = lambda: sockets.described(app)
        app.get("/api/v1/openapi.json", include_in_schema=False)(app.openapi)
        app.add_exception_handler(405, api.not_allowed)
        self._add_sockets(app)
        self._add_files(app)
        return AccessControl(app, token, rate)

    def start(self):
        """Begins to serve pages, in the running asyncio loop."""
        self._loop = asyncio.get_running_loop()
        self._running = asyncio.create_task(self.hub.run())

    def _add_sockets(self, app):
        @app.websocket("/live")
        async def live(socket: WebSocket):
            await self._admit(socket, self.hub.serve)

        @app.websocket("/api/v1/stream")
        async def json_stream(socket: WebSocket, rate: float = 2.0):
            rate = _bounded(rate)
            await self._admit(socket, lambda s: stream.serve(s, self.backend, rate))

        @app.websocket("/api/v1/changes")
        async def json_changes(socket: WebSocket, of: str = "", rate: float = 2.0):
            try:
                topics = changes.topics(of)
            except ValueError as error:
                await socket.accept()
                await socket.close(UNSUPPORTED, str(error)[:MOST_REASON])
                return
            rate = _bounded(rate)
            await self._admit(socket, lambda s: changes.serve(s, self.backend, topics, rate))

    async def _admit(self, socket, serve):
        await socket.accept()
        if self._sockets >= MOST_SOCKETS:
            await socket.close(TRY_AGAIN)
            return
        self._sockets += 1
        try:
            await serve(socket)
        finally:
            self._sockets -= 1
            # TypeError: websockets' of a page that went before it had come.
            with suppress(RuntimeError, TypeError):
                await socket.close()

    def _add_files(self, app):
        web = FreshFiles(directory=self._web)

        def page(name):
            async def get(request: Request):
                return await web.get_response(name, request.scope)

            return get

        @app.get("/metrics", response_class=Response, responses=METRICS)
        async def get_metrics(request: Request):
            """Figures for Prometheus."""
            await self.backend.glance()
            accepted = request.headers.get("accept", "")
            text, kind = await asyncio.to_thread(self.metrics.text, accepted)
            return Response(text, headers={"content-type": kind})

        app.get("/", include_in_schema=False)(page("index.html"))
        app.get("/operations", include_in_schema=False)(page("operations.html"))
        app.get("/docs", include_in_schema=False)(page("docs.html"))
        app.mount("/three", Files(directory=THREE, check_dir=False))
        app.mount("/web", web)


def _bounded(rate):
    """Messages a second."""
    return min(10.0, max(0.1, rate)) if rate == rate else 2.0


class Server(uvicorn.Server):
    """Ends when told to: pages come back by themselves."""

    GRACE = 1.0  # for a service call to a world that may be gone already [s, wall]

    def __init__(self, config, viewer):
        super().__init__(config)
        self._viewer = viewer

    async def startup(self, sockets=None):
        await super().startup(sockets)
        self._viewer.start()

    def handle_exit(self, sig, frame):
        self.should_exit = self.force_exit = True
        end = threading.Timer(self.GRACE, os._exit, (0,))
        end.daemon = True
        end.start()


def server_of(viewer, token="", rate=100):
    """A Server for a Viewer; run it with the sockets to listen at."""
    return Server(config_of(viewer.application(token, rate)), viewer)


def config_of(application):
    """How uvicorn serves."""
    return uvicorn.Config(
        application,
        http=BoundedConnection,
        lifespan="off",
        log_level="warning",
        access_log=False,
        server_header=False,
        proxy_headers=False,
        ws_max_size=MOST_MESSAGE,
        # Numbers hardly shrink, and it would cost more than all else here.
        ws_per_message_deflate=False,
    )
