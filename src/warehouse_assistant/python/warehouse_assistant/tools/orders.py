# SPDX-License-Identifier: Apache-2.0
"""Tools: list, submit, cancel and prioritise orders."""

from typing import Annotated, Literal

from pydantic import BaseModel, Field

from warehouse_assistant.toolbox import Priority, Simulation, Toolbox
from warehouse_assistant.tools.overview import order_text
from warehouse_assistant.words import count, plain

Number = Annotated[int, Field(ge=1, le=2**53, description="the order's number")]


class Line(BaseModel):
    """A line of an order."""

    sku: Annotated[str, Field(min_length=1, max_length=80)]
    quantity: Annotated[int, Field(ge=1, le=10_000)]


def add(box: Toolbox) -> None:
    """Adds the tools to a Toolbox."""

    @box.reads("List orders")
    async def list_orders(
        state: Annotated[
            Literal["", "OPEN", "ASSIGNED", "COMPLETED", "CANCELLED"],
            Field(description="empty: any"),
        ] = "",
        late: Annotated[bool, Field(description="those past their due time alone")] = False,
        search: Annotated[str, Field(max_length=200, description="in reference or SKU")] = "",
        limit: Annotated[int, Field(ge=1, le=100)] = 10,
        offset: Annotated[int, Field(ge=0, le=10**9, description="rows to leave out")] = 0,
        simulation: Simulation = "",
    ) -> str:
        """Lists orders, the newest first."""
        warehouse = await box.hub.simulation(simulation)
        query = {"late": str(late).lower(), "search": search, "limit": limit, "offset": offset}
        if state:
            query["state"] = state
        answer = await warehouse.get("orders", **query)
        lines = [f"{count(answer['total'], 'order')} in all.", *map(order_text, answer["orders"])]
        return "\n".join(lines)

    @box.changes("Submit an order")
    async def submit_order(
        lines: Annotated[list[Line], Field(min_length=1, max_length=100)],
        reference: Annotated[str, Field(max_length=80, description="a name of your own")] = "",
        priority: Priority = 0,
        due: Annotated[float, Field(ge=0, description="simulated time [s]; 0: none")] = 0.0,
        simulation: Simulation = "",
    ) -> str:
        """Submits an order of one or more SKUs."""
        warehouse = await box.hub.simulation(simulation)
        body = {
            "lines": [line.model_dump() for line in lines],
            "reference": reference,
            "priority": priority,
            "due": due,
        }
        answer = await warehouse.send("POST", "orders", body)
        return f"Order {answer['order_id']} is accepted. {plain(answer['message'], 300)}".rstrip()

    @box.changes("Cancel an order", destroys=True, repeatable=True)
    async def cancel_order(order: Number, simulation: Simulation = "") -> str:
        """Cancels an order that is not complete."""
        warehouse = await box.hub.simulation(simulation)
        answer = await warehouse.send("DELETE", f"orders/{order}")
        return f"Order {order} is cancelled. {plain(answer['message'], 300)}".rstrip()

    @box.changes("Put an order before others")
    async def prioritise_order(
        order: Number, priority: Priority, simulation: Simulation = ""
    ) -> str:
        """Sets the priority of an order that is not complete."""
        warehouse = await box.hub.simulation(simulation)
        answer = await warehouse.send("PATCH", f"orders/{order}", {"priority": priority})
        return f"Order {order}: {plain(answer['message'], 300)}."
