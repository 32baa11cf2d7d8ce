# SPDX-License-Identifier: Apache-2.0
"""Alarms, and the four figures by which a shift is led."""

from typing import Literal

from pydantic import BaseModel, Field

from warehouse_viewer.api.schemas.base import Person
from warehouse_viewer.api.schemas.pydantic_versions import Body

Severity = Literal["critical", "warning", "note"]


class Remedy(BaseModel):
    """Something that a person can do about an alarm."""

    action: str
    label: str = Field(description="the words of the button")
    target: str = Field(description="the robot, item or station that it is done to")


class Action(BaseModel):
    """What a person did about an alarm."""

    time: float = Field(description="[s], simulated")
    by: str
    what: str


class Alarm(BaseModel):
    """Something that a person should look after, for as long as it lasts."""

    id: int
    kind: str = Field(description="one of `kinds`")
    severity: Severity
    title: str
    subject: str = Field(description="the robot, station or item that it concerns")
    text: str = Field(description="the cause and its consequences, as a sentence")
    cause: str = Field(description="the cause alone")
    consequences: list[str] = Field(description="what follows from the cause, each a sentence")
    to_do: str = Field(description="what a person should do")
    since: float = Field(description="[s], simulated")
    seen_by: str = Field(description="the name of the person that saw it; empty: no person yet")
    seen_at: float = Field(description="[s], simulated; 0: not yet")
    remedies: list[Remedy] = Field(description="what may help, as /remedies carries it out")
    actions: list[Action] = Field(description="what people did, the first first")


class EndedAlarm(Alarm):
    """An alarm whose cause has gone."""

    until: float = Field(description="[s], simulated")
    duration: float = Field(description="[s], simulated")


class AlarmHistory(BaseModel):
    """The alarms that have ended since the launch began, the newest first; the last 500."""

    total: int
    alarms: list[EndedAlarm]
    repairs: int = Field(description="how many broken robots work again")
    mean_time_to_repair: float = Field(description="of these [s], simulated; 0 without any")


class Why(BaseModel):
    """Why a robot or a station waits, or what it does; the same sentence on all pages."""

    name: str
    text: str = Field(description="without its subject: waits in the queue of pick4 behind kiva16")
    sentence: str = Field(description="with its subject, and where a robot goes for which order")
    since: float = Field(description="[s], simulated")
    errand: str = Field(description="where a robot goes, for which unit and order; or empty")
    station: str = Field(description="where the robot goes, or empty")
    storage_unit: str
    order: int = Field(description="number of the order; 0: for none, or goods come")
    behind: str = Field(description="the robot directly ahead, or empty")
    cause: str = Field(description="the robot or station at fault, or empty")


class Doer(Body):
    """Names the person that does something; empty: not known."""

    by: Person = ""


class AlarmKind(BaseModel):
    """What holds for all alarms of a kind."""

    severity: Severity
    title: str
    to_do: str
    after: float = Field(description="duration from which it counts [s], simulated")
    remedies: list[str] = Field(description="actions that may help")


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
    early: bool = Field(description="the shift is younger than what the value is the mean of")
    enough: bool = Field(description="all is done that is ordered: a target above it means nothing")
    of: float = Field(description="of which it is a part, such as the upper bound; 0: of nothing")
    times: list[float] = Field(description="of the values [s], simulated")
    values: list[float]


class LeadingFigures(BaseModel):
    """The four figures by which a shift is led."""

    pieces: Figure = Field(description="pieces picked in an hour; of: the upper bound")
    orders: Figure = Field(description="orders completed in an hour; the target: that come in")
    late: Figure = Field(description="share of late orders; the target is the most")
    available: Figure = Field(description="share of robots that can work; of: all robots")
