# SPDX-License-Identifier: Apache-2.0
"""Tool: what will come of a shift, and what a change would do to it."""

import asyncio
import time
from typing import Annotated, Any

from pydantic import Field

from warehouse_assistant.hub_client import Simulation as Client
from warehouse_assistant.hub_client import Trouble
from warehouse_assistant.toolbox import Simulation, Toolbox
from warehouse_assistant.words import listed, plain, sentence

PATIENCE, GAP = 60.0, 0.5  # for the runs to end [s]

Changes = Annotated[
    list[Annotated[str, Field(max_length=200)]] | None,
    Field(
        max_length=20,
        description='events from now on: "+0 close pick3", "+10m robots +2"; none: as it is',
    ),
]


def add(box: Toolbox) -> None:
    """Adds the tool to a Toolbox."""

    @box.reads("Forecast a shift")
    async def forecast_shift(
        minutes: Annotated[float, Field(ge=1, le=1440, description="how far ahead")] = 60.0,
        changes: Changes = None,
        simulation: Simulation = "",
    ) -> str:
        """Looks ahead of a shift, in half a minute, as it is or with changes that are not made."""
        warehouse = await box.hub.simulation(simulation)
        asked = {"minutes": minutes, "changes": changes or []}
        answer = await warehouse.send("POST", "forecasts", asked)
        return _shown(await _result(warehouse, answer["forecast_id"]))


async def _result(warehouse: Client, number: int) -> dict[str, Any]:
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        result = await warehouse.get(f"forecasts/{number}")
        if result["state"] == "REPLACED":
            raise Trouble("A newer forecast was asked for meanwhile. Ask again.")
        if result["state"] == "DONE":
            return dict(result)
        await asyncio.sleep(GAP)
    raise Trouble("The forecast is not done yet. Ask again for fewer minutes.")


def _shown(result: dict[str, Any]) -> str:
    text = sentence(plain(result["text"], 900))
    if not result["runs"]:
        return text
    ends = listed(
        f"{name} {_last(result[name], 'p50')} ({_last(result[name], 'p10')} to"
        f" {_last(result[name], 'p90')})"
        for name in ("done", "open", "late")
    )
    return f"{text}\nOrders in {result['minutes']:g} min, of {result['runs']} runs: {ends}."


def _last(band: dict[str, list[float]], quantile: str) -> str:
    return f"{band[quantile][-1]:.0f}"
