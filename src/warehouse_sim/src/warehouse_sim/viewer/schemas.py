# SPDX-License-Identifier: Apache-2.0
"""What the HTTP API takes and gives. SI units, radians, frame world."""

from typing import Literal

from pydantic import BaseModel, ConstrainedFloat, Extra, Field, StrictBool, conint, constr
from pydantic.errors import DictError

INT32 = 2**31 - 1
MOST_ROWS = 1000  # of a list, in one answer

Int32 = conint(ge=-INT32 - 1, le=INT32, strict=True)
Name = constr(max_length=100, regex=r"^[ -~]*$", strict=True)
Label = constr(min_length=1, max_length=100, regex=r"^[A-Za-z0-9_.-]+$", strict=True)


class Number(ConstrainedFloat):
    """A finite number; no text that looks like one."""

    allow_inf_nan = False

    @classmethod
    def __get_validators__(cls):
        yield cls._check
        yield from super().__get_validators__()

    @classmethod
    def _check(cls, value):
        # An integer too large for a float would be an error of ours further on.
        if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > 1e300:
            raise ValueError("a finite number was expected")
        return value


class Factor(Number):
    ge, le = 0, 1000


class Seconds(Number):
    ge, le = 0.001, 1e6


class _Body(BaseModel):
    class Config:
        extra = Extra.forbid

    @classmethod
    def validate(cls, value):
        # pydantic would take a list of pairs, an empty one too.
        if isinstance(value, list):
            raise DictError
        return super().validate(value)


# --- in
class Mov(_Body):
    """Go to (x, y): along x first, then along y."""

    command: Literal["mov"]
    x: Number = Field(description="[m]")
    y: Number = Field(description="[m]")


class MovX(_Body):
    """Go along the world's x axis."""

    command: Literal["movx"]
    distance: Number = Field(description="[m], signed, a whole number of cells")


class MovY(_Body):
    """Go along the world's y axis."""

    command: Literal["movy"]
    distance: Number = Field(description="[m], signed, a whole number of cells")


class Rot(_Body):
    """Turn a quarter."""

    command: Literal["rot"]
    direction: conint(ge=-128, le=127, strict=True) = Field(
        description="1 counterclockwise, -1 clockwise"
    )


class LiftCommand(_Body):
    """Carry or drop a storage unit."""

    command: Literal["lift"]
    status: conint(ge=0, le=255, strict=True) = Field(description="1 carry, 0 drop")
    shelf_id: Int32 = Field(
        0, description="the number in storage_unit<id>; may be left out to drop what it carries"
    )


Command = Mov | MovX | MovY | Rot | LiftCommand


class NewWarehouse(_Body):
    """Counts of 0 everywhere with a preset's name mean that preset."""

    name: Name = Field(description="a preset (empty, small, medium, large, huge), or any name")
    id: Int32 = 0
    robots: Int32 = 0
    items: Int32 = 0
    shelves: Int32 = 0


class NewRobot(_Body):
    x: Number = Field(description="[m], of a grid point")
    y: Number = Field(description="[m], of a grid point")
    heading: Number = Field(0, description="[rad] about z, by quarter turns; 0: along x")


class Reset(_Body):
    time_too: StrictBool = Field(True, description="false: models alone go back to where they came")


class Step(_Body):
    steps: conint(ge=1, le=100000, strict=True) = Field(1, description="of the physics")


class Speed(_Body):
    factor: Factor = Field(description="simulated seconds a wall second; 0: as fast as it goes")


class Checkpoint(_Body):
    name: Label


class Undo(_Body):
    seconds: Seconds = Field(description="[s], simulated")


# --- out
class Problem(BaseModel):
    detail: str = Field(description="the reason, for a person")


class Pose(BaseModel):
    x: float
    y: float
    z: float
    qx: float
    qy: float
    qz: float
    qw: float


class Robot(BaseModel):
    name: str
    id: int
    status: Literal["IDLE", "BUSY", "BLOCKED"] = Field(
        description="BLOCKED: its last command ended so, and none was accepted since"
    )
    state: str
    last_end: Literal["", "DONE", "BLOCKED"] = Field(
        description="how its last command ended, until the next is accepted"
    )
    x: float
    y: float
    yaw: float
    storage_unit: str = Field(description="the one it carries, or empty")


class Thing(BaseModel):
    """A storage unit or an item."""

    name: str
    id: int
    pose: Pose
    storage_unit: str = Field(description="the one an item lies on, or empty")
    carrier: str = Field(description="the robot that carries it, or empty")


class Event(BaseModel):
    id: int
    time: float = Field(description="[s], simulated")
    kind: str
    command: int = Field(description="the one it belongs to, counted from 1; 0: none")
    model: str
    other: str
    text: str


class Robots(BaseModel):
    total: int
    robots: list[Robot]


class Things(BaseModel):
    total: int
    things: list[Thing]


class Events(BaseModel):
    events: list[Event]


class Warehouse(BaseModel):
    name: str
    id: int
    robots: int
    storage_units: int
    items: int
    belts: int
    time: float = Field(description="[s], simulated")
    real_time_factor: float
    paused: bool
    target_factor: float = Field(description="simulated seconds a wall second, 0 = full speed")
    step_size: float = Field(description="of the physics [s]")
    lacks: dict[str, str] = Field(description="what can't be done with this engine, and why")


class Outcome(BaseModel):
    """What became of a command so far."""

    outcome: Literal["accepted", "done", "blocked", "pending"]
    events: list[Event]


class Done(BaseModel):
    message: str
