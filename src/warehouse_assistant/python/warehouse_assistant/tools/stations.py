# SPDX-License-Identifier: Apache-2.0
"""Tools: a station's work, its opening and closing, confirmed picks."""

from typing import Annotated, Any, Literal

from pydantic import Field

from warehouse_assistant.hub_client import Simulation as Client
from warehouse_assistant.hub_client import Trouble, segment
from warehouse_assistant.toolbox import Simulation, Station, Toolbox
from warehouse_assistant.words import listed, plain, quoted, sentence


def add(box: Toolbox) -> None:
    """Adds the tools to a Toolbox."""

    @box.reads("Describe a station")
    async def describe_station(station: Station, simulation: Simulation = "") -> str:
        """Returns a station's mode, the picks from the unit at it, its orders and totes."""
        warehouse = await box.hub.simulation(simulation)
        row = await _station(warehouse, station)
        state = "open" if row["open"] else "closed"
        inbound = listed(row["inbound"]) or "none"
        lines = [
            f"{quoted(row['name'])}: {state}, {row['mode']}, busy {row['busy_fraction']:.0%}.",
            f"Unit there: {row['shelf_id'] or 'none'}; on the way: {inbound}.",
            f"Orders: {listed(row['orders'], 30) or 'none'}, of {row['slots']} places.",
        ]
        lines += [
            f"Pick {p['quantity']} of {quoted(p['sku'], 60)} from {quoted(p['item'], 60)} for"
            f" order {p['order_id']} into tote {p['tote']}."
            for p in row["picks"]
        ]
        return "\n".join(lines)

    @box.changes("Open or close a station", repeatable=True)
    async def set_station(
        station: Station,
        is_open: Annotated[bool, Field(description="whether it takes orders")],
        mode: Annotated[
            Literal["", "AUTOMATIC", "MANUAL"],
            Field(description="MANUAL: it waits for confirmations; empty: as it is"),
        ] = "",
        simulation: Simulation = "",
    ) -> str:
        """Opens or closes a station, and sets whether it waits for a person."""
        warehouse = await box.hub.simulation(simulation)
        row = await _station(warehouse, station)
        body = {"open": is_open, "mode": mode or row["mode"]}
        answer = await warehouse.send("PUT", f"stations/{segment(row['name'])}", body)
        state = "open" if is_open else "closed"
        text = f"{quoted(row['name'])} is {state}, {body['mode']}."
        return f"{text} {plain(answer['message'], 300)}".rstrip()

    @box.changes("Confirm a pick")
    async def confirm_pick(
        station: Station,
        sku: Annotated[str, Field(min_length=1, max_length=80)],
        quantity: Annotated[int, Field(ge=1, le=10_000, description="pieces")],
        simulation: Simulation = "",
    ) -> str:
        """Confirms that a person has picked pieces, or put them in, at a station in mode MANUAL."""
        warehouse = await box.hub.simulation(simulation)
        body = {"sku": sku, "quantity": quantity}
        path = f"stations/{segment(station)}/confirm"
        return sentence(plain((await warehouse.send("POST", path, body))["message"], 300) or "Done")


async def _station(warehouse: Client, name: str) -> dict[str, Any]:
    rows = (await warehouse.get("stations"))["stations"]
    for row in rows:
        if str(row["name"]).lower() == name.lower():
            return row
    which = listed(quoted(row["name"]) for row in rows)
    raise Trouble(f"There is no station {quoted(name)}. Stations: {which or 'none'}.")
