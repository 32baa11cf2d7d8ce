# SPDX-License-Identifier: Apache-2.0
"""Orders and stock of a shift."""

import asyncio
from typing import Any

from fastapi import APIRouter, Depends, HTTPException, Path, Query
from fastapi.responses import Response

from warehouse_msgs import msg, srv
from warehouse_viewer.api import order_sheet
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.operations_json import order, past_event, plain
from warehouse_viewer.api.routes.common import LIMIT, OFFSET, SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.operations import (
    STATES,
    Accepted,
    NewOrder,
    Order,
    OrderChange,
    OrderHistory,
    Orders,
    OrderTable,
    Skus,
    State,
    Stock,
    TableAnswer,
)
from warehouse_viewer.ros.operations_client import ANY

router = APIRouter()
ORDER = Path(ge=1, le=2**53)
SEARCH = Query(
    "",
    max_length=200,
    regex=r"^[ -~]*$",
    description="a part of the reference, a SKU, or the number of an order",
)
LATE = Query(False, description="those past their due time alone")
AT_ONCE, MOST_EXPORTED = 5_000, 100_000  # orders
CSV: dict[int | str, dict[str, Any]] = {
    200: {"content": {"text/csv": {"schema": {"type": "string"}}}}
}
SPREADSHEET = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
XLSX: dict[int | str, dict[str, Any]] = {
    200: {"content": {SPREADSHEET: {"schema": {"type": "string", "format": "binary"}}}}
}


@router.get("/orders", response_model=Orders, responses=problems())
async def get_orders(
    search: str = SEARCH,
    state: State | None = None,
    late: bool = LATE,
    limit: int = LIMIT,
    offset: int = OFFSET,
    backend: ApiBackend = BACKEND,
) -> object:
    """Orders, the newest first."""
    which = ANY if state is None else STATES.index(state)
    answer = await backend.call(
        backend.operations.find_orders, 0, search, which, late, limit, offset
    )
    return {"total": answer.total, "orders": [order(row) for row in answer.orders]}


async def exported(
    search: str = SEARCH,
    state: State | None = None,
    late: bool = LATE,
    backend: ApiBackend = BACKEND,
) -> list[Any]:
    """Returns all orders of a search as JSON; 409 if they are more than a sheet should
    have."""
    which = ANY if state is None else STATES.index(state)
    orders: list[Any] = []
    while True:
        fields = 0, search, which, late, AT_ONCE, len(orders)
        some = await backend.call(backend.operations.find_orders, *fields)
        if some.total > MOST_EXPORTED:
            text = f"{some.total} orders; {MOST_EXPORTED} or fewer were expected: search for some"
            raise HTTPException(409, text)
        orders += map(order, some.orders)
        if len(orders) >= some.total or not some.orders:
            return orders


EXPORTED = Depends(exported)


@router.get("/orders.csv", response_class=Response, responses=problems(409) | CSV)
async def export_csv(orders: list[Any] = EXPORTED) -> Any:
    """Orders as CSV, a row for each of their lines."""
    return _file("orders.csv", order_sheet.as_csv(orders), "text/csv")


@router.get("/orders.xlsx", response_class=Response, responses=problems(409) | XLSX)
async def export_xlsx(orders: list[Any] = EXPORTED) -> Any:
    """Orders as a spreadsheet, a row for each of their lines."""
    sheet = await asyncio.to_thread(order_sheet.as_xlsx, orders)
    return _file("orders.xlsx", sheet, SPREADSHEET)


def _file(name: str, content: str | bytes, kind: str) -> Response:
    headers = {"content-disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type=kind, headers=headers)


@router.post("/orders/table", response_model=TableAnswer, responses=problems(*SENT))
async def submit_orders(body: OrderTable, backend: ApiBackend = BACKEND) -> object:
    """New orders as a table in CSV: all of them, or none. `faults` says what is wrong where."""
    fields = body.table, body.check_only
    answer = await backend.call(
        backend.operations.request, "submit_orders", srv.SubmitOrders, *fields
    )
    faults = zip(answer.fault_line, answer.fault_column, answer.fault_text)
    return {
        "accepted": answer.accepted,
        "orders": len(answer.references),
        "lines": answer.lines,
        "pieces": answer.pieces,
        "order_ids": list(answer.order_ids),
        "faults": [{"line": line, "column": c, "text": text} for line, c, text in faults],
    }


@router.get("/skus", response_model=Skus, responses=problems())
async def get_skus(
    search: str = Query("", max_length=80, description="a part of the name"),
    limit: int = LIMIT,
    backend: ApiBackend = BACKEND,
) -> object:
    """SKUs by name, with their pieces in stock: those that begin with the text first."""
    fields = "find_skus", srv.FindSkus, search, limit
    answer = await backend.call(backend.operations.request, *fields)
    pairs = zip(answer.sku, answer.available)
    return {"total": answer.total, "skus": [{"sku": s, "available": n} for s, n in pairs]}


@router.get("/orders/{number}", response_model=Order, responses=problems(404))
async def get_order(number: int = ORDER, backend: ApiBackend = BACKEND) -> object:
    """One order."""
    answer = await backend.call(backend.operations.find_orders, number)
    if not answer.orders:
        raise HTTPException(404, f"no order {number}")
    return order(answer.orders[0])


@router.post("/orders", status_code=201, response_model=Accepted, responses=problems(*SENT))
async def submit_order(body: NewOrder, backend: ApiBackend = BACKEND) -> object:
    """A new order; kept when this answers."""
    lines = [msg.OrderLine(line.sku, line.quantity) for line in body.lines]
    fields = body.reference, lines, backend.operations.time(body.due), body.priority
    answer = await backend.call(backend.operations.call, "submit_order", srv.SubmitOrder, *fields)
    return {"order_id": answer.order_id, "message": answer.message}


@router.patch("/orders/{number}", response_model=Done, responses=problems(*SENT))
async def change_order(
    body: OrderChange, number: int = ORDER, backend: ApiBackend = BACKEND
) -> object:
    """Makes an order that is not complete more or less urgent, or due at another time."""
    due = backend.operations.time(body.due or 0.0)
    fields = number, body.priority is not None, body.priority or 0, body.due is not None, due
    answer = await backend.call(backend.operations.call, "change_order", srv.ChangeOrder, *fields)
    return {"message": answer.message}


@router.get("/orders/{number}/history", response_model=OrderHistory, responses=problems(404))
async def get_order_history(number: int = ORDER, backend: ApiBackend = BACKEND) -> object:
    """What has become of an order, the units on their way for it, and its likely end."""
    fields = "order_history", srv.OrderHistory, number
    answer = await backend.call(backend.operations.request, *fields)
    if not answer.success:
        raise HTTPException(404, answer.message)
    return {
        "events": [past_event(event) for event in answer.events],
        "storage_units": [f"storage_unit{unit}" for unit in answer.units],
        "estimated": answer.estimated,
    }


@router.delete("/orders/{number}", response_model=Done, responses=problems(409))
async def cancel_order(number: int = ORDER, backend: ApiBackend = BACKEND) -> object:
    """Cancels an order that is not complete."""
    answer = await backend.call(backend.operations.call, "cancel_order", srv.CancelOrder, number)
    return {"message": answer.message}


@router.get("/stock", response_model=Stock, responses=problems())
async def get_stock(
    sku: str = Query("", max_length=80, regex=r"^[ -~]*$", description="empty: all bins"),
    limit: int = LIMIT,
    offset: int = OFFSET,
    backend: ApiBackend = BACKEND,
) -> object:
    """Where pieces of a SKU lie, the most first."""
    return plain(
        await backend.call(backend.operations.call, "find_stock", srv.FindStock, sku, limit, offset)
    )
