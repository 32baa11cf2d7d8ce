# SPDX-License-Identifier: Apache-2.0
"""The newest events, as JSON and for a spreadsheet."""

from typing import Any

from fastapi import APIRouter, Query, Response

from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.command_log import KEPT as MOST_COMMANDS
from warehouse_viewer.api.routes.common import problems
from warehouse_viewer.api.schemas.commands import Commands, Events
from warehouse_viewer.page.journal import KEPT

router = APIRouter()
CSV: dict[int | str, dict[str, Any]] = {
    200: {"content": {"text/csv": {"schema": {"type": "string"}}}}
}


@router.get("/events", response_model=Events, responses=problems())
async def get_events(
    since: int = Query(0, ge=0, le=2**53, description="the last id you know"),
    model: str = Query("", max_length=100, description="of this model alone"),
    limit: int = Query(100, ge=1, le=KEPT, description="rows in the answer"),
    backend: ApiBackend = BACKEND,
) -> object:
    """The newest events, oldest first."""
    return {"events": backend.journal.since(since, model or None, limit)}


@router.get("/commands", response_model=Commands, responses=problems())
async def get_commands(
    by: str = Query("", max_length=60, description="of this person alone"),
    limit: int = Query(100, ge=1, le=MOST_COMMANDS, description="rows in the answer"),
    backend: ApiBackend = BACKEND,
) -> object:
    """Who commanded what over HTTP, the page's clicks included: the newest, oldest first."""
    return {"commands": backend.commands.rows(by, limit)}


@router.get("/commands.csv", response_class=Response, responses=problems() | CSV)
async def export_commands(backend: ApiBackend = BACKEND) -> Any:
    """All commands that are kept, oldest first, for a spreadsheet."""
    headers = {"content-disposition": 'attachment; filename="commands.csv"'}
    return Response(backend.commands.csv(), media_type="text/csv", headers=headers)


@router.get("/events.csv", response_class=Response, responses=problems() | CSV)
async def export_events(backend: ApiBackend = BACKEND) -> Any:
    """All events that are kept, oldest first, for a spreadsheet."""
    headers = {"content-disposition": 'attachment; filename="events.csv"'}
    return Response(backend.journal.csv(), media_type="text/csv", headers=headers)
