# SPDX-License-Identifier: Apache-2.0
"""The warehouse as a whole, and how simulated time passes in it."""

from typing import TYPE_CHECKING

from pydantic import BaseModel, Field, StrictBool

from warehouse_viewer.api.schemas.base import Int32, Label, Name
from warehouse_viewer.api.schemas.pydantic_versions import Body, integer, number, text

MOST_TEXT = 1_000_000  # characters of a layout

if TYPE_CHECKING:
    Steps = int
    Factor = float
    Seconds = float
    LayoutText = str
else:
    Steps = integer(1, 100000)  # of the physics
    Factor = number(0, 1000)  # simulated seconds a wall second
    Seconds = number(0.001, 1e6)  # simulated
    LayoutText = text("", MOST_TEXT)


class NewWarehouse(Body):
    """Counts of 0 everywhere with a preset's name mean that preset. A layout needs no name."""

    name: Name = Field("", description="a preset (empty, small, medium, large, huge), or any name")
    layout: LayoutText = Field("", description="the content of a layout file, NAME.layout.yaml")
    id: Int32 = 0
    robots: Int32 = 0
    items: Int32 = 0
    shelves: Int32 = 0


class Counts(BaseModel):
    """Numbers of models by kind."""

    robots: int
    shelves: int
    items: int


class Sizes(BaseModel):
    """What can be asked for: presets by name, and the most of each kind."""

    presets: dict[str, Counts]
    limits: Counts


class Warehouse(BaseModel):
    """The warehouse, its size and how time passes in it."""

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


class Reset(Body):
    """Puts all models back to where they came."""

    time_too: StrictBool = Field(True, description="false: models alone go back to where they came")


class Step(Body):
    """Advances a paused world by a number of steps."""

    steps: Steps = Field(1, description="of the physics")


class Speed(Body):
    """Sets how fast simulated time passes."""

    factor: Factor = Field(description="simulated seconds a wall second; 0: as fast as it goes")


class Checkpoint(Body):
    """The name of a checkpoint."""

    name: Label


class Undo(Body):
    """Goes back in simulated time."""

    seconds: Seconds = Field(description="[s], simulated")
