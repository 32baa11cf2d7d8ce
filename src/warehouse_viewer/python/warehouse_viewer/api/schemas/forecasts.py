# SPDX-License-Identifier: Apache-2.0
"""Forecasts: what will come of the shift that runs."""

from typing import TYPE_CHECKING, Literal

from pydantic import BaseModel, Field

from warehouse_viewer.api.schemas.pydantic_versions import Body, integer, items, number, text

DAY = 24 * 60  # [min]
MOST_RUNS, MOST_CHANGES = 1000, 50

if TYPE_CHECKING:
    Minutes = float
    Runs = int
    Change = str
else:
    Minutes = number(1, DAY)
    Runs = integer(0, MOST_RUNS)
    Change = text(r"^[ -~]+$", 200, least=1)


class NewForecast(Body):
    """Asks what will come of the shift that runs."""

    minutes: Minutes = Field(60.0, description="how far ahead [min]")
    runs: Runs = Field(0, description="0: as many as 20 s allow")
    changes: list[Change] = Field(
        [],
        description="events of a scenario, a line each, after + and the time from now:"
        ' "+0 close pick3", "+10m robots +2"',
        **items(0, MOST_CHANGES),
    )


class Band(BaseModel):
    """Values over time: 10, 50 and 90 % of the runs have fewer."""

    p10: list[float]
    p50: list[float]
    p90: list[float]


class End(BaseModel):
    """When something is over [s], simulated: in 10, 50 and 90 % of the runs by then; null: not
    within the forecast."""

    p10: float | None
    p50: float | None
    p90: float | None


class Forecast(BaseModel):
    """What will come of a shift, from many runs ahead of ideal robots."""

    forecast_id: int
    state: Literal["RUNNING", "DONE", "REPLACED"] = Field(
        description="REPLACED: a newer one was asked for before its end, or it is not kept"
    )
    made_at: float = Field(0.0, description="when the runs begin [s], simulated")
    minutes: float = Field(0.0, description="how far ahead [min]")
    runs: int = Field(0, description="that it is made from")
    changes: list[str] = Field([], description="none: as it is")
    time: list[float] = Field([], description="of each value of the bands [s], simulated")
    done: Band | None = Field(None, description="orders done since made_at")
    open: Band | None = Field(None, description="orders that are not over")
    late: Band | None = Field(None, description="orders past their due time")
    pieces_per_hour: Band | None = None
    finish: End | None = Field(None, description="all orders known at made_at are done")
    text: str = Field("", description="the result in words, or why the forecast failed")
