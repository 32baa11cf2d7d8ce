# SPDX-License-Identifier: Apache-2.0
"""The work of the warehouse over HTTP: orders, stock, stations and figures."""

import asyncio
from typing import Literal

import genpy
from fastapi import APIRouter, HTTPException, Path, Query
from pydantic import BaseModel, Field, StrictBool, conint, conlist, constr

from warehouse_msgs import msg, srv
from warehouse_sim.viewer import schemas
from warehouse_sim.viewer.simulation import AwayError, RefusedError

PATIENCE = 3.0  # for a topic's latest message [s, wall]
STATES = ("OPEN", "ASSIGNED", "COMPLETED", "CANCELLED")
MODES = ("AUTOMATIC", "MANUAL")

Sku = constr(min_length=1, max_length=80, regex=r"^[ -~]+$", strict=True)
Pieces = conint(ge=1, le=schemas.INT32, strict=True)


class Moment(schemas.Number):
    ge, le = 0, 4e9


class Line(schemas._Body):
    sku: Sku
    quantity: Pieces


class NewOrder(schemas._Body):
    """An order; `due` in simulated time, 0 = none."""

    reference: constr(max_length=200, regex=r"^[ -~]*$", strict=True) = ""
    lines: conlist(Line, min_items=1, max_items=100)
    due: Moment = Field(0.0, description="[s], simulated time")
    priority: conint(ge=0, le=255, strict=True) = 0


class Accepted(BaseModel):
    order_id: int
    message: str


class OrderLine(BaseModel):
    sku: str
    quantity: int
    picked: int


class Order(BaseModel):
    """Times are simulated seconds of the run in which it came; 0 = none, not yet."""

    order_id: int
    reference: str
    state: Literal[STATES]
    station: str
    priority: int
    created: float
    due: float
    completed: float
    lines: list[OrderLine]


class Orders(BaseModel):
    total: int
    orders: list[Order]


class Place(BaseModel):
    item: str
    shelf_id: int
    sku: str
    quantity: int
    reserved: int
    capacity: int


class Stock(BaseModel):
    total: int
    pieces: int
    places: list[Place]


class Pick(BaseModel):
    sku: str
    quantity: int
    item: str
    order_id: int
    reference: str


class Station(BaseModel):
    name: str
    kind: str
    open: bool
    mode: Literal[MODES]
    shelf_id: int
    inbound: list[int]
    orders: list[int]
    slots: int
    picks: list[Pick]
    pieces: int
    busy_fraction: float


class Stations(BaseModel):
    stations: list[Station]


class SetStation(schemas._Body):
    open: StrictBool
    mode: Literal[MODES] = "AUTOMATIC"


class Confirmation(Line):
    """So many pieces were taken out, or a bundle of so many was put in."""


class Short(Line):
    """So many pieces are not there, or are damaged."""

    damaged: StrictBool = False


class Work:
    """One client of the operations' services and topics; calls block. `ros` is rospy."""

    def __init__(self, ros):
        self._ros = ros

    def call(self, service, kind, *fields):
        """A service's answer; raises AwayError, or RefusedError where it says no."""
        name = f"/warehouse/{service}"
        try:
            answer = self._ros.ServiceProxy(name, kind)(*fields)
        except (self._ros.ServiceException, self._ros.ROSException, OSError) as error:
            raise AwayError(f"{name}: {error}; is a shift running (operations.launch)?") from error
        if not getattr(answer, "success", getattr(answer, "accepted", True)):
            raise RefusedError(answer.message)
        return answer

    def latest(self, topic, kind):
        """A latched topic's message; raises AwayError."""
        name = f"/warehouse/{topic}"
        try:
            return self._ros.wait_for_message(name, kind, PATIENCE)
        except self._ros.ROSException as error:
            text = f"{name} tells nothing; is a shift running (operations.launch)?"
            raise AwayError(text) from error

    def time(self, seconds):
        return self._ros.Time.from_sec(seconds)


def add(out: APIRouter, work, problems):
    """Adds the routes; problems(*codes) describes the answers that are none."""

    async def do(action, *fields):
        try:
            return await asyncio.to_thread(action, *fields)
        except RefusedError as error:
            raise HTTPException(409, str(error)) from error
        except AwayError as error:
            raise HTTPException(503, str(error)) from error

    sent = (400, 409, 413)
    limit = Query(100, ge=1, le=schemas.MOST_ROWS, description="rows in the answer")
    offset = Query(0, ge=0, le=schemas.INT32, description="rows to leave out before them")
    number = Path(ge=1, le=2**53)
    name = Path(max_length=80, regex=r"^[ -~]+$")

    @out.get("/orders", response_model=Orders, responses=problems())
    async def get_orders(
        search: str = Query(
            "", max_length=200, regex=r"^[ -~]*$", description="a part of the reference, or a SKU"
        ),
        state: Literal[STATES] | None = None,
        limit: int = limit,
        offset: int = offset,
    ):
        """Orders, the newest first."""
        which = srv.FindOrdersRequest.ANY if state is None else STATES.index(state)
        found = await do(work.call, "find_orders", srv.FindOrders, 0, search, which, limit, offset)
        return {"total": found.total, "orders": [_order(one) for one in found.orders]}

    @out.get("/orders/{number}", response_model=Order, responses=problems(404))
    async def get_order(number: int = number):
        """One order."""
        any_state = srv.FindOrdersRequest.ANY
        found = await do(work.call, "find_orders", srv.FindOrders, number, "", any_state, 1, 0)
        if not found.orders:
            raise HTTPException(404, f"no order {number}")
        return _order(found.orders[0])

    @out.post("/orders", status_code=201, response_model=Accepted, responses=problems(*sent))
    async def submit_order(wanted: NewOrder):
        """A new order; kept when this answers."""
        lines = [msg.OrderLine(line.sku, line.quantity) for line in wanted.lines]
        fields = wanted.reference, lines, work.time(wanted.due), wanted.priority
        answer = await do(work.call, "submit_order", srv.SubmitOrder, *fields)
        return {"order_id": answer.order_id, "message": answer.message}

    @out.delete("/orders/{number}", response_model=schemas.Done, responses=problems(409))
    async def cancel_order(number: int = number):
        """Cancels an order that is not complete."""
        answer = await do(work.call, "cancel_order", srv.CancelOrder, number)
        return {"message": answer.message}

    @out.get("/stock", response_model=Stock, responses=problems())
    async def get_stock(
        sku: str = Query("", max_length=80, regex=r"^[ -~]*$", description="empty: all bins"),
        limit: int = limit,
        offset: int = offset,
    ):
        """Where pieces of a SKU lie, the most first."""
        return plain(await do(work.call, "find_stock", srv.FindStock, sku, limit, offset))

    @out.get("/stations", response_model=Stations, responses=problems())
    async def get_stations():
        """The stations: what unit is there, what is to be done with it, what is on its way."""
        told = await do(work.latest, "stations", msg.StationStates)
        return {"stations": [plain(one) | {"mode": MODES[one.mode]} for one in told.stations]}

    @out.put("/stations/{name}", response_model=schemas.Done, responses=problems(*sent))
    async def set_station(wanted: SetStation, name: str = name):
        """Opens or closes a station; MANUAL: it waits for confirmations."""
        fields = name, wanted.open, MODES.index(wanted.mode)
        return {"message": (await do(work.call, "set_station", srv.SetStation, *fields)).message}

    @out.post("/stations/{name}/confirm", response_model=schemas.Done, responses=problems(*sent))
    async def confirm_pick(done: Confirmation, name: str = name):
        """A person has picked, or put in."""
        fields = name, done.sku, done.quantity
        return {"message": (await do(work.call, "confirm_pick", srv.ConfirmPick, *fields)).message}

    @out.post("/stations/{name}/short", response_model=schemas.Done, responses=problems(*sent))
    async def report_short(found: Short, name: str = name):
        """Pieces are missing or damaged: they are written off and brought from elsewhere."""
        fields = name, found.sku, found.quantity, found.damaged
        return {"message": (await do(work.call, "report_short", srv.ReportShort, *fields)).message}

    @out.get("/kpis", responses=problems())
    async def get_kpis():
        """The figures of the shift so far, named as in kpis.json."""
        return plain(await do(work.latest, "kpis", msg.Kpis))


def plain(message):
    """A message as JSON has it; its header is left out."""
    if isinstance(message, genpy.Message):
        return {n: plain(getattr(message, n)) for n in message.__slots__ if n != "header"}
    if isinstance(message, list | tuple):
        return [plain(one) for one in message]
    return message


def _order(one):
    lines = zip(one.lines, one.picked)
    return plain(one) | {
        "state": STATES[one.state],
        "lines": [plain(line) | {"picked": picked} for line, picked in lines],
    }
