# SPDX-License-Identifier: Apache-2.0
"""The application of a warehouse behind ROS: the page, its WebSocket and the HTTP API."""

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import Any

from fastapi import FastAPI, HTTPException, Request
from fastapi.encoders import jsonable_encoder
from fastapi.exceptions import RequestValidationError
from starlette.routing import Match

from warehouse_client.heard_commands import hear, hear_calls
from warehouse_msgs.msg import Event, TransportEvent
from warehouse_viewer.api import catalogue, description, routes, zones_json
from warehouse_viewer.api.backend import ApiBackend
from warehouse_viewer.api.change_book import ChangeBook
from warehouse_viewer.api.command_log import CommandLog, LogsCommands
from warehouse_viewer.api.metrics import Metrics
from warehouse_viewer.api.routes import prometheus, sockets
from warehouse_viewer.api.schemas.pydantic_versions import faults_of
from warehouse_viewer.api.transport_book import TransportBook
from warehouse_viewer.editor.routes import Editor
from warehouse_viewer.json_text import JSONResponse
from warehouse_viewer.page.hub import Hub
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.model import Model
from warehouse_viewer.page.source import Source
from warehouse_viewer.replay.live import LiveRecording
from warehouse_viewer.replay.live_figures import LiveFigures
from warehouse_viewer.replay.memory import SECONDS
from warehouse_viewer.ros.commander import Commander
from warehouse_viewer.ros.coordination import Coordination
from warehouse_viewer.ros.emergency_stop import EmergencyStop
from warehouse_viewer.ros.feed import Feed
from warehouse_viewer.ros.heard_commands import CommandNotes
from warehouse_viewer.ros.operations_client import OperationsClient
from warehouse_viewer.ros.shift_feed import ShiftFeed
from warehouse_viewer.ros.simulation import Simulation
from warehouse_viewer.server import documentation
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.server.http_server import HubTask, Server, config_of
from warehouse_viewer.server.site import API, DOCS, FLOOR, LAYOUT, OPERATIONS, WHATIF, Site
from warehouse_viewer.server.sockets import SocketLimit
from warehouse_viewer.server.station_pages import StationPages
from warehouse_viewer.watch import webhooks
from warehouse_viewer.watch.alarm_file import AlarmFile
from warehouse_viewer.watch.monitor import Monitor
from warehouse_viewer.whatif import places
from warehouse_viewer.whatif.routes import routes as whatif_routes
from warehouse_viewer.whatif.workshop import Workshop


class Viewer:
    """Everything behind one address. `ros` is rospy, `web` the folder of the page; the last
    `history` seconds (simulated) are kept, to be looked at again; 0: none. `alarms`: the file from
    which a viewer that is restarted has them; None: it begins empty. `hooks` get the alarms.
    """

    def __init__(
        self,
        ros: ModuleType,
        web: Path,
        history: float = SECONDS,
        alarms: AlarmFile | None = None,
        hooks: webhooks.Webhooks | None = None,
    ) -> None:
        self._hooks = hooks
        self.address = ""  # of the pages, as links of webhooks have it
        self.journal = Journal()
        self.commander = Commander(ros)
        self.transports = TransportBook()
        self.changes = ChangeBook()
        self._loop: asyncio.AbstractEventLoop | None = None
        feed = Feed(ros, self._on_event, self._on_transport, self._on_message)
        simulation = Simulation(ros)
        describe = catalogue.plain_coordinator
        self.stop = EmergencyStop(ros)
        source = Source(
            feed,
            simulation,
            self.journal,
            describe,
            self._explain,
            self._stopped,
            zones_json.zones,
        )
        model, shift = Model(), ShiftFeed(ros, self.changes)
        self.history = (
            LiveRecording(model, self.journal, LiveFigures(feed, shift).read, history)
            if history
            else None
        )
        self.hub = Hub(source, model, self.history)
        operations = OperationsClient(ros, shift)
        self.monitor = Monitor(
            feed,
            operations.feed,
            self.journal,
            self.changes,
            self.transports.assigned,
            alarms,
            self.stop,
            self._tell,
        )
        self.commands = CommandLog(lambda: self.monitor.now)
        notes = CommandNotes(ros, self.commands)
        hear(ros, self.stop.hear, notes.note)
        hear_calls(ros, notes.note_call)
        recording = self.history
        recorded = (lambda: recording.size) if recording else None
        self.metrics = Metrics(feed, operations, recorded)
        self.backend = ApiBackend(
            feed,
            self.journal,
            simulation,
            self.commander,
            Coordination(ros),
            self.transports,
            operations,
            self.changes,
            self.monitor,
            self.stop,
            self.commands,
        )
        self._web = web
        self._hub_task = HubTask(self.hub)

    def _explain(self, name: str) -> dict[str, Any] | None:
        reason = self.monitor.reasons.find(name)
        return reason.as_json() if reason else None

    def _stopped(self) -> str | None:
        """Returns who has stopped the fleet; None: it may move."""
        hold = self.stop.hold
        return (hold.by or "a client") if hold else None

    def _tell(self, event: str, alarm: Mapping[str, Any]) -> None:
        if self._hooks:
            self._hooks.post(webhooks.message(event, alarm, self.address.rstrip("/")))

    def _on_event(self, event: Event) -> None:
        entry = self.journal.add(catalogue.event(event))
        with suppress(RuntimeError):  # the loop has ended
            if self._loop:
                self._loop.call_soon_threadsafe(self._note, entry)

    def _note(self, entry: dict[str, Any]) -> None:
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
            default_response_class=JSONResponse,
        )
        app.state.backend, app.state.hub = self.backend, self.hub
        app.state.metrics, app.state.sockets = self.metrics, SocketLimit()
        app.include_router(routes.router)
        setattr(app, "openapi", lambda: description.described(app))  # noqa: B010 (for mypy)
        app.get("/api/v1/openapi.json", include_in_schema=False)(app.openapi)
        app.add_exception_handler(405, not_allowed)
        app.add_exception_handler(RequestValidationError, not_valid)
        app.include_router(sockets.router)
        app.include_router(prometheus.router)
        self._add_files(app)
        return AccessControl(LogsCommands(app, self.commands), token, rate)

    def start(self) -> None:
        """Begins to serve pages, in the running asyncio loop."""
        self._loop = asyncio.get_running_loop()
        self._hub_task.start()
        self._watching = asyncio.create_task(self.monitor.run())

    def _add_files(self, app: FastAPI) -> None:
        operations = OPERATIONS._replace(counted="/api/v1/alarms")
        pages = Site(FLOOR, operations, LAYOUT, WHATIF, API, DOCS, folder=self._web)
        history = self.history.routes() if self.history else []
        screens = StationPages(self._totes, self._web).routes()
        editor = Editor(builds=True, compares=True).routes()
        whatif = whatif_routes(Workshop(places.of_viewer()))
        others = editor, whatif, history, screens, pages.routes(), documentation.routes()
        app.router.routes.extend(route for routes in others for route in routes)

    async def _totes(self, name: str) -> int | None:
        stations = (await self.backend.call(self.backend.operations.latest, "stations")).stations
        return next((station.slots for station in stations if station.name == name), None)


async def not_valid(request: Request, error: RequestValidationError) -> JSONResponse:
    """Answers 422 with what is wrong with a request."""
    return JSONResponse({"detail": jsonable_encoder(faults_of(error))}, 422)


async def not_allowed(request: Request, error: HTTPException) -> JSONResponse:
    """Answers 405 with every method of the path: each method has a route of its own."""
    routes = [
        route for route in request.app.routes if route.matches(request.scope)[0] != Match.NONE
    ]
    methods = sorted(set().union(*(getattr(route, "methods", None) or () for route in routes)))
    headers = {"allow": ", ".join(methods)}
    return JSONResponse({"detail": error.detail}, error.status_code, headers=headers)


def server_of(viewer: Viewer, token: str = "", rate: float = 100) -> Server:
    """Returns a Server for a Viewer; run it with the sockets to listen at."""
    return Server(config_of(viewer.application(token, rate)), viewer.start)
