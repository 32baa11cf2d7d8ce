# SPDX-License-Identifier: Apache-2.0
"""Stations of a shift, and what people there confirm and report."""

from fastapi import APIRouter, Path

from warehouse_msgs import srv
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.operations import (
    MODES,
    OUTCOMES,
    Confirmation,
    PickReport,
    Reported,
    SetStation,
    Short,
    Stations,
)

router = APIRouter()
NAME = Path(max_length=80, regex=r"^[ -~]+$")
SEQUENCE = Path(ge=1, le=2**53)
AT_PICK = "/stations/{name}/picks/{sequence}"


@router.get("/stations", response_model=Stations, responses=problems())
async def get_stations(backend: ApiBackend = BACKEND) -> object:
    """The stations: what unit is there, what is to be done with it, what is on its way."""
    return {"stations": backend.stations(await backend.call(backend.operations.latest, "stations"))}


@router.put("/stations/{name}", response_model=Done, responses=problems(*SENT))
async def set_station(body: SetStation, name: str = NAME, backend: ApiBackend = BACKEND) -> object:
    """Opens or closes a station; MANUAL: it waits for confirmations."""
    fields = name, body.open, MODES.index(body.mode)
    answer = await backend.call(backend.operations.call, "set_station", srv.SetStation, *fields)
    done = f"{'Open' if body.open else 'Close'}, {body.mode.lower()}"
    backend.monitor.note(name, body.by.strip(), done)
    return {"message": answer.message}


@router.post("/stations/{name}/confirm", response_model=Done, responses=problems(*SENT))
async def confirm_pick(
    done: Confirmation, name: str = NAME, backend: ApiBackend = BACKEND
) -> object:
    """A person has picked, or put in."""
    fields = name, done.sku, done.quantity
    return {
        "message": (
            await backend.call(backend.operations.call, "confirm_pick", srv.ConfirmPick, *fields)
        ).message
    }


@router.post("/stations/{name}/short", response_model=Done, responses=problems(*SENT))
async def report_short(body: Short, name: str = NAME, backend: ApiBackend = BACKEND) -> object:
    """Pieces are missing or damaged: they are written off and brought from elsewhere, or, where
    they should be put in, stay out."""
    fields = name, body.sku, body.quantity, body.damaged
    return {
        "message": (
            await backend.call(backend.operations.call, "report_short", srv.ReportShort, *fields)
        ).message
    }


@router.post(AT_PICK, response_model=Reported, responses=problems(*SENT))
async def report_pick(
    done: PickReport, name: str = NAME, sequence: int = SEQUENCE, backend: ApiBackend = BACKEND
) -> object:
    """Takes the outcome of that pick, or refuses it. Sent again it
    changes nothing."""
    which = done.order_id, done.item, sequence
    fields = name, *which, done.quantity, OUTCOMES.index(done.outcome), done.id
    answer = await backend.call(backend.operations.call, "report_pick", srv.ReportPick, *fields)
    return {"message": answer.message, "quantity": answer.quantity}


@router.delete(AT_PICK, response_model=Done, responses=problems(409))
async def undo_report(
    name: str = NAME, sequence: int = SEQUENCE, backend: ApiBackend = BACKEND
) -> object:
    """Takes a report back: pieces that were picked or put in, while the storage unit is still at
    the station; pieces that were written off a moment ago. They lie where they lay before."""
    answer = await backend.call(
        backend.operations.call, "undo_write_off", srv.UndoWriteOff, name, sequence
    )
    return {"message": answer.message}
