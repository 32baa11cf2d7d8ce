# SPDX-License-Identifier: Apache-2.0
"""The HTTP API: what ROS offers, for those who speak no ROS. Described at /api/v1/openapi.json."""

import asyncio
from contextlib import suppress
from typing import Literal

from fastapi import APIRouter, Body, Depends, HTTPException, Path, Query, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic.error_wrappers import ErrorWrapper
from pydantic.errors import StrError
from starlette.routing import Match

from warehouse_layout.request import LIMITS, PRESETS
from warehouse_viewer.api import catalogue, schemas, work
from warehouse_viewer.page.journal import KEPT
from warehouse_viewer.page.source import AwayError, RefusedError
from warehouse_viewer.ros.coordination import NONE_RUNS

GLANCE = ("coordinator", "fleet", "performance")  # of the feed's topics
PATIENCE = 3.0  # for messages that are on their way [s, wall]
ANSWER, END = 10.0, 300.0  # for the answer to a command, and for its end [s, wall]


def _problems(*codes):
    """Answers beside the good one: what may always come, and these."""
    return {code: {"model": schemas.Problem} for code in (*codes, 401, 403, 429, 503)}


SENT = (400, 409, 413)  # wherever something is sent


CSV = {200: {"content": {"text/csv": {"schema": {"type": "string"}}}}}

Limit = Query(100, ge=1, le=schemas.MOST_ROWS, description="rows in the answer")
Offset = Query(0, ge=0, le=schemas.INT32, description="rows to leave out before them")
Command = Body(discriminator="command")
Number = Path(ge=1, le=schemas.INT32, description="the number in the model's name")
TransportNumber = Path(ge=1, le=2**32 - 1, description="of the transport")
Text = Query("", max_length=100, description="a part of the name")


class ApiBackend:
    """What the API's answers are made from."""

    def __init__(
        self,
        feed,
        model,
        journal,
        simulation,
        commander,
        coordination,
        transports,
        operations,
        changes,
    ):
        self.feed, self.model, self.journal = feed, model, journal
        self.simulation, self.commander, self.work = simulation, commander, operations
        self.coordination, self.transports, self.changes = coordination, transports, changes

    async def look(self):
        """Waits until the world has told enough. Raises HTTPException."""
        self.feed.subscribe()
        if not await _until(lambda: self.feed.has_positions):
            raise HTTPException(503, "the world tells nothing; does it run?")

    async def glance(self):
        """Waits until coordinator and world have told what they tell, for a moment at most."""
        self.feed.subscribe(GLANCE)
        with suppress(AwayError):
            runs = await asyncio.to_thread(self.coordination.runs)
            names = GLANCE if runs else set(GLANCE) - {"coordinator"}
            await _until(lambda: all(self.feed[name] for name in names))

    async def change(self, action, *args):
        """Calls a method of Simulation by which models come or go.

        Returns once every read shows what stands then. Raises HTTPException.
        """
        await self.look()  # who hears already takes nothing old for new
        objects, fleet = self.feed["objects"], self.feed["fleet"]
        answer = await self.do(action, *args)
        standing = await self.do("standing")
        if standing.is_paused:
            # Robots come and go unseen where nothing moves; newcomers alone are told of all.
            self.feed.resubscribe("fleet")
        await _until(lambda: self.feed.reflects(standing, objects, fleet))
        return answer

    async def robots(self):
        await self.look()
        return catalogue.robots(self.feed["fleet"])

    async def robot(self, number):
        """Raises HTTPException."""
        found = [r for r in await self.robots() if r.id == number]
        if not found:
            raise HTTPException(404, f"no robot kiva{number}")
        return found[0]

    async def things(self, kind):
        await self.look()
        return catalogue.things(kind, *(self.feed.objects_and_states or self._no_things()))

    def _no_things(self):
        raise HTTPException(503, "the world is being rebuilt; ask again")

    async def do(self, action, *args):
        """Calls a method of Simulation. Raises HTTPException."""
        return await self._ask(getattr(self.simulation, action), *args)

    async def coordinate(self, action, *args):
        """Calls a method of Coordination. Raises HTTPException."""
        return await self._ask(getattr(self.coordination, action), *args)

    async def coordinator(self):
        """The newest CoordinatorState. Raises HTTPException."""
        await self.look()
        runs = await self.coordinate("runs")
        if not runs or not await _until(lambda: self.feed.coordinator):
            raise HTTPException(404, NONE_RUNS)
        return self.feed.coordinator

    async def _ask(self, function, *args):
        try:
            return await asyncio.to_thread(function, *args)
        except RefusedError as error:
            raise HTTPException(409, str(error)) from error
        except AwayError as error:
            raise HTTPException(503, str(error)) from error


async def _until(condition):
    """Whether it comes true soon."""
    for _ in range(int(PATIENCE / 0.05)):
        if condition():
            return True
        await asyncio.sleep(0.05)
    return False


async def not_allowed(request, error):
    """405 with all methods of the path: its routes are one for each."""
    routes = [
        route for route in request.app.routes if route.matches(request.scope)[0] != Match.NONE
    ]
    methods = sorted(set().union(*(getattr(route, "methods", None) or () for route in routes)))
    headers = {"allow": ", ".join(methods)}
    return JSONResponse({"detail": error.detail}, error.status_code, headers=headers)


async def _names_a_command(request: Request):
    """Or 422: looking for the kind of one, pydantic 1 fails an assertion where it is no text."""
    try:
        body = await request.json()
    except (ValueError, RecursionError):
        return  # FastAPI tells what is wrong with it
    if isinstance(body, dict) and not isinstance(body.get("command", ""), str):
        raise RequestValidationError([ErrorWrapper(StrError(), ("body", "command"))])


def router(backend):
    """All routes below /api/v1."""
    out = APIRouter(prefix="/api/v1")
    _add_warehouse(out, backend)
    _add_robots(out, backend)
    _add_people(out, backend)
    _add_fallen_items(out, backend)
    _add_things(out, backend, "storage_units", "storage_unit")
    _add_things(out, backend, "items", "item")
    _add_simulation(out, backend)
    _add_coordinator(out, backend)
    work.add(out, backend.work, _problems)
    return out


def _add_warehouse(out, backend):
    @out.get("/warehouse", response_model=schemas.Warehouse, responses=_problems())
    async def get_warehouse():
        """What stands there, and how time passes."""
        await backend.look()
        objects, performance = backend.feed["objects"], backend.feed["performance"]
        name, number = await backend.do("warehouse")
        lacks = await backend.do("offers")
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
            **await backend.do("state"),
        }

    @out.get("/warehouse/sizes", response_model=schemas.Sizes, responses=_problems())
    async def get_sizes():
        """Presets, and the limits of counts of one's own."""
        presets = {name: vars(counts) for name, counts in PRESETS.items()}
        return {"presets": presets, "limits": LIMITS}

    @out.post("/warehouse", response_model=schemas.Done, responses=_problems(*SENT))
    async def create_warehouse(wanted: schemas.NewWarehouse):
        """Builds a warehouse in place of the one that stands."""
        counts = (wanted.robots, wanted.items, wanted.shelves)
        return {"message": await backend.change("create", wanted.name, wanted.id, *counts)}

    @out.get("/events", response_model=schemas.Events, responses=_problems())
    async def get_events(
        since: int = Query(0, ge=0, le=2**53, description="the last id you know"),
        model: str = Query("", max_length=100, description="of this model alone"),
        limit: int = Query(100, ge=1, le=KEPT, description="rows in the answer"),
    ):
        """The newest events, oldest first."""
        return {"events": backend.journal.since(since, model or None, limit)}

    @out.get("/events.csv", response_class=Response, responses=_problems() | CSV)
    async def export_events():
        """All events that are kept, oldest first, for a spreadsheet."""
        headers = {"content-disposition": 'attachment; filename="events.csv"'}
        return Response(backend.journal.csv(), media_type="text/csv", headers=headers)


def _add_robots(out, backend):
    @out.get("/robots", response_model=schemas.Robots, responses=_problems())
    async def get_robots(
        status: Literal["IDLE", "BUSY", "BLOCKED"] | None = None,
        name: str = Text,
        limit: int = Limit,
        offset: int = Offset,
    ):
        """Robots with their poses and status."""
        found = [r for r in await backend.robots() if name in r.name and status in (None, r.status)]
        return {"total": len(found), "robots": found[offset : offset + limit]}

    @out.get("/robots/{number}", response_model=schemas.Robot, responses=_problems(404))
    async def get_robot(number: int = Number):
        """One robot."""
        return await backend.robot(number)

    @out.post("/robots", status_code=201, response_model=schemas.Robot, responses=_problems(*SENT))
    async def add_robot(wanted: schemas.NewRobot):
        """Puts a robot on a free grid point; it gets the lowest free number."""
        number = await backend.change("add_robot", wanted.x, wanted.y, wanted.heading)
        return await backend.robot(number)

    @out.delete("/robots/{number}", response_model=schemas.Done, responses=_problems(404, 409))
    async def remove_robot(number: int = Number):
        """Takes away a robot that carries nothing."""
        if (await backend.robot(number)).storage_unit:
            raise HTTPException(409, f"kiva{number} carries a storage unit; let it drop that first")
        return {"message": await backend.change("remove_robot", number)}

    @out.post(
        "/robots/{number}/commands",
        dependencies=[Depends(_names_a_command)],
        response_model=schemas.Outcome,
        responses=_problems(404, *SENT) | {202: {"model": schemas.Outcome}},
    )
    async def command_robot(
        command: schemas.Command = Command,
        number: int = Number,
        wait: Literal["answer", "end"] = Query("answer", description="for what to wait"),
        timeout: float | None = Query(
            None,
            ge=0.01,
            le=END,
            description=f"[s, wall]; {ANSWER:g} for the answer, {END:g} for the end if not given",
        ),
    ):
        """Sends a command. A refused one answers 409 with the reason.

        202 tells that what was waited for has not come in time.
        """
        await backend.robot(number)
        fields = command.dict(exclude={"command"})
        topic = f"/{command.command}"
        if not await backend.commander.ready(topic):
            raise HTTPException(503, f"nobody hears {topic}; does the world run?")
        to_end = wait == "end"
        timeout = timeout or (END if to_end else ANSWER)
        outcome = await backend.commander.send(topic, number, fields, to_end, timeout)
        if outcome.kind == "refused":
            raise HTTPException(409, outcome.events[-1]["text"])
        answer = {"outcome": outcome.kind, "events": outcome.events}
        late = outcome.kind in ("pending", "accepted" if to_end else "")
        return JSONResponse(answer, 202) if late else answer


def _add_people(out, backend):
    @out.post("/people", status_code=201, response_model=schemas.Walker, responses=_problems(*SENT))
    async def send_person(wanted: schemas.NewWalk):
        """Has somebody walk over the floor: around what is in the way, and never into it."""
        return {"name": await backend.do("walk", *wanted.dict().values())}


def _add_fallen_items(out, backend):
    @out.post("/items/{number}/pick_up", response_model=schemas.Done, responses=_problems(*SENT))
    async def pick_up_item(number: int = Number):
        """Has somebody put an item that fell back on its storage unit."""
        return {"message": await backend.do("pick_up", number)}


def _add_things(out, backend, kind, noun):
    @out.get(f"/{kind}", name=f"get_{kind}", response_model=schemas.Things, responses=_problems())
    async def get_all(
        name: str = Text,
        storage_unit: str = Query("", max_length=100, description="that lie on this unit"),
        limit: int = Limit,
        offset: int = Offset,
    ):
        """Those with a fitting name, and where each is."""
        tracked = await backend.things(kind)
        found = catalogue.find(tracked, name, storage_unit)
        rows = [catalogue.thing(tracked, i) for i in found[offset : offset + limit]]
        return {"total": len(found), "things": rows}

    @out.get(
        f"/{kind}/{{number}}",
        name=f"get_{noun}",
        response_model=schemas.Thing,
        responses=_problems(404),
    )
    async def get_one(number: int = Number):
        """One, and where it is."""
        tracked = await backend.things(kind)
        try:
            return catalogue.thing(tracked, tracked.names.index(f"{noun}{number}"))
        except ValueError:
            raise HTTPException(404, f"no {noun}{number}") from None


def _add_simulation(out, backend):
    def offer(action, about, body=None, default=...):
        answers = {"response_model": schemas.Done, "responses": _problems(*SENT)}
        if body is None:

            async def act():
                return {"message": await backend.do(action)}
        else:
            given = Body(default)

            async def act(wanted: body = given):
                return {"message": await backend.do(action, *wanted.dict().values())}

        out.post(f"/simulation/{action}", name=action, description=about, **answers)(act)

    offer("pause", "Time stands still.")
    offer("resume", "Time goes on.")
    offer("reset", "Everything goes back to where it came.", schemas.Reset, schemas.Reset())
    offer("step", "While paused: so many steps of the physics.", schemas.Step, schemas.Step())
    offer("speed", "How fast simulated time passes.", schemas.Speed)
    offer("checkpoint", "Keeps the world as it is.", schemas.Checkpoint)
    offer("restore", "Goes back to a checkpoint.", schemas.Checkpoint)
    offer("undo", "Goes back so many simulated seconds.", schemas.Undo)


def _add_coordinator(out, backend):
    @out.get("/coordinator", response_model=schemas.Coordinator, responses=_problems(404))
    async def get_coordinator():
        """The fleet at a glance."""
        return catalogue.coordinator(await backend.coordinator())

    @out.post("/robots/{number}/mode", response_model=schemas.Done, responses=_problems(404, *SENT))
    async def set_mode(wanted: schemas.NewMode, number: int = Number):
        """Gives a robot to the coordinator, to a person, or to nobody."""
        await backend.robot(number)
        return {"message": await backend.coordinate("set_mode", number, wanted.mode)}

    @out.get("/transports", response_model=schemas.Transports, responses=_problems())
    async def get_transports(
        state: schemas.TransportState | None = None,
        limit: int = Limit,
        offset: int = Offset,
    ):
        """How far each is, the newest first; those since the viewer began."""
        found = backend.transports.newest_first(state)
        return {"total": len(found), "transports": found[offset : offset + limit]}

    @out.get("/transports/{number}", response_model=schemas.Transport, responses=_problems(404))
    async def get_transport(number: int = TransportNumber):
        """How far it is."""
        found = backend.transports.get(number)
        if found is None:
            raise HTTPException(404, f"no transport {number}")
        return found

    @out.post(
        "/transports",
        status_code=201,
        response_model=schemas.TransportNumber,
        responses=_problems(*SENT),
    )
    async def submit_transport(wanted: schemas.NewTransport):
        """Has a storage unit brought somewhere. It waits there to be released."""
        return {"transport_id": await backend.coordinate("submit", *wanted.dict().values())}

    @out.post(
        "/transports/{number}/release",
        response_model=schemas.Done,
        responses=_problems(409),
    )
    async def release_transport(number: int = TransportNumber):
        """The station is done with the unit: it may leave."""
        return {"message": await backend.coordinate("release", number)}
