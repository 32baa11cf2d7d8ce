# SPDX-License-Identifier: Apache-2.0
"""The application of a warehouse behind ROS: the page, its WebSocket and the HTTP API."""

import asyncio
from contextlib import suppress
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Request, WebSocket
from fastapi.responses import Response

from warehouse_msgs.msg import Event, TransportEvent
from warehouse_viewer.api import api, catalogue, changes, metrics, sockets, stream
from warehouse_viewer.api.change_book import ChangeBook
from warehouse_viewer.api.transport_book import TransportBook
from warehouse_viewer.api.work import Work
from warehouse_viewer.page.hub import Hub
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.model import Model
from warehouse_viewer.page.source import Source
from warehouse_viewer.ros.commander import Commander
from warehouse_viewer.ros.coordination import Coordination
from warehouse_viewer.ros.feed import Feed
from warehouse_viewer.ros.shift_feed import ShiftFeed
from warehouse_viewer.ros.simulation import Simulation
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.http_server import HubTask, Server, config_of
from warehouse_viewer.server.page_files import PageFiles, SocketLimit
from warehouse_viewer.server.static_files import Files
from warehouse_viewer.shared_files import THREE

UNSUPPORTED = 1003  # a WebSocket's close code
MOST_REASON = 120  # characters beside one
METRICS = {200: {"content": {"text/plain": {"schema": {"type": "string"}}}}}


class Viewer:
    """Everything behind one address. `ros` is rospy, `web` the folder of the page."""

    def __init__(self, ros: Any, web: Path) -> None:
        self.journal = Journal()
        self.commander = Commander(ros)
        self.transports = TransportBook()
        self._loop, self.changes = None, ChangeBook()
        feed = Feed(ros, self._on_event, self._on_transport, self._on_message)
        simulation = Simulation(ros)
        source = Source(feed, simulation, self.journal, catalogue.plain_coordinator)
        model = Model()
        self.hub = Hub(source, model)
        parts = (feed, model, self.journal, simulation, self.commander)
        work = Work(ros, ShiftFeed(ros, self.changes))
        self.metrics = metrics.Metrics(feed, work)
        self.backend = api.ApiBackend(
            *parts, Coordination(ros), self.transports, work, self.changes
        )
        self._web, self._sockets = web, SocketLimit()
        self._hub_task = HubTask(self.hub)

    def _on_event(self, event: Event) -> None:
        entry = self.journal.add(catalogue.event(event))
        with suppress(RuntimeError):  # the loop has ended
            if self._loop:
                self._loop.call_soon_threadsafe(self._note, entry)

    def _note(self, entry):
        self.commander.note(entry)
        self.hub.notify()

    def _on_transport(self, event: TransportEvent) -> None:
        self.changes.note("transports", event.transport_id, self.transports.add(event))

    def _on_message(self) -> None:
        self.hub.notify()

    def application(self, token: str = "", rate: float = 100) -> AccessControl:
        """Returns the ASGI application; `rate` is in requests per second of each address."""
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

    def start(self) -> None:
        """Begins to serve pages, in the running asyncio loop."""
        self._loop = asyncio.get_running_loop()
        self._hub_task.start()

    def _add_sockets(self, app):
        @app.websocket("/live")
        async def live(socket: WebSocket):
            await self._sockets.admit(socket, self.hub.serve)

        @app.websocket("/api/v1/stream")
        async def json_stream(socket: WebSocket, rate: float = 2.0):
            rate = _bounded(rate)
            await self._sockets.admit(socket, lambda s: stream.serve(s, self.backend, rate))

        @app.websocket("/api/v1/changes")
        async def json_changes(socket: WebSocket, of: str = "", rate: float = 2.0):
            try:
                topics = changes.topics(of)
            except ValueError as error:
                await socket.accept()
                await socket.close(UNSUPPORTED, str(error)[:MOST_REASON])
                return
            rate = _bounded(rate)
            await self._sockets.admit(
                socket, lambda s: changes.serve(s, self.backend, topics, rate)
            )

    def _add_files(self, app):
        page = PageFiles(self._web)

        @app.get("/metrics", response_class=Response, responses=METRICS)
        async def get_metrics(request: Request):
            """Figures for Prometheus."""
            await self.backend.glance()
            accepted = request.headers.get("accept", "")
            text, kind = await asyncio.to_thread(self.metrics.text, accepted)
            return Response(text, headers={"content-type": kind})

        for path, name in (
            ("/", "index.html"),
            ("/operations", "operations.html"),
            ("/docs", "docs.html"),
        ):
            app.get(path, include_in_schema=False)(page.endpoint(name))
        app.mount("/three", Files(directory=THREE, check_dir=False))
        app.mount("/web", page.files)


def _bounded(rate):
    """Returns the rate that a client gets, in messages per second."""
    return min(10.0, max(0.1, rate)) if rate == rate else 2.0


def server_of(viewer: Viewer, token: str = "", rate: float = 100) -> Server:
    """Returns a Server for a Viewer; run it with the sockets to listen at."""
    return Server(config_of(viewer.application(token, rate)), viewer.start)
