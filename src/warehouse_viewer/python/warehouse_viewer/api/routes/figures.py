# SPDX-License-Identifier: Apache-2.0
"""Figures, notices and the heat map of a shift."""

from typing import Any

from fastapi import APIRouter

from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.operations_json import SHOWN
from warehouse_viewer.api.routes.common import problems
from warehouse_viewer.api.schemas.operations import Heat, Notices, Throughput

router = APIRouter()


@router.get("/kpis", response_model=None, responses=problems())
async def get_kpis(backend: ApiBackend = BACKEND) -> object:
    """The figures of the running shift, named as in kpis.json."""
    return await _latest(backend, "kpis")


@router.get("/throughput", response_model=Throughput, responses=problems())
async def get_throughput(backend: ApiBackend = BACKEND) -> object:
    """The last hour, a minute a row."""
    return await _latest(backend, "throughput")


@router.get("/notices", response_model=Notices, responses=problems())
async def get_notices(backend: ApiBackend = BACKEND) -> object:
    """What the shift could not take, and why; why there is none."""
    return {"notices": await _latest(backend, "notices")}


@router.get("/heat", response_model=Heat, responses=problems())
async def get_heat(backend: ApiBackend = BACKEND) -> object:
    """Traffic and waiting over the floor."""
    return await _latest(backend, "heat")


async def _latest(backend: ApiBackend, name: str) -> Any:
    return SHOWN[name](await backend.call(backend.operations.latest, name))
