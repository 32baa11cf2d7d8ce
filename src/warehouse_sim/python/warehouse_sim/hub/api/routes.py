# SPDX-License-Identifier: Apache-2.0
"""The hub's HTTP API: simulations, worlds, recordings, sizings, the journal; pages in /s/NAME/."""

from collections.abc import Callable

from starlette.routing import BaseRoute, Route, WebSocketRoute

from warehouse_sim.hub.api.answers import answered
from warehouse_sim.hub.api.description import OPENAPI
from warehouse_sim.hub.api.served_pages import (
    PREFIX,
    AssistantPages,
    RecordedPages,
    SimulationPages,
    to_pages,
    to_recording,
)
from warehouse_sim.hub.api.shelf import ShelfApi, WorldsApi
from warehouse_sim.hub.api.simulations import RECORDED, SIMULATIONS, WORLDS, SimulationsApi
from warehouse_sim.hub.api.sizings import SIZINGS, SizingsApi
from warehouse_sim.hub.assistant import Assistant
from warehouse_sim.hub.journal import Journal
from warehouse_sim.hub.recordings import Recordings
from warehouse_sim.hub.simulations import Simulations
from warehouse_sim.hub.sizing import REPORT
from warehouse_sim.hub.sizings import Sizings

JOURNAL = "/api/v1/journal"
PAGES = f"{PREFIX}/{{name}}/{{rest:path}}"


def routes(
    simulations: Simulations,
    recordings: Recordings,
    journal: Journal,
    sizings: Sizings,
    assistant: Callable[[], Assistant],
) -> list[BaseRoute]:
    """Returns the routes of the API, of the simulations' pages, and of the assistant."""
    api, shelf = SimulationsApi(simulations, journal), ShelfApi(recordings, journal)
    worlds, pages = WorldsApi(simulations.worlds, journal), RecordedPages(recordings)
    sizing = SizingsApi(sizings, journal)
    return [
        Route(SIMULATIONS, answered(api.list), methods=["GET"]),
        Route(SIMULATIONS, answered(api.create), methods=["POST"]),
        Route("/api/v1/simulation-arguments", answered(api.arguments), methods=["GET"]),
        Route(f"{SIMULATIONS}/{{name}}", answered(api.get), methods=["GET"]),
        Route(f"{SIMULATIONS}/{{name}}", answered(api.join), methods=["PUT"]),
        Route(f"{SIMULATIONS}/{{name}}", answered(api.delete), methods=["DELETE"]),
        Route(f"{SIMULATIONS}/{{name}}/start", answered(api.start), methods=["POST"]),
        Route(f"{SIMULATIONS}/{{name}}/restart", answered(api.restart), methods=["POST"]),
        Route(f"{SIMULATIONS}/{{name}}/worlds", answered(api.insert), methods=["POST"]),
        Route(f"{SIMULATIONS}/{{name}}/save", answered(api.save), methods=["POST"]),
        Route(f"{SIMULATIONS}/{{name}}/recording", answered(api.keep), methods=["POST"]),
        Route(f"{SIMULATIONS}/{{name}}/log", answered(api.log), methods=["GET"]),
        Route(WORLDS, answered(worlds.list), methods=["GET"]),
        Route(f"{WORLDS}/{{name}}", answered(worlds.get), methods=["GET"]),
        Route(f"{WORLDS}/{{name}}", answered(worlds.put), methods=["PUT"]),
        Route(f"{WORLDS}/{{name}}", answered(worlds.delete), methods=["DELETE"]),
        Route("/api/v1/recordings", answered(shelf.recordings), methods=["GET"]),
        Route(SIZINGS, answered(sizing.list), methods=["GET"]),
        Route(SIZINGS, answered(sizing.create), methods=["POST"]),
        Route(f"{SIZINGS}/{{number}}", answered(sizing.get), methods=["GET"]),
        Route(f"{SIZINGS}/{{number}}", answered(sizing.delete), methods=["DELETE"]),
        Route(f"{SIZINGS}/{{number}}/{REPORT}", answered(sizing.report), methods=["GET"]),
        Route(OPENAPI, answered(shelf.description), methods=["GET"]),
        Route(JOURNAL, answered(shelf.journal), methods=["GET"]),
        Route(JOURNAL, answered(shelf.note), methods=["POST"]),
        Route(f"{RECORDED}/{{name}}", to_recording),
        Route(f"{RECORDED}/{{name}}/{{rest:path}}", pages),
        WebSocketRoute(f"{RECORDED}/{{name}}/{{rest:path}}", pages),
        Route(f"{PREFIX}/{{name}}", to_pages),
        Route(PAGES, SimulationPages(simulations)),
        WebSocketRoute(PAGES, SimulationPages(simulations)),
        Route("/mcp", AssistantPages(assistant)),
    ]
