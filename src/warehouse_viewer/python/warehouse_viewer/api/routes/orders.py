# SPDX-License-Identifier: Apache-2.0
"""Orders and stock of a shift."""

from typing import Any

from fastapi import APIRouter, HTTPException, Path, Query

from warehouse_msgs import msg, srv
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.operations_json import order, plain
from warehouse_viewer.api.routes.common import LIMIT, OFFSET, SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.operations import (
    STATES,
    Accepted,
    NewOrder,
    Order,
    Orders,
    State,
    Stock,
)
from warehouse_viewer.ros.operations_client import ANY

router = APIRouter()
ORDER = Path(ge=1, le=2**53)


@router.get("/orders", response_model=Orders, responses=problems())
async def get_orders(
    search: str = Query(
        "", max_length=200, regex=r"^[ -~]*$", description="a part of the reference, or a SKU"
    ),
    state: State | None = None,
    late: bool = Query(False, description="those past their due time alone"),
    limit: int = LIMIT,
    offset: int = OFFSET,
    backend: ApiBackend = BACKEND,
) -> Any:
    """Orders, the newest first."""
    which = ANY if state is None else STATES.index(state)
    found = await backend.call(
        backend.operations.find_orders, 0, search, which, late, limit, offset
    )
    return {"total": found.total, "orders": [order(one) for one in found.orders]}


@router.get("/orders/{number}", response_model=Order, responses=problems(404))
async def get_order(number: int = ORDER, backend: ApiBackend = BACKEND) -> Any:
    """One order."""
    found = await backend.call(backend.operations.find_orders, number)
    if not found.orders:
        raise HTTPException(404, f"no order {number}")
    return order(found.orders[0])


@router.post("/orders", status_code=201, response_model=Accepted, responses=problems(*SENT))
async def submit_order(wanted: NewOrder, backend: ApiBackend = BACKEND) -> Any:
    """A new order; kept when this answers."""
    lines = [msg.OrderLine(line.sku, line.quantity) for line in wanted.lines]
    fields = wanted.reference, lines, backend.operations.time(wanted.due), wanted.priority
    answer = await backend.call(backend.operations.call, "submit_order", srv.SubmitOrder, *fields)
    return {"order_id": answer.order_id, "message": answer.message}


@router.delete("/orders/{number}", response_model=Done, responses=problems(409))
async def cancel_order(number: int = ORDER, backend: ApiBackend = BACKEND) -> Any:
    """Cancels an order that is not complete."""
    answer = await backend.call(backend.operations.call, "cancel_order", srv.CancelOrder, number)
    return {"message": answer.message}


@router.get("/stock", response_model=Stock, responses=problems())
async def get_stock(
    sku: str = Query("", max_length=80, regex=r"^[ -~]*$", description="empty: all bins"),
    limit: int = LIMIT,
    offset: int = OFFSET,
    backend: ApiBackend = BACKEND,
) -> Any:
    """Where pieces of a SKU lie, the most first."""
    return plain(
        await backend.call(backend.operations.call, "find_stock", srv.FindStock, sku, limit, offset)
    )
