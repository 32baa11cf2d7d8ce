# SPDX-License-Identifier: Apache-2.0
"""The coordinator: transports, modes of robots and its state at a glance."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

from pydantic import BaseModel, Field

from warehouse_viewer.api.schemas.base import Int32, Name, Number, Person, UInt8
from warehouse_viewer.api.schemas.pydantic_versions import Body, check_all, number, schema_extra

if TYPE_CHECKING:
    Duration = float
else:
    Duration = number(0, 1e9)  # [s]

Failure = Literal["MOTOR", "LIFT_STUCK", "LASER_BLIND", "RADIO_LOST", "WHEEL_SLIPS"]
Fault = Literal[
    "",
    "silent",
    "lost",
    "doubled",
    "reordered",
    "jump",
    "refuse",
    "slow",
    "battery",
    "heading",
    "error",
    "error:WARNING",
    "error:FATAL",
    "clock",
]
Mode = Literal["AUTOMATIC", "MANUAL", "OUT_OF_SERVICE"]
TransportState = Literal[
    "RECEIVED", "ASSIGNED", "LIFTED", "ARRIVED", "RELEASED", "STORED", "FAILED", "CANCELLED"
]


# Either a station or both coordinates.
DESTINATION = {
    "oneOf": [
        {
            "required": ["station"],
            "properties": {"station": {"minLength": 1}},
            "not": {"anyOf": [{"required": ["x"]}, {"required": ["y"]}]},
        },
        {"required": ["x", "y"], "properties": {"station": {"maxLength": 0}}},
    ]
}


def _check_destination(values: Mapping[str, Any]) -> None:
    at = [values["x"], values["y"]]
    if not (at == [None, None] if values["station"] else None not in at):
        raise ValueError("either a station or both x and y were expected")


class NewTransport(Body, **schema_extra(DESTINATION)):
    """Has a storage unit brought to a station, or to the cell at (x, y), by whichever robot."""

    storage_unit: Int32 = Field(description="the number in storage_unit<id>")
    station: Name = Field(
        "", description="name of the station; empty: the goal is the cell at (x, y)"
    )
    x: Number | None = Field(None, description="[m], of a grid point")
    y: Number | None = Field(None, description="[m], of a grid point")
    then: Literal["STORE", "STAY"] = Field(
        "STORE", description="what becomes of the unit once it is released; STAY: put down there"
    )
    priority: UInt8 = Field(0, description="transports of higher priority are assigned first")

    _check = check_all(_check_destination)


class NewMode(Body):
    """Sets how a robot is commanded."""

    by: Person = Field("", description="name of the person that sets it; empty: not known")
    mode: Mode = Field(description="commanded by the coordinator, by a person, or not at all")


class FleetStop(BaseModel):
    """The emergency stop of all robots."""

    stopped: bool
    by: str = Field(description="name of the person that asked for it; empty: not known")
    since: float = Field(description="[s], simulated; 0: none holds")


class NewFailure(Body):
    """Breaks something in a robot."""

    by: Person = ""
    kind: Failure = "MOTOR"
    repair_time: Duration = Field(
        0.0, description="until it is repaired [s], simulated; 0: until asked for"
    )


class NewFault(Body):
    """Lets a vehicle misbehave, as its master sees it."""

    by: Person = ""
    fault: Fault = Field(
        description="empty: all faults end. error is error:FATAL, with which the robot stands"
    )
    seconds: Duration = Field(0.0, description="until it ends [s], wall clock; 0: until ended")


class TransportNumber(BaseModel):
    """The number of a transport."""

    transport_id: int


class Transport(BaseModel):
    """A storage unit's way to a station or a cell, and its state."""

    id: int
    state: TransportState = Field(
        description="ARRIVED: the unit waits to be released. STORED, FAILED: it has ended"
    )
    since: float = Field(description="[s], simulated")
    robot: str = Field(description="the robot assigned to it, or empty")
    storage_unit: str
    station: str = Field(description="name of the station; empty: the goal is a cell")
    text: str


class Transports(BaseModel):
    """Transports, and how many there are in all."""

    total: int
    transports: list[Transport]


class RobotsByMode(BaseModel):
    """Numbers of robots by mode."""

    automatic: int
    manual: int
    out_of_service: int


class RobotsByWork(BaseModel):
    """Robots that are AUTOMATIC."""

    idle: int
    fetching: int
    ready: int = Field(description="beneath a unit, until its station has room for it")
    lifting: int
    bringing: int
    waiting: int = Field(description="at a station, or a cell, until their transport is released")
    storing: int
    dropping: int


class RobotsByActivity(BaseModel):
    """Numbers of robots by what they do at a glance, as lists, floor and figures show it."""

    needs_help: int
    waiting: int
    working: int
    moving: int
    resting: int


class TransportCounts(BaseModel):
    """Numbers of transports by state."""

    open: int = Field(description="transports without a robot yet")
    under_way: int
    delivered: int
    stored: int
    failed: int


class Waiting(BaseModel):
    """A robot that has stood for 10 s or longer although it has somewhere to go."""

    robot: int
    waits_for: int = Field(description="id of the robot that blocks it; 0: unknown")
    since: float = Field(description="[s], simulated")
    text: str = Field(description="why the robot waits, as a sentence")


class Coordinator(BaseModel):
    """The fleet at a glance."""

    time: float = Field(description="[s], simulated")
    robots: RobotsByMode
    work: RobotsByWork
    activities: RobotsByActivity | None = Field(
        None, description="of all robots; null where their reports are not at hand"
    )
    transports: TransportCounts
    manual: list[int] = Field(description="robots that a person commands")
    out_of_service: list[int]
    plan_p50: float = Field(description="computing time of a plan [ms], median")
    plan_p99: float = Field(description="computing time of a plan [ms], 99th percentile")
    executed_over_planned: float = Field(description="driving time as executed, over that planned")
    queues: dict[str, int] = Field(description="units at each station or on their way there")
    waiting: list[Waiting]
    collisions: int
    blocked: int
    watchdog: int = Field(description="how often robots made no progress for 30 s")
    alarms: list[str]
