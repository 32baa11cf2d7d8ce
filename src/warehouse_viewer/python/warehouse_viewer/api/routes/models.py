# SPDX-License-Identifier: Apache-2.0
"""Storage units and items: where they are."""

from typing import Any

from fastapi import APIRouter, HTTPException, Query

from warehouse_client.tracking import Tracked
from warehouse_viewer.api import catalogue
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import LIMIT, NUMBER, OFFSET, SENT, TEXT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.models import Thing, Things

router = APIRouter()
UNIT = Query("", max_length=100, description="that lie on this unit")


@router.post("/items/{number}/pick_up", response_model=Done, responses=problems(*SENT))
async def pick_up_item(number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """Puts an item that fell back on its storage unit."""
    return {"message": await backend.simulate("pick_up", number)}


@router.get("/storage_units", response_model=Things, responses=problems())
async def get_storage_units(
    name: str = TEXT,
    storage_unit: str = UNIT,
    limit: int = LIMIT,
    offset: int = OFFSET,
    backend: ApiBackend = BACKEND,
) -> object:
    """Those with a fitting name, and where each is."""
    return _page(await backend.things("storage_units"), name, storage_unit, limit, offset)


@router.get("/storage_units/{number}", response_model=Thing, responses=problems(404))
async def get_storage_unit(number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """One, and where it is."""
    return _one(await backend.things("storage_units"), f"storage_unit{number}")


@router.get("/items", response_model=Things, responses=problems())
async def get_items(
    name: str = TEXT,
    storage_unit: str = UNIT,
    limit: int = LIMIT,
    offset: int = OFFSET,
    backend: ApiBackend = BACKEND,
) -> object:
    """Those with a fitting name, and where each is."""
    return _page(await backend.things("items"), name, storage_unit, limit, offset)


@router.get("/items/{number}", response_model=Thing, responses=problems(404))
async def get_item(number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """One, and where it is."""
    return _one(await backend.things("items"), f"item{number}")


def _page(tracked: Tracked, name: str, unit: str, limit: int, offset: int) -> dict[str, Any]:
    indices = catalogue.find(tracked, name, unit)
    rows = [catalogue.thing(tracked, i) for i in indices[offset : offset + limit]]
    return {"total": len(indices), "things": rows}


def _one(tracked: Tracked, name: str) -> Thing:
    try:
        return catalogue.thing(tracked, tracked.names.index(name))
    except ValueError:
        raise HTTPException(404, f"no {name}") from None
