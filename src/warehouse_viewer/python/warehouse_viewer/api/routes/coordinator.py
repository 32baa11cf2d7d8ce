# SPDX-License-Identifier: Apache-2.0
"""The coordinator: its state, modes of robots, and transports."""

from typing import Any

from fastapi import APIRouter, Body, HTTPException, Path

from warehouse_viewer.api import catalogue
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.remedies import apply
from warehouse_viewer.api.routes.common import LIMIT, NUMBER, OFFSET, SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.fleet import (
    Coordinator,
    FleetStop,
    NewFailure,
    NewMode,
    NewTransport,
    Transport,
    TransportNumber,
    Transports,
    TransportState,
)
from warehouse_viewer.api.schemas.pydantic_versions import as_dict
from warehouse_viewer.api.schemas.watch import Doer
from warehouse_viewer.watch.causes import LABELS

router = APIRouter()
DOER = Body(Doer())  # if there is no body
TRANSPORT = Path(ge=1, le=2**32 - 1, description="of the transport")


@router.get("/coordinator", response_model=Coordinator, responses=problems(404))
async def get_coordinator(backend: ApiBackend = BACKEND) -> object:
    """The fleet at a glance."""
    return catalogue.coordinator(await backend.coordinator(), backend.feed["fleet"])


@router.post("/robots/{number}/mode", response_model=Done, responses=problems(404, *SENT))
async def set_mode(body: NewMode, number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """Gives a robot to the coordinator or to a person, or takes it out of service."""
    await backend.robot(number)
    message = await backend.coordinate("set_mode", number, body.mode)
    label = {"AUTOMATIC": "Automatic again", "MANUAL": "Manual"}.get(body.mode, "Out of service")
    backend.monitor.note(f"kiva{number}", body.by.strip(), label)
    return {"message": message}


@router.post("/robots/{number}/failure", response_model=Done, responses=problems(404, *SENT))
async def break_robot(
    body: NewFailure, number: int = NUMBER, backend: ApiBackend = BACKEND
) -> object:
    """Breaks something in a simulated robot, until it is repaired or the time is over."""
    await backend.robot(number)
    message = await backend.simulate("fail", number, body.kind, body.repair_time)
    return {"message": message or f"kiva{number}: {body.kind}"}


@router.post("/robots/{number}/repair", response_model=Done, responses=problems(404, *SENT))
async def repair_robot(body: Doer, number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """Repairs all that is broken in a robot."""
    await backend.robot(number)
    return await _mended(backend, "REPAIR", number, body.by)


@router.post("/robots/{number}/tow", response_model=Done, responses=problems(404, *SENT))
async def tow_robot(body: Doer, number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """Moves a broken robot, with what it carries, to where it is in no robot's way."""
    await backend.robot(number)
    return await _mended(backend, "TOW", number, body.by)


async def _mended(backend: ApiBackend, action: str, number: int, by: str) -> object:
    name = f"kiva{number}"
    message = await apply(backend, action, name)
    backend.monitor.note(name, by.strip(), LABELS[action])
    return {"message": message}


@router.get("/fleet/stop", response_model=FleetStop, responses=problems())
async def get_stop(backend: ApiBackend = BACKEND) -> object:
    """Whether an emergency stop holds all robots, and who asked for it."""
    hold = backend.stop.hold
    return {"stopped": bool(hold)} | (hold._asdict() if hold else {"by": "", "since": 0.0})


@router.post("/fleet/stop", response_model=Done, responses=problems(*SENT))
async def stop_fleet(body: Doer = DOER, backend: ApiBackend = BACKEND) -> object:
    """Stops all robots at once, and holds them, while simulated time goes on. Robots that are
    added, or are put back by a reset, stand too."""
    return {"message": await backend.call(backend.stop.stop, body.by.strip())}


@router.post("/fleet/release", response_model=Done, responses=problems(*SENT))
async def release_fleet(body: Doer = DOER, backend: ApiBackend = BACKEND) -> object:
    """Ends the emergency stop: each robot goes on with what it did."""
    message = await backend.call(backend.stop.release)
    backend.monitor.note("fleet", body.by.strip(), LABELS["RELEASE"])
    return {"message": message}


@router.get("/transports", response_model=Transports, responses=problems())
async def get_transports(
    state: TransportState | None = None,
    limit: int = LIMIT,
    offset: int = OFFSET,
    backend: ApiBackend = BACKEND,
) -> object:
    """How far each is, the newest first; those since the viewer began."""
    rows = backend.transports.newest_first(state)
    chosen = [_with_zone(row, backend) for row in rows[offset : offset + limit]]
    return {"total": len(rows), "transports": chosen}


@router.get("/transports/{number}", response_model=Transport, responses=problems(404))
async def get_transport(number: int = TRANSPORT, backend: ApiBackend = BACKEND) -> object:
    """How far it is."""
    row = backend.transports.get(number)
    if row is None:
        raise HTTPException(404, f"no transport {number}")
    return _with_zone(row, backend)


def _with_zone(row: dict[str, Any], backend: ApiBackend) -> dict[str, Any]:
    """Returns a transport with the closed zone that it waits for, if it does, as its text."""
    message = backend.feed.zones
    held = dict(zip(message.transport_id, message.why)) if message else {}
    return row | {"text": held[row["id"]]} if row["id"] in held else row


@router.post(
    "/transports",
    status_code=201,
    response_model=TransportNumber,
    responses=problems(*SENT),
)
async def submit_transport(body: NewTransport, backend: ApiBackend = BACKEND) -> object:
    """Has a storage unit brought somewhere. It waits there to be released."""
    return {"transport_id": await backend.coordinate("submit", *as_dict(body).values())}


@router.post(
    "/transports/{number}/release",
    response_model=Done,
    responses=problems(409),
)
async def release_transport(number: int = TRANSPORT, backend: ApiBackend = BACKEND) -> object:
    """The station is done with the unit: it may leave."""
    return {"message": await backend.coordinate("release", number)}
