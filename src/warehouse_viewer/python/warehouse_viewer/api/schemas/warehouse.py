# SPDX-License-Identifier: Apache-2.0
"""The warehouse as a whole, and how simulated time passes in it."""

from pydantic import BaseModel, ConstrainedInt, Field, StrictBool

from warehouse_viewer.api.schemas.base import Body, Int32, Label, Name, Number


class NewWarehouse(Body):
    """Counts of 0 everywhere with a preset's name mean that preset."""

    name: Name = Field(description="a preset (empty, small, medium, large, huge), or any name")
    id: Int32 = Int32(0)
    robots: Int32 = Int32(0)
    items: Int32 = Int32(0)
    shelves: Int32 = Int32(0)


class Counts(BaseModel):
    robots: int
    shelves: int
    items: int


class Sizes(BaseModel):
    """What can be asked for: presets by name, and the most of each kind."""

    presets: dict[str, Counts]
    limits: Counts


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


class Factor(Number):
    ge, le = 0, 1000


class Seconds(Number):
    ge, le = 0.001, 1e6


class Steps(ConstrainedInt):
    """Steps of the physics."""

    strict, ge, le = True, 1, 100000


class Reset(Body):
    time_too: StrictBool = Field(True, description="false: models alone go back to where they came")


class Step(Body):
    steps: Steps = Field(1, description="of the physics")


class Speed(Body):
    factor: Factor = Field(description="simulated seconds a wall second; 0: as fast as it goes")


class Checkpoint(Body):
    name: Label


class Undo(Body):
    seconds: Seconds = Field(description="[s], simulated")
