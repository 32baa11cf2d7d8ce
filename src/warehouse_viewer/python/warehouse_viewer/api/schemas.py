# SPDX-License-Identifier: Apache-2.0
"""What the HTTP API takes and gives. SI units, radians, frame world."""

from typing import Literal

from pydantic import (
    BaseModel,
    ConstrainedFloat,
    Extra,
    Field,
    StrictBool,
    conint,
    conlist,
    constr,
    root_validator,
)
from pydantic.errors import DictError

INT32 = 2**31 - 1
MOST_ROWS = 1000  # of a list, in one answer
MOST = 1e300  # of a number

Mode = Literal["AUTOMATIC", "MANUAL", "OUT_OF_SERVICE"]
TransportState = Literal[
    "RECEIVED", "ASSIGNED", "LIFTED", "ARRIVED", "RELEASED", "STORED", "FAILED", "CANCELLED"
]
Int32 = conint(ge=-INT32 - 1, le=INT32, strict=True)
Name = constr(max_length=100, regex=r"^[ -~]*$", strict=True)
Label = constr(min_length=1, max_length=100, regex=r"^[A-Za-z0-9_.-]+$", strict=True)


class Number(ConstrainedFloat):
    """A finite number; no text that looks like one."""

    allow_inf_nan = False
    ge, le = -MOST, MOST

    @classmethod
    def __get_validators__(cls):
        yield cls._check
        yield from super().__get_validators__()

    @classmethod
    def _check(cls, value):
        # An integer too large for a float would be an error of ours further on.
        if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > MOST:
            raise ValueError("a finite number was expected")
        return value


class Factor(Number):
    ge, le = 0, 1000


class Seconds(Number):
    ge, le = 0.001, 1e6


class WalkingSpeed(Number):
    ge, le = 0.01, 1.6


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


class Counts(BaseModel):
    robots: int
    shelves: int
    items: int


class Sizes(BaseModel):
    """What can be asked for: presets by name, and the most of each kind."""

    presets: dict[str, Counts]
    limits: Counts


class NewRobot(_Body):
    x: Number = Field(description="[m], of a grid point")
    y: Number = Field(description="[m], of a grid point")
    heading: Number = Field(0, description="[rad] about z, by quarter turns; 0: along x")


class NewWalk(_Body):
    """Has a person walk from place to place; one of a new name comes to the first place."""

    name: Name = Field("", description="who; empty: a new person")
    x: conlist(Number, max_items=1000) = Field(description="[m], of each place")
    y: conlist(Number, max_items=1000) = Field(description="[m], as many")
    speed: WalkingSpeed = Field(1.2, description="[m/s]")
    loop: StrictBool = Field(False, description="after the last place comes the first again")


class Walker(BaseModel):
    name: str


class NewTransport(_Body):
    """Has a storage unit brought to a station, or to the cell at (x, y), by whichever robot."""

    storage_unit: Int32 = Field(description="the number in storage_unit<id>")
    station: Name = Field("", description="its name, or empty: to the cell at (x, y)")
    x: Number | None = Field(None, description="[m], of a grid point")
    y: Number | None = Field(None, description="[m], of a grid point")
    then: Literal["STORE", "STAY"] = Field(
        "STORE", description="what becomes of the unit once it is released; STAY: put down there"
    )
    priority: conint(ge=0, le=255, strict=True) = Field(0, description="higher ones come first")

    class Config(_Body.Config):
        schema_extra = {
            "oneOf": [
                {
                    "required": ["station"],
                    "properties": {"station": {"minLength": 1}},
                    "not": {"anyOf": [{"required": ["x"]}, {"required": ["y"]}]},
                },
                {"required": ["x", "y"], "properties": {"station": {"maxLength": 0}}},
            ]
        }

    @root_validator(skip_on_failure=True)
    def _has_one_destination(cls, values):  # noqa: N805 (pydantic's)
        at = [values["x"], values["y"]]
        if values["station"] and at == [None, None]:
            return values
        if not values["station"] and None not in at:
            return values
        raise ValueError("either a station or both x and y were expected")


class NewMode(_Body):
    mode: Mode = Field(description="who commands it: the coordinator, a person, nobody")


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
        description="whether it takes a command; BLOCKED: its last one ended so, and none was "
        "accepted since"
    )
    activity: Literal["IDLE", "BUSY", "BLOCKED", "HOLDING"] = Field(
        description="what the page calls it: its status, or HOLDING if it carries a storage unit "
        "and has no command"
    )
    state: str
    last_end: Literal["", "DONE", "BLOCKED"] = Field(
        description="how its last command ended, until the next is accepted"
    )
    x: float
    y: float
    yaw: float
    storage_unit: str = Field(description="the one it carries, or empty")
    charge: float = Field(description="of its battery, 0 to 1; 1 where energy is not simulated")
    failures: list[str] = Field(description="what is broken in it")


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


class TransportNumber(BaseModel):
    transport_id: int


class Transport(BaseModel):
    id: int
    state: TransportState = Field(
        description="ARRIVED: waits to be released. STORED, FAILED: it is over"
    )
    since: float = Field(description="[s], simulated")
    robot: str = Field(description="that does it, or empty")
    storage_unit: str
    station: str = Field(description="or empty, if it is brought to a cell")
    text: str


class Transports(BaseModel):
    total: int
    transports: list[Transport]


class RobotsByMode(BaseModel):
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


class TransportCounts(BaseModel):
    open: int = Field(description="without a robot yet")
    under_way: int
    delivered: int
    stored: int
    failed: int


class Waiting(BaseModel):
    """A robot that has stood for 10 s or longer although it has somewhere to go."""

    robot: int
    waits_for: int = Field(description="a robot; 0: nobody who is known")
    since: float = Field(description="[s], simulated")
    text: str = Field(description="for what it waits, for a person")


class Coordinator(BaseModel):
    """The fleet at a glance."""

    time: float = Field(description="[s], simulated")
    robots: RobotsByMode
    work: RobotsByWork
    transports: TransportCounts
    manual: list[int] = Field(description="robots that a person commands")
    out_of_service: list[int]
    plan_p50: float = Field(description="computing time of a plan [ms], median")
    plan_p99: float = Field(description="[ms]")
    executed_over_planned: float = Field(description="seconds driven over those planned")
    queues: dict[str, int] = Field(description="units at each station or on their way there")
    waiting: list[Waiting]
    collisions: int
    blocked: int
    watchdog: int = Field(description="how often robots made no progress for 30 s")
    alarms: list[str]
