# SPDX-License-Identifier: Apache-2.0
"""Alarms, the four leading figures, and what robots and stations did in the last hour."""

from typing import Any

from fastapi import APIRouter, HTTPException, Path, Query
from fastapi.responses import Response

from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import SENT, problems
from warehouse_viewer.api.schemas.watch import Alarm, Alarms, LeadingFigures, Seen
from warehouse_viewer.watch.alarm_kinds import KINDS

router = APIRouter()
ALARM = Path(ge=1, le=2**53)
COUNT = Query(0, ge=0, le=2**53)
NO_FIGURES = "there are no figures; is a shift running (operations.launch)?"
BYTES: dict[int | str, dict[str, Any]] = {
    200: {"content": {"application/octet-stream": {"schema": {"type": "string"}}}}
}


@router.get("/alarms", response_model=Alarms, responses=problems())
async def get_alarms(backend: ApiBackend = BACKEND) -> object:
    """The alarms: since when each holds, its cause, what to do, and the person that saw it."""
    alarms = backend.monitor.alarms.told()
    kinds = {name: kind._asdict() for name, kind in KINDS.items()}
    return {"total": len(alarms), "alarms": alarms, "kinds": kinds}


@router.post("/alarms/{number}/seen", response_model=Alarm, responses=problems(404, *SENT))
async def see_alarm(body: Seen, number: int = ALARM, backend: ApiBackend = BACKEND) -> object:
    """A person has seen an alarm; all clients show who it was for as long as the alarm lasts."""
    alarm = backend.monitor.see(number, body.by.strip())
    if alarm is None:
        raise HTTPException(404, f"alarm {number} has ended, or never was")
    return alarm


@router.get("/figures", response_model=LeadingFigures, responses=problems())
async def get_figures(backend: ApiBackend = BACKEND) -> object:
    """Pieces and orders an hour, late orders, available robots: now, their last hour, targets."""
    figures = backend.monitor.figures()
    if figures is None:
        raise HTTPException(503, NO_FIGURES)
    return figures


@router.get("/spans", response_class=Response, responses=problems() | BYTES)
async def get_spans(
    epoch: int = COUNT, since: int = COUNT, known: int = COUNT, backend: ApiBackend = BACKEND
) -> Any:
    """What each robot and station did in the last hour, or what is new to who sends the `epoch`
    and `last` of the answer before, and the number of rows that are `known`. Bytes: a uint32, how
    long the head in JSON is that follows; of `moments` times after `origin` [s] as float32; of
    each how many changes it has as uint32; the changes as uint32, the row times 8 plus the state:
    0 to 4 as the activities of robots, 7 unknown."""
    data = backend.monitor.spans.encode(epoch, since, known)
    headers = {"cache-control": "no-store"}
    return Response(data, media_type="application/octet-stream", headers=headers)
