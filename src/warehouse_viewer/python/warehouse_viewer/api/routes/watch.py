# SPDX-License-Identifier: Apache-2.0
"""Alarms, the four leading figures, and what robots and stations did in the last hour."""

from datetime import datetime
from typing import Any

from fastapi import APIRouter, HTTPException, Path, Query
from fastapi.responses import Response

from warehouse_viewer.api import zones_json
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.handover import HOUR, Situation, written
from warehouse_viewer.api.remedies import apply
from warehouse_viewer.api.routes.common import SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.watch import (
    Alarm,
    AlarmHistory,
    Alarms,
    Doer,
    LeadingFigures,
    Seen,
    Why,
)
from warehouse_viewer.watch.alarm_kinds import KINDS

router = APIRouter()
ALARM = Path(ge=1, le=2**53)
ACTION = Path(max_length=40, regex=r"^[A-Z_]+$")
SUBJECT = Path(max_length=80, regex=r"^[ -~]+$", description="kiva3, pick1")
TIME = Query(None, ge=0, le=1e10, description="[s], simulated")
COUNT = Query(0, ge=0, le=2**53)
NO_FIGURES = "there are no figures; is a shift running (operations.launch)?"
TEXT: dict[int | str, dict[str, Any]] = {
    200: {"content": {"text/markdown": {"schema": {"type": "string"}}}}
}
BYTES: dict[int | str, dict[str, Any]] = {
    200: {"content": {"application/octet-stream": {"schema": {"type": "string"}}}}
}


@router.get("/alarms", response_model=Alarms, responses=problems())
async def get_alarms(backend: ApiBackend = BACKEND) -> object:
    """The alarms: since when each holds, its cause, what to do, and the person that saw it."""
    alarms = backend.monitor.alarms.as_json()
    kinds = {name: kind._asdict() for name, kind in KINDS.items()}
    return {"total": len(alarms), "alarms": alarms, "kinds": kinds}


@router.post("/alarms/{number}/seen", response_model=Alarm, responses=problems(404, *SENT))
async def see_alarm(body: Seen, number: int = ALARM, backend: ApiBackend = BACKEND) -> object:
    """A person has seen an alarm; all clients show who it was for as long as the alarm lasts."""
    alarm = backend.monitor.see(number, body.by.strip())
    if alarm is None:
        raise HTTPException(404, f"alarm {number} has ended, or never was")
    return alarm


@router.get("/alarms/history", response_model=AlarmHistory, responses=problems())
async def get_alarm_history(backend: ApiBackend = BACKEND) -> object:
    """The alarms that have ended: cause, duration, who did what; and the mean time to repair."""
    book = backend.monitor.alarms
    alarms, (repairs, mean) = book.history(), book.time_to_repair()
    return {
        "total": len(alarms),
        "alarms": alarms,
        "repairs": repairs,
        "mean_time_to_repair": round(mean, 1),
    }


@router.post(
    "/alarms/{number}/remedies/{action}", response_model=Done, responses=problems(404, *SENT)
)
async def apply_remedy(
    body: Doer, action: str = ACTION, number: int = ALARM, backend: ApiBackend = BACKEND
) -> object:
    """Does what one of an alarm's `remedies` says, and notes who did it."""
    alarm = next((row for row in backend.monitor.alarms.as_json() if row["id"] == number), None)
    if alarm is None:
        raise HTTPException(404, f"alarm {number} has ended, or never was")
    remedy = next((row for row in alarm["remedies"] if row["action"] == action), None)
    if remedy is None:
        offered = ", ".join(row["action"] for row in alarm["remedies"])
        raise HTTPException(409, f"{action} is no remedy of alarm {number} now; it has {offered}")
    message = await apply(backend, action, remedy["target"])
    backend.monitor.note(remedy["target"], body.by.strip(), remedy["label"])
    return {"message": message}


@router.get("/why/{name}", response_model=Why, responses=problems(404))
async def get_why(
    name: str = SUBJECT, time: float | None = TIME, backend: ApiBackend = BACKEND
) -> object:
    """Why a robot or a station waits, where a robot goes, and for which order. With `time`: the
    sentence that held then, as far as it is remembered."""
    reasons = backend.monitor.reasons
    reason = reasons.find(name)
    if reason is None:
        raise HTTPException(404, f"no robot or station {name}")
    out = reason.as_json()
    return out | {"sentence": reasons.at(name, time)} if time is not None else out


@router.get("/handover.md", response_class=Response, responses=problems() | TEXT)
async def get_handover(
    hours: float = Query(8, ge=0.1, le=1000, description="simulated, that it looks back"),
    backend: ApiBackend = BACKEND,
) -> Any:
    """The handover note of a shift, as Markdown: what holds, figures, what happened, who did
    what."""
    wall = datetime.now().astimezone().isoformat(" ", "minutes")
    text = written(await _situation(backend, hours), wall)
    return Response(text, media_type="text/markdown; charset=utf-8")


async def _situation(backend: ApiBackend, hours: float) -> Situation:
    robots = await backend.robots()
    shift, book, hold = backend.operations.feed, backend.monitor.alarms, backend.stop.hold
    stations, now = shift["stations"], backend.monitor.now
    return Situation(
        name=(await backend.simulate("warehouse"))[0],
        since=max(0.0, now - hours * HOUR),
        now=now,
        stop=(hold.by or "a client") if hold else None,
        alarms=book.as_json(),
        past=book.history(),
        robots=robots,
        stations=backend.stations(stations) if stations else (),
        commands=backend.commands.rows(),
        coordinator=backend.feed.coordinator,
        kpis=shift["kpis"],
        zones=zones_json.zones(backend.feed.zones)["zones"],
    )


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
