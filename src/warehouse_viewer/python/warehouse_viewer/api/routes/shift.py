# SPDX-License-Identifier: Apache-2.0
"""Starting a shift in a warehouse that runs without one."""

from fastapi import APIRouter, Body

from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.shift import NewShift

router = APIRouter()
NEW = Body(NewShift())  # if there is no body


@router.post("/shift", response_model=Done, responses=problems(*SENT))
async def start_shift(body: NewShift = NEW, backend: ApiBackend = BACKEND) -> object:
    """Starts a coordinator, if none runs, and a shift, which last as long as the warehouse. Answers
    once orders come in."""
    message = await backend.simulate("start_shift")
    await backend.boost.begin(backend.simulate, body.factor)
    return {"message": message}
