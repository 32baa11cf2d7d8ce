# SPDX-License-Identifier: Apache-2.0
"""Robots and vehicles at a broker, by VDA 5050."""

from typing import TYPE_CHECKING, Literal

from pydantic import BaseModel, Field

from warehouse_viewer.api.schemas.base import Number, Person
from warehouse_viewer.api.schemas.pydantic_versions import Body, integer, text

if TYPE_CHECKING:
    TopicPart = str
    RobotNumber = int
    Words = str
    Value = str
else:
    TopicPart = text(r"^[A-Za-z0-9_.:-]+$", 100, least=1)
    RobotNumber = integer(0, 1_000_000)
    Words = text(r"^[^\x00-\x1f\x7f]*$", 100)
    Value = text(r"^[^\x00-\x1f\x7f]*$", 2000)


class Waypoint(BaseModel):
    """A point that a vehicle says to reach at a time."""

    x: float = Field(description="[m]")
    y: float = Field(description="[m]")
    time: float = Field(description="[s] since 1970, by the vehicle's clock")


class Vda5050Robot(BaseModel):
    """A robot at a broker, by VDA 5050."""

    id: int
    driven_by: Literal["OUTSIDE_MASTER", "COORDINATOR"] = Field(
        description="OUTSIDE_MASTER: a robot of this warehouse that a master at the broker may"
        " drive; COORDINATOR: a vehicle of another maker that this warehouse drives"
    )
    manufacturer: str
    serial: str
    broker: str
    connection: Literal["ONLINE", "OFFLINE", "CONNECTIONBROKEN"]
    driven: bool = Field(description="whether an order has the robot, or had it just now")
    order: str = Field(description="id of the order under way, or empty")
    errors: list[str]
    faults: list[str] = Field(description="faults on demand that it has")
    planned_path: list[list[float]] = Field(
        [], description="points [x, y] [m] of plannedPath; empty: it says none, as before 3.0.0"
    )
    intermediate_path: list[Waypoint] = Field([], description="points of intermediatePath")


class Vda5050Vehicle(BaseModel):
    """A vehicle that the master has seen at its broker."""

    manufacturer: str
    serial: str
    id: int | None = Field(description="the robot's number; null: it is no robot here")
    connection: Literal["ONLINE", "OFFLINE", "CONNECTIONBROKEN"]
    mode: str = Field(description="operatingMode; empty: it has sent no state")
    position: list[float] | None = Field(
        description="x, y [m] and heading [rad] on its own map; null: it has not said"
    )
    map_id: str
    last_node: str
    factsheet: bool = Field(description="whether it has sent one")
    abilities: list[str] = Field(description="what it can, as sentences")
    misfits: list[str] = Field(description="what does not fit this warehouse, as sentences")


class Vda5050Vehicles(BaseModel):
    """The vehicles at the broker of the master."""

    runs: bool = Field(description="whether a master runs")
    broker: str
    vehicles: list[Vda5050Vehicle]


class NewVehicle(Body):
    """Makes a vehicle at the broker a robot of this warehouse."""

    by: Person = Field("", description="name of the person; empty: not known")
    manufacturer: TopicPart
    serial: TopicPart
    id: RobotNumber = Field(0, description="the robot's number; 0: the lowest that is free")
    place: Literal["STANDS", "ORIGIN"] = Field(
        "STANDS",
        description="STANDS: x, y and heading are the cell where it stands now, and its heading"
        " there; ORIGIN: where its own map has its zero point",
    )
    x: Number = Field(description="[m]")
    y: Number = Field(description="[m]")
    heading: Number = Field(0.0, description="[rad]")
    map_id: Words = Field("", description="in its orders; empty: the one that it reports")
    node_ids: Words = Field("", description="pattern of its node ids; empty: c{column}_{row}")
    action_parameters: Value = Field(
        "", description="of each pick and drop, a JSON object as text; empty: none"
    )
    assume: bool = Field(
        False, description="also without a factsheet; the message says what is assumed"
    )


class VehicleNumber(BaseModel):
    """The robot that a vehicle has become."""

    id: int
    message: str
