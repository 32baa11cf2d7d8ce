# SPDX-License-Identifier: Apache-2.0
"""Robots, storage units and items."""

from typing import Literal

from pydantic import BaseModel, Field

from warehouse_viewer.api.schemas.base import Number
from warehouse_viewer.api.schemas.pydantic_versions import Body


class NewRobot(Body):
    """Adds a robot at a grid point."""

    x: Number = Field(description="[m], of a grid point")
    y: Number = Field(description="[m], of a grid point")
    heading: Number = Field(0, description="[rad] about z, by quarter turns; 0: along x")


class Pose(BaseModel):
    """A position [m] and an orientation, a quaternion, in the world."""

    x: float
    y: float
    z: float
    qx: float
    qy: float
    qz: float
    qw: float


class Robot(BaseModel):
    """A robot, with its pose in the world [m, rad]."""

    name: str
    id: int
    status: Literal["IDLE", "BUSY", "BLOCKED"] = Field(
        description="whether it takes a command; BLOCKED: its last one ended so, and none was "
        "accepted since"
    )
    activity: Literal["RESTING", "MOVING", "WORKING", "WAITING", "NEEDS_HELP"] = Field(
        description="what the page calls it: RESTING without command and load; MOVING; WORKING "
        "while it lifts, or stands with a storage unit; WAITING for too long or at an obstacle; "
        "NEEDS_HELP if it is broken, or its last command ended before an obstacle"
    )
    state: str
    last_end: Literal["", "DONE", "BLOCKED"] = Field(
        description="how its last command ended, until the next is accepted"
    )
    x: float
    y: float
    yaw: float
    storage_unit: str = Field(description="the one it carries, or empty")
    charge: float = Field(
        description="state of charge of the battery, 0 to 1; 1 where energy is not simulated"
    )
    failures: list[str] = Field(description="failures of the robot")


class Thing(BaseModel):
    """A storage unit or an item."""

    name: str
    id: int
    pose: Pose
    storage_unit: str = Field(description="the one an item lies on, or empty")
    carrier: str = Field(description="the robot that carries it, or empty")


class Robots(BaseModel):
    """Robots, and how many there are in all."""

    total: int
    robots: list[Robot]


class Things(BaseModel):
    """Storage units or items, and how many there are in all."""

    total: int
    things: list[Thing]
