# SPDX-License-Identifier: Apache-2.0
"""Alarms, and the four figures by which a shift is led."""

from typing import TYPE_CHECKING, Literal

from pydantic import BaseModel, Field

from warehouse_viewer.api.schemas.pydantic_versions import Body, text

Severity = Literal["critical", "warning", "note"]

if TYPE_CHECKING:
    Person = str
else:
    Person = text(r"^[^\x00-\x1f\x7f]*$", 60)


class Alarm(BaseModel):
    """Something that a person should look after, for as long as it lasts."""

    id: int
    kind: str = Field(description="one of `kinds`")
    severity: Severity
    title: str
    subject: str = Field(description="the robot, station or item that it concerns")
    text: str = Field(description="the cause, as a sentence")
    to_do: str = Field(description="what a person should do")
    since: float = Field(description="[s], simulated")
    seen_by: str = Field(description="the name of the person that saw it; empty: no person yet")
    seen_at: float = Field(description="[s], simulated; 0: not yet")


class AlarmKind(BaseModel):
    """What holds for all alarms of a kind."""

    severity: Severity
    title: str
    to_do: str
    after: float = Field(description="duration from which it counts [s], simulated")


class Alarms(BaseModel):
    """The alarms that hold now, the worst first, of those the oldest first."""

    total: int
    alarms: list[Alarm]
    kinds: dict[str, AlarmKind]


class Seen(Body):
    """Who has seen an alarm; an empty name takes it back."""

    by: Person


class Figure(BaseModel):
    """A figure with its last hour and its target."""

    value: float
    target: float = Field(description="0: none is known yet")
    of: float = Field(description="of which it is a part, such as the upper bound; 0: of nothing")
    times: list[float] = Field(description="of the values [s], simulated")
    values: list[float]


class LeadingFigures(BaseModel):
    """The four figures by which a shift is led."""

    pieces: Figure = Field(description="pieces picked in an hour; of: the upper bound")
    orders: Figure = Field(description="orders completed in an hour; the target: that come in")
    late: Figure = Field(description="share of late orders; the target is the most")
    available: Figure = Field(description="share of robots that can work; of: all robots")
