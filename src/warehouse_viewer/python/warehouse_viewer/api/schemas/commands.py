# SPDX-License-Identifier: Apache-2.0
"""Commands to robots and people, and what became of them."""

from typing import TYPE_CHECKING, Literal

from pydantic import BaseModel, Field, StrictBool

from warehouse_viewer.api.schemas.base import Int8, Int32, Name, Number, UInt8
from warehouse_viewer.api.schemas.pydantic_versions import Body, items, number

if TYPE_CHECKING:
    WalkingSpeed = float
else:
    WalkingSpeed = number(0.01, 1.6)  # [m/s]


class Mov(Body):
    """Go to (x, y): along x first, then along y."""

    command: Literal["mov"]
    x: Number = Field(description="[m]")
    y: Number = Field(description="[m]")


class MovX(Body):
    """Go along the world's x axis."""

    command: Literal["movx"]
    distance: Number = Field(description="[m], signed, a whole number of cells")


class MovY(Body):
    """Go along the world's y axis."""

    command: Literal["movy"]
    distance: Number = Field(description="[m], signed, a whole number of cells")


class Rot(Body):
    """Turn a quarter."""

    command: Literal["rot"]
    direction: Int8 = Field(description="1 counterclockwise, -1 clockwise")


class LiftCommand(Body):
    """Carry or drop a storage unit."""

    command: Literal["lift"]
    status: UInt8 = Field(description="1 carry, 0 drop")
    shelf_id: Int32 = Field(
        0, description="the number in storage_unit<id>; may be left out to drop what it carries"
    )


Command = Mov | MovX | MovY | Rot | LiftCommand


class NewWalk(Body):
    """Has a person walk from place to place; one of a new name comes to the first place."""

    name: Name = Field("", description="name of the person; empty: a new person")
    x: list[Number] = Field(**items(0, 1000), description="x of each waypoint [m]")
    y: list[Number] = Field(**items(0, 1000), description="y of each waypoint [m], as many as x")
    speed: WalkingSpeed = Field(1.2, description="[m/s]")
    loop: StrictBool = Field(False, description="walk to the first waypoint again after the last")


class Walker(BaseModel):
    """A person who walks."""

    name: str


class Event(BaseModel):
    """An event in the world."""

    id: int
    time: float = Field(description="[s], simulated")
    kind: str
    command: int = Field(
        description="number of the command that the event belongs to, from 1; 0: none"
    )
    model: str
    other: str
    text: str


class Events(BaseModel):
    """Events, the oldest first."""

    events: list[Event]


class Outcome(BaseModel):
    """The state of a command."""

    outcome: Literal["accepted", "done", "blocked", "pending"]
    events: list[Event]


class Commanded(BaseModel):
    """A request that changes something, and its answer; or a command over ROS."""

    id: int
    time: float = Field(description="[s], simulated")
    wall: str = Field(description="time on the wall, ISO 8601, UTC")
    by: str = Field(
        description="the person, by header X-Person or `by`; empty: not given; of ROS the node"
    )
    address: str = Field(description="of the client; empty over ROS")
    method: str = Field(description="of HTTP; TOPIC, SERVICE: it came over a ROS topic or service")
    path: str = Field(description="beneath /api/v1, or the topic or service")
    body: str = Field(description="the request's, or the message's, first 300 characters")
    status: int = Field(
        description="of the answer: 200 done, 409 refused; 0: not known, as over ROS"
    )


class Commands(BaseModel):
    """The newest commands since the viewer began, the oldest of them first."""

    commands: list[Commanded]
