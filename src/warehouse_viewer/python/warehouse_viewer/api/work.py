# SPDX-License-Identifier: Apache-2.0
"""The work of the warehouse over HTTP: orders, stock, stations and figures."""

import asyncio
import time
from typing import Literal

import genpy
from fastapi import APIRouter, HTTPException, Path, Query

from warehouse_msgs import msg, srv
from warehouse_viewer.api import schemas
from warehouse_viewer.api.work_schemas import (
    MODES,
    OUTCOMES,
    STATES,
    Accepted,
    Confirmation,
    Heat,
    NewOrder,
    Notices,
    Order,
    Orders,
    PickReport,
    Reported,
    SetStation,
    Short,
    Stations,
    Stock,
    Throughput,
)
from warehouse_viewer.page.source import AwayError, RefusedError

PATIENCE = 3.0  # for a topic's latest message [s, wall]
NO_SHIFT = "is a shift running (operations.launch)?"
ANY = srv.FindOrdersRequest.ANY


class Work:
    """One client of the operations' services and topics; calls block. `ros` is rospy, `feed` a
    ShiftFeed."""

    def __init__(self, ros, feed):
        self._ros, self.feed = ros, feed

    def call(self, service, kind, *fields):
        """A service's answer; raises AwayError, or RefusedError where it says no."""
        name = f"/warehouse/{service}"
        try:
            answer = self._ros.ServiceProxy(name, kind)(*fields)
        except (self._ros.ServiceException, self._ros.ROSException, OSError) as error:
            raise AwayError(f"{name}: {error}; {NO_SHIFT}") from error
        if not getattr(answer, "success", getattr(answer, "accepted", True)):
            raise RefusedError(answer.message)
        return answer

    def latest(self, name):
        """What the ShiftFeed has of that name, as JSON has it; raises AwayError."""
        end = time.monotonic() + PATIENCE
        while (told := self.feed[name]) is None:
            if time.monotonic() > end:
                raise AwayError(f"/warehouse/{name} tells nothing; {NO_SHIFT}")
            time.sleep(0.05)
        return SHOWN[name](told)

    def find_orders(self, number=0, search="", state=ANY, late=False, limit=1, offset=0):
        """A FindOrdersResponse; raises AwayError."""
        wanted = number, search, state, late, limit, offset
        return self.call("find_orders", srv.FindOrders, *wanted)

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
        late: bool = Query(False, description="those past their due time alone"),
        limit: int = limit,
        offset: int = offset,
    ):
        """Orders, the newest first."""
        which = ANY if state is None else STATES.index(state)
        found = await do(work.find_orders, 0, search, which, late, limit, offset)
        return {"total": found.total, "orders": [order(one) for one in found.orders]}

    @out.get("/orders/{number}", response_model=Order, responses=problems(404))
    async def get_order(number: int = number):
        """One order."""
        found = await do(work.find_orders, number)
        if not found.orders:
            raise HTTPException(404, f"no order {number}")
        return order(found.orders[0])

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
        return {"stations": await do(work.latest, "stations")}

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
        """Pieces are missing or damaged: they are written off and brought from elsewhere, or, where
        they should be put in, stay out."""
        fields = name, found.sku, found.quantity, found.damaged
        return {"message": (await do(work.call, "report_short", srv.ReportShort, *fields)).message}

    at_pick = "/stations/{name}/picks/{sequence}"

    @out.post(at_pick, response_model=Reported, responses=problems(*sent))
    async def report_pick(done: PickReport, name: str = name, sequence: int = number):
        """What became of a pick that the station tells of: of that one, or of none. Sent again it
        changes nothing."""
        which = done.order_id, done.item, sequence
        fields = name, *which, done.quantity, OUTCOMES.index(done.outcome)
        answer = await do(work.call, "report_pick", srv.ReportPick, *fields)
        return {"message": answer.message, "quantity": answer.quantity}

    @out.delete(at_pick, response_model=schemas.Done, responses=problems(409))
    async def undo_write_off(name: str = name, sequence: int = number):
        """Takes back what was written off a moment ago as SHORT or DAMAGED: it lies in its bin."""
        answer = await do(work.call, "undo_write_off", srv.UndoWriteOff, name, sequence)
        return {"message": answer.message}

    @out.get("/kpis", responses=problems())
    async def get_kpis():
        """The figures of the shift so far, named as in kpis.json."""
        return await do(work.latest, "kpis")

    @out.get("/throughput", response_model=Throughput, responses=problems())
    async def get_throughput():
        """The last hour, a minute a row."""
        return await do(work.latest, "throughput")

    @out.get("/notices", response_model=Notices, responses=problems())
    async def get_notices():
        """What the shift could not take, and why; why there is none."""
        return {"notices": await do(work.latest, "notices")}

    @out.get("/heat", response_model=Heat, responses=problems())
    async def get_heat():
        """Traffic and waiting over the floor."""
        return await do(work.latest, "heat")


def plain(message):
    """A message as JSON has it; its header is left out."""
    if isinstance(message, genpy.Message):
        return {n: plain(getattr(message, n)) for n in message.__slots__ if n != "header"}
    if isinstance(message, list | tuple):
        return [plain(one) for one in message]
    return message


def order(one):
    """An OrderStatus as JSON has it."""
    lines = zip(one.lines, one.picked)
    out = plain(one)
    del out["picked"]
    return out | {
        "state": STATES[one.state],
        "lines": [plain(line) | {"picked": picked} for line, picked in lines],
    }


def stations(told):
    """StationStates likewise."""
    return [plain(one) | {"mode": MODES[one.mode]} for one in told.stations]


def notices(told):
    """Its sentences."""
    return list(told.notices)


# How what a shift tells is shown.
SHOWN = {
    "stations": stations,
    "kpis": plain,
    "throughput": plain,
    "heat": plain,
    "notices": notices,
}
