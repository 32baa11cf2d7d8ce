# SPDX-License-Identifier: Apache-2.0
"""Simulated time: pause, speed, steps and checkpoints."""

from fastapi import APIRouter, Body

from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.pydantic_versions import as_dict
from warehouse_viewer.api.schemas.warehouse import Checkpoint, Reset, Speed, Step, Undo

router = APIRouter()
RESET, STEP = Body(Reset()), Body(Step())  # if there is no body


@router.post("/simulation/pause", response_model=Done, responses=problems(*SENT))
async def pause(backend: ApiBackend = BACKEND) -> object:
    """Time stands still."""
    return {"message": await backend.simulate("pause")}


@router.post("/simulation/resume", response_model=Done, responses=problems(*SENT))
async def resume(backend: ApiBackend = BACKEND) -> object:
    """Time goes on."""
    return {"message": await backend.simulate("resume")}


@router.post("/simulation/reset", response_model=Done, responses=problems(*SENT))
async def reset(body: Reset = RESET, backend: ApiBackend = BACKEND) -> object:
    """Everything goes back to where it came."""
    return {"message": await backend.simulate("reset", *as_dict(body).values())}


@router.post("/simulation/step", response_model=Done, responses=problems(*SENT))
async def step(body: Step = STEP, backend: ApiBackend = BACKEND) -> object:
    """Advances a paused world by a number of physics steps."""
    return {"message": await backend.simulate("step", *as_dict(body).values())}


@router.post("/simulation/speed", response_model=Done, responses=problems(*SENT))
async def speed(body: Speed, backend: ApiBackend = BACKEND) -> object:
    """How fast simulated time passes."""
    return {"message": await backend.simulate("speed", *as_dict(body).values())}


@router.post("/simulation/checkpoint", response_model=Done, responses=problems(*SENT))
async def checkpoint(body: Checkpoint, backend: ApiBackend = BACKEND) -> object:
    """Keeps the world as it is."""
    return {"message": await backend.simulate("checkpoint", *as_dict(body).values())}


@router.post("/simulation/restore", response_model=Done, responses=problems(*SENT))
async def restore(body: Checkpoint, backend: ApiBackend = BACKEND) -> object:
    """Goes back to a checkpoint."""
    return {"message": await backend.simulate("restore", *as_dict(body).values())}


@router.post("/simulation/undo", response_model=Done, responses=problems(*SENT))
async def undo(body: Undo, backend: ApiBackend = BACKEND) -> object:
    """Goes back by a number of simulated seconds."""
    return {"message": await backend.simulate("undo", *as_dict(body).values())}
