# SPDX-License-Identifier: Apache-2.0
"""What the page /whatif asks of its server."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

from starlette.requests import Request
from starlette.responses import HTMLResponse, Response
from starlette.routing import Route

from warehouse_layout.file.layout_file import SUFFIX, LayoutFileError
from warehouse_layout.file.request import LIMITS, MOST_STATIONS, PRESETS
from warehouse_operations.policies import DEFAULTS, ROLES
from warehouse_operations.runs.run_files import RunError
from warehouse_operations.runs.simulation import ERRORS
from warehouse_operations.sizing.prices import PriceError
from warehouse_operations.stock.order_file import DemandError
from warehouse_viewer.json_text import JSONResponse
from warehouse_viewer.server.csp import REPORT_CONTENT
from warehouse_viewer.server.site import WHATIF
from warehouse_viewer.whatif.design_settings import DesignError, DesignSettings
from warehouse_viewer.whatif.queue import QueueError
from warehouse_viewer.whatif.scenario import (
    MOST_MINUTES,
    MOST_SEEDS,
    REALISM,
    Scenario,
    ScenarioError,
)
from warehouse_viewer.whatif.workshop import COMPARED, Workshop

PAGE = WHATIF.path
FRESH = {"cache-control": "no-store"}
SVG, LAYOUT_TYPE = "image/svg+xml", "text/yaml"
DRAWING_CONTENT = {
    "content-security-policy": "sandbox; default-src 'none'; style-src 'unsafe-inline'"
}
REFUSED = (
    ScenarioError,
    QueueError,
    LayoutFileError,
    DemandError,
    RunError,
    PriceError,
    *ERRORS,
)

Answer = dict[str, Any]
Endpoint = Callable[[Request], Awaitable[Response]]


def routes(workshop: Workshop) -> list[Route]:
    """Returns what the page asks of a Workshop, to be added to an application."""
    scenario = f"{PAGE}/scenarios/{{name}}"
    posts, work = ["POST"], workshop
    seed = f"{scenario}/seeds/{{seed:int}}"
    design, designs = f"{PAGE}/designs/{{name}}", work.designs
    return [
        Route(f"{PAGE}/about", _answering(work, lambda _: _about(work))),
        Route(f"{PAGE}/scenarios", _answering(work, lambda _: work.scenarios())),
        Route(f"{PAGE}/scenarios", _asking(work, work.create, "name", "settings"), methods=posts),
        Route(f"{PAGE}/estimate", _asking(work, work.estimate, "settings"), methods=posts),
        Route(f"{PAGE}/layouts", _asking(work, work.add_layout, "name", "text"), methods=posts),
        Route(f"{PAGE}/stock", _asking(work, work.add_stock, "name", "text"), methods=posts),
        Route(f"{PAGE}/orders", _asking(work, work.add_orders, "name", "text"), methods=posts),
        Route(f"{PAGE}/costs", _asking(work, work.set_costs, "name", "text"), methods=posts),
        Route(f"{PAGE}/costs", _asking(work, work.drop_costs), methods=["DELETE"]),
        Route(scenario, _asking(work, work.change, "settings"), methods=["PUT"]),
        Route(scenario, _asking(work, work.delete), methods=["DELETE"]),
        Route(f"{scenario}/duplicate", _asking(work, work.duplicate), methods=posts),
        Route(f"{scenario}/rename", _asking(work, work.rename, "to"), methods=posts),
        Route(f"{scenario}/run", _asking(work, work.run), methods=posts),
        Route(f"{scenario}/run", _asking(work, work.cancel), methods=["DELETE"]),
        Route(f"{seed}/report.html", _report(work, lambda r: _its_report(work, r))),
        Route(f"{PAGE}/compare", _answering(work, lambda r: work.compare(_names(r)))),
        Route(f"{PAGE}/report.html", _report(work, lambda r: work.report(_names(r)))),
        Route(f"{PAGE}/designs", _answering(work, lambda _: {"designs": designs.all()})),
        Route(f"{PAGE}/designs", _asking(work, designs.create, "name", "settings"), methods=posts),
        Route(
            f"{PAGE}/designs/estimate", _asking(work, designs.estimate, "settings"), methods=posts
        ),
        Route(design, _asking(work, designs.delete), methods=["DELETE"]),
        Route(f"{design}/run", _asking(work, designs.run), methods=posts),
        Route(f"{design}/run", _asking(work, designs.cancel), methods=["DELETE"]),
        Route(f"{design}/report.html", _report(work, lambda r: designs.report(**r.path_params))),
        Route(f"{design}/layouts/{{layout}}", _text(work, designs.layout, LAYOUT_TYPE)),
        Route(
            f"{design}/layouts/{{layout}}/plan.svg",
            _text(work, designs.drawing, SVG, DRAWING_CONTENT),
        ),
    ]


def _about(workshop: Workshop) -> Answer:
    return workshop.about() | {
        "presets": {
            name: {"robots": preset.robots, "stations": preset.belts, "units": preset.shelves}
            for name, preset in PRESETS.items()
            if preset.robots
        },
        "policies": {role: list(names) for role, names in ROLES.items()},
        "default_policies": DEFAULTS,
        "realism": REALISM,
        "defaults": Scenario().to_json(),
        "design_defaults": DesignSettings().to_json(),
        "most": {
            "robots": LIMITS["robots"],
            "stations": MOST_STATIONS,
            "minutes": MOST_MINUTES,
            "seeds": MOST_SEEDS,
            "compared": COMPARED[1],
        },
        "suffix": SUFFIX,
    }


def _names(request: Request) -> list[str]:
    return request.query_params.getlist("name")


def _answering(workshop: Workshop, work: Callable[[Request], Answer]) -> Endpoint:
    """Returns an endpoint that answers with what `work` returns, called in a thread."""

    async def endpoint(request: Request) -> Response:
        return await _answered(workshop, lambda: JSONResponse(work(request), headers=FRESH))

    return endpoint


def _asking(workshop: Workshop, work: Callable[..., Answer], *fields: str) -> Endpoint:
    """Returns an endpoint that calls `work` with the names in the path, and with the fields of the
    request's body."""

    async def endpoint(request: Request) -> Response:
        try:
            body = await request.json() if fields else {}
        except ValueError as error:
            return JSONResponse({"detail": f"the request is wrong: {error}"}, 422)
        if not isinstance(body, dict) or body.keys() != {*fields}:
            return JSONResponse({"detail": f"the fields {', '.join(fields)} were expected"}, 422)
        if not all(isinstance(body[key], str) for key in ("name", "text", "to") if key in body):
            return JSONResponse({"detail": "texts were expected"}, 422)
        arguments = request.path_params | body
        return await _answered(workshop, lambda: JSONResponse(work(**arguments), headers=FRESH))

    return endpoint


def _text(
    workshop: Workshop,
    work: Callable[..., str],
    media_type: str,
    headers: dict[str, str] | None = None,
) -> Endpoint:
    """Returns an endpoint that answers with the text that `work` returns for the path's names."""

    async def endpoint(request: Request) -> Response:
        return await _answered(
            workshop,
            lambda: Response(
                work(**request.path_params), headers=FRESH | (headers or {}), media_type=media_type
            ),
        )

    return endpoint


def _report(workshop: Workshop, work: Callable[[Request], str]) -> Endpoint:
    headers = FRESH | {"content-security-policy": REPORT_CONTENT}

    async def endpoint(request: Request) -> Response:
        return await _answered(workshop, lambda: HTMLResponse(work(request), headers=headers))

    return endpoint


def _its_report(workshop: Workshop, request: Request) -> str:
    return workshop.report_of(request.path_params["name"], request.path_params["seed"])


async def _answered(workshop: Workshop, work: Callable[[], Response]) -> Response:
    def opened() -> Response:
        workshop.open()
        return work()

    try:
        return await asyncio.to_thread(opened)
    except DesignError as error:
        return JSONResponse({"detail": str(error), "field": error.field}, 409)
    except REFUSED as error:
        return JSONResponse({"detail": str(error)}, 409)
