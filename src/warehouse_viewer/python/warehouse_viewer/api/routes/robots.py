# SPDX-License-Identifier: Apache-2.0
"""Robots: where they are, adding, removing and commanding them; and people."""

from typing import Literal

from fastapi import APIRouter, Body, Depends, HTTPException, Query, Request

from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import LIMIT, NUMBER, OFFSET, SENT, TEXT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.commands import Command, NewWalk, Outcome, Walker
from warehouse_viewer.api.schemas.models import NewRobot, Robot, Robots
from warehouse_viewer.api.schemas.pydantic_versions import as_dict, no_text
from warehouse_viewer.json_text import JSONResponse

router = APIRouter()
ANSWER, END = 10.0, 300.0  # for the answer to a command, and for its end [s, wall]
COMMAND = Body(discriminator="command")


async def _check_command(request: Request) -> None:
    """Raises 422 where `command` is not text, for which pydantic 1 would fail an assertion."""
    try:
        body = await request.json()
    except (ValueError, RecursionError):
        return  # FastAPI answers what is wrong with it
    if isinstance(body, dict) and not isinstance(body.get("command", ""), str):
        raise no_text("body", "command")


@router.get("/robots", response_model=Robots, responses=problems())
async def get_robots(
    status: Literal["IDLE", "BUSY", "BLOCKED"] | None = None,
    name: str = TEXT,
    limit: int = LIMIT,
    offset: int = OFFSET,
    backend: ApiBackend = BACKEND,
) -> object:
    """Robots with their poses and status."""
    rows = [r for r in await backend.robots() if name in r.name and status in (None, r.status)]
    return {"total": len(rows), "robots": rows[offset : offset + limit]}


@router.get("/robots/{number}", response_model=Robot, responses=problems(404))
async def get_robot(number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """One robot."""
    return await backend.robot(number)


@router.post("/robots", status_code=201, response_model=Robot, responses=problems(*SENT))
async def add_robot(body: NewRobot, backend: ApiBackend = BACKEND) -> object:
    """Puts a robot on a free grid point; it gets the lowest free number."""
    number = await backend.change("add_robot", body.x, body.y, body.heading)
    return await backend.robot(number)


@router.delete("/robots/{number}", response_model=Done, responses=problems(404, 409))
async def remove_robot(number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """Takes away a robot that carries nothing."""
    if (await backend.robot(number)).storage_unit:
        raise HTTPException(409, f"kiva{number} carries a storage unit; have it put down first")
    if backend.feed.vda5050.is_driven(number):
        raise HTTPException(409, f"kiva{number} is a vehicle at a broker: remove it among vehicles")
    return {"message": await backend.change("remove_robot", number)}


@router.post(
    "/robots/{number}/commands",
    dependencies=[Depends(_check_command)],
    response_model=Outcome,
    responses=problems(404, *SENT) | {202: {"model": Outcome}},
)
async def command_robot(
    command: Command = COMMAND,
    number: int = NUMBER,
    wait: Literal["answer", "end"] = Query("answer", description="for what to wait"),
    timeout: float | None = Query(
        None,
        ge=0.01,
        le=END,
        description=f"[s, wall]; {ANSWER:g} for the answer, {END:g} for the end if not given",
    ),
    backend: ApiBackend = BACKEND,
) -> object:
    """Sends a command. A refused one answers 409 with the reason.

    202: what was waited for has not come in time.
    """
    await backend.robot(number)
    fields = as_dict(command, exclude={"command"})
    topic = command.command
    if not await backend.commander.ready(topic):
        raise HTTPException(503, f"{topic} has no subscriber; does the world run?")
    to_end = wait == "end"
    timeout = timeout or (END if to_end else ANSWER)
    outcome = await backend.commander.send(topic, number, fields, to_end, timeout)
    if outcome.kind == "refused":
        raise HTTPException(409, outcome.events[-1]["text"])
    answer = {"outcome": outcome.kind, "events": outcome.events}
    late = outcome.kind in ("pending", "accepted" if to_end else "")
    return JSONResponse(answer, 202) if late else answer


@router.post("/people", status_code=201, response_model=Walker, responses=problems(*SENT))
async def send_person(body: NewWalk, backend: ApiBackend = BACKEND) -> object:
    """Has a person walk over the floor, around obstacles and never into them."""
    return {"name": await backend.simulate("walk", *as_dict(body).values())}
