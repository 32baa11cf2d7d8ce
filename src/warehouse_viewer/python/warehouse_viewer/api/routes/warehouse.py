# SPDX-License-Identifier: Apache-2.0
"""The warehouse as a whole: its state, and building another one."""

import asyncio
from typing import Any

from fastapi import APIRouter, HTTPException

from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_layout.file.request import LIMITS, PRESETS
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.warehouse import NewWarehouse, Sizes, Warehouse
from warehouse_viewer.ros import layout_store

router = APIRouter()


@router.get("/warehouse", response_model=Warehouse, responses=problems())
async def get_warehouse(backend: ApiBackend = BACKEND) -> object:
    """What stands there, and how time passes."""
    await backend.wait_for_positions()
    objects, performance = backend.feed["objects"], backend.feed["performance"]
    name, number = await backend.simulate("warehouse")
    lacks = await backend.simulate("offers")
    return {
        "name": name,
        "id": number,
        "robots": len(objects.kiva_id),
        "storage_units": len(objects.storage_units),
        "items": len(objects.items),
        "belts": len(objects.belts),
        "time": backend.feed["fleet"].stamp.to_sec(),
        "real_time_factor": performance.real_time_factor if performance else 0.0,
        "lacks": {action: lack for action, lack in lacks.items() if lack},
        **await backend.simulate("state"),
    }


@router.get("/warehouse/sizes", response_model=Sizes, responses=problems())
async def get_sizes(backend: ApiBackend = BACKEND) -> object:
    """Presets, and the limits of counts of one's own."""
    presets = {name: vars(counts) for name, counts in PRESETS.items()}
    return {"presets": presets, "limits": LIMITS}


async def _build_layout(body: NewWarehouse, backend: ApiBackend) -> Any:
    if body.robots or body.items or body.shelves:
        raise HTTPException(
            422, "counts and a layout: the layout has its own counts; give one of them"
        )
    try:
        path = await asyncio.to_thread(layout_store.kept, body.layout, body.name)
    except LayoutFileError as error:
        raise HTTPException(422, str(error)) from error
    return await backend.change("create", path, body.id, 0, 0, 0)


@router.post("/warehouse", response_model=Done, responses=problems(*SENT))
async def create_warehouse(body: NewWarehouse, backend: ApiBackend = BACKEND) -> object:
    """Builds a warehouse in place of the one that stands."""
    if body.layout:
        return {"message": await _build_layout(body, backend)}
    counts = (body.robots, body.items, body.shelves)
    return {"message": await backend.change("create", body.name, body.id, *counts)}
