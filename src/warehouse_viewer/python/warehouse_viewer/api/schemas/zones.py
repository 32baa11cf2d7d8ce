# SPDX-License-Identifier: Apache-2.0
"""Zones of the floor that are closed for a time."""

from typing import TYPE_CHECKING

from pydantic import BaseModel, Field

from warehouse_viewer.api.schemas.base import Number, Person
from warehouse_viewer.api.schemas.pydantic_versions import Body, number, text

if TYPE_CHECKING:
    Closure = float
    Why = str
else:
    Closure = number(0, 7 * 24 * 3600)  # [s]
    Why = text(r"^[^\x00-\x1f\x7f]+$", 60, least=1)


class NewZone(Body):
    """Closes the rectangle between two opposite corners: the cells that hold them, and all
    between."""

    x1: Number = Field(description="[m]")
    y1: Number = Field(description="[m]")
    x2: Number = Field(description="[m]")
    y2: Number = Field(description="[m]")
    reason: Why = Field(description="for people, as 'spill'")
    duration: Closure = Field(0.0, description="[s], simulated; 0: until it is opened")
    by: Person = Field("", description="name of the person that closes it; empty: not known")


class ClosedZone(BaseModel):
    """A rectangle of the floor that the fleet's robots keep out of."""

    id: int
    reason: str
    closed_by: str = Field(description="name of the person; empty: not known")
    x_min: float = Field(description="its edges [m]")
    y_min: float
    x_max: float
    y_max: float
    since: float = Field(description="[s], simulated")
    until: float | None = Field(description="[s], simulated; null: until it is opened")
    inside: list[str] = Field(description="robots that are in it now")
    waits: list[str] = Field(description="what waits for it to be opened, as sentences")


class HeldTransport(BaseModel):
    """A transport that waits for a zone."""

    transport: int
    storage_unit: str
    why: str = Field(description="as a sentence")


class ClosedZones(BaseModel):
    """The closed zones, and the transports that wait for them."""

    zones: list[ClosedZone]
    waiting: list[HeldTransport]


class ZoneNumber(BaseModel):
    """The number of a zone that was closed, and what waits for it."""

    id: int
    waits: list[str] = Field(description="as sentences")


class ZoneForecast(BaseModel):
    """What would wait if a zone were closed."""

    waits: list[str] = Field(description="as sentences; none: all goes on around it")
