# SPDX-License-Identifier: Apache-2.0
"""The recording of a broker of VDA 5050 beside that of the floor: its vehicles at a moment."""

import math
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from warehouse_vda5050.master.onboarded_file import OnboardedFile
from warehouse_vda5050.recording import file
from warehouse_vda5050.recording.moments import Moment, Moments
from warehouse_viewer.json_text import JSONResponse


class Vda5050Past:
    """Serves the vehicles of a recording. Raises OSError, ValueError: what can't be read.

    recorded: what `record` has written; robots: the file of vehicles that the warehouse drives,
    with what was added and removed in the file beside it.
    """

    def __init__(self, recorded: Path, robots: Path | None) -> None:
        remote = OnboardedFile(robots).robots() if robots else []
        numbers = {robot.identity: robot.number for robot in remote}
        self._moments, self._name = Moments(file.read(recorded), numbers), recorded.name
        if not self._moments.count:
            raise ValueError(
                f"{recorded}: no vehicle in it is a robot: serials that are numbers were expected,"
                " or those of --robots"
            )

    def routes(self) -> list[Route]:
        """Returns the route, to be added to an application."""
        return [Route("/recording/vda5050", self._at)]

    async def _at(self, request: Request) -> Response:
        text = request.query_params.get("at", "")
        try:
            time = float(text)
        except ValueError:
            time = math.nan
        if not math.isfinite(time):
            detail = f"at is {text!r:.40}; seconds since 1970 were expected"
            return JSONResponse({"detail": detail}, 422)
        return JSONResponse([_row(moment, self._name, time) for moment in self._moments.at(time)])


def _row(moment: Moment, source: str, time: float) -> dict[str, Any]:
    """Returns a vehicle with the names of GET /api/v1/vda5050, and what its state had besides."""
    doing = moment.doing
    return {
        "id": moment.number,
        "driven_by": "COORDINATOR" if moment.is_ours else "OUTSIDE_MASTER",
        "manufacturer": moment.identity.manufacturer,
        "serial": moment.identity.serial,
        "broker": source,
        "connection": moment.connection,
        "driven": bool(doing.base or doing.horizon or doing.driving),
        "order": doing.order,
        "errors": doing.errors,
        "faults": [],
        "past": {
            "update": doing.update,
            "ordered": moment.ordered,
            "ordered_update": moment.ordered_update,
            "last_node": doing.last_node,
            "base": doing.base,
            "horizon": doing.horizon,
            "driving": doing.driving,
            "paused": doing.paused,
            "mode": doing.mode,
            "actions": doing.actions,
            "age": None if moment.told_at is None else round(time - moment.told_at, 3),
        },
    }
