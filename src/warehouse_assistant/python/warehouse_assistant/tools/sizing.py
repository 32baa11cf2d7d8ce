# SPDX-License-Identifier: Apache-2.0
"""Tools: how many robots and stations a warehouse needs, which the hub computes."""

from typing import Annotated, Any, Literal

from pydantic import Field

from warehouse_assistant.toolbox import Toolbox
from warehouse_assistant.words import duration, plain, sentence

PATH = "/api/v1/sizings"


def add(box: Toolbox) -> None:
    """Adds the tools to a Toolbox."""

    @box.changes("Size a warehouse")
    async def size_warehouse(
        orders_per_hour: Annotated[float, Field(gt=0, le=1e6, description="that come evenly")],
        layout: Annotated[
            Literal["small", "medium", "large", "huge"], Field(description="a preset")
        ] = "medium",
        late_percent: Annotated[
            float, Field(gt=0, le=100, description="of the orders may be late")
        ] = 1.0,
        hours: Annotated[float, Field(gt=0, le=24, description="of a shift")] = 8.0,
        realism: Annotated[
            Literal["", "typical", "bad_day"], Field(description="batteries and failures")
        ] = "",
    ) -> str:
        """Finds the fewest robots and picking stations that keep up with a rate of orders."""
        body = {
            "size": layout,
            "orders_per_hour": orders_per_hour,
            "late": late_percent / 100,
            "hours": hours,
            "realism": realism,
        }
        row = await box.hub.send("POST", PATH, body)
        return (
            f"Sizing {row['id']} runs: a minute or so for small and medium, some for larger"
            " ones. Then ask sizing_results."
        )

    @box.reads("Answers of sizings")
    async def sizing_results() -> str:
        """Lists what was sized, with the numbers of robots and stations that suffice."""
        rows = (await box.hub.get(PATH))["sizings"]
        return "\n".join(map(_row, rows)) or "Nothing was sized yet. size_warehouse does it."


def _row(row: dict[str, Any]) -> str:
    asked = row["question"]
    text = (
        f"Sizing {row['id']}, {plain(asked['layout'], 60)}, {asked['orders_per_hour']:g} orders an"
        f" hour, at most {100 * asked['late']:g} % late in {asked['hours']:g} h:"
    )
    if row["state"] == "RUNNING":
        return sentence(
            f"{text} runs for {duration(row['seconds'])}; {plain(row['progress'], 160)}"
        )
    return sentence(f"{text} {row['state'].lower()}: {plain(row['answer'], 900)}")
