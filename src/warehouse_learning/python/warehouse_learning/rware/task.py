# SPDX-License-Identifier: Apache-2.0
"""What RWARE's arguments mean: the task, its spaces, and the warehouses that run it."""

from dataclasses import dataclass, field
from enum import Enum, IntEnum
from typing import Any, TypeVar

import numpy as np

from warehouse_learning._core import Rware
from warehouse_learning.rware.layout import Layout, of_file, of_parameters, of_text

E = TypeVar("E", bound=Enum)


class Action(IntEnum):
    """What an agent does in a step."""

    NOOP = 0
    FORWARD = 1
    LEFT = 2
    RIGHT = 3
    TOGGLE_LOAD = 4


class Direction(IntEnum):
    """Where an agent looks; UP is towards row 0."""

    UP = 0
    DOWN = 1
    LEFT = 2
    RIGHT = 3


class RewardType(Enum):
    """Which agents a delivery rewards: all, its carrier, or its carrier by half, and by the other
    half when the shelf is put back."""

    GLOBAL = 0
    INDIVIDUAL = 1
    TWO_STAGE = 2


class ObservationType(Enum):
    """What an agent observes: a dictionary, that as a vector, layers of a picture, or both."""

    DICT = 0
    FLATTENED = 1
    IMAGE = 2
    IMAGE_DICT = 3


class ImageLayer(Enum):
    """What a layer of a picture shows."""

    SHELVES = 0
    REQUESTS = 1
    AGENTS = 2
    AGENT_DIRECTION = 3
    AGENT_LOAD = 4
    GOALS = 5
    ACCESSIBLE = 6


LAYERS = (
    ImageLayer.SHELVES,
    ImageLayer.REQUESTS,
    ImageLayer.AGENTS,
    ImageLayer.GOALS,
    ImageLayer.ACCESSIBLE,
)
FEATURES = 6  # of an IMAGE_DICT: direction one hot, on a highway, carries


@dataclass
class Task:
    """RWARE's arguments, by its names and with its defaults.

    layout: a text that draws the floor, or a layout file, NAME.layout.yaml, instead of columns and
    rows; observation_type, reward_type and image_observation_layers may be members of RWARE's own
    enumerations.
    """

    shelf_columns: int = 3
    column_height: int = 8
    shelf_rows: int = 1
    n_agents: int = 2
    msg_bits: int = 0
    sensor_range: int = 1
    request_queue_size: int = 2
    max_inactivity_steps: int | None = None
    max_steps: int | None = 500
    reward_type: RewardType = RewardType.INDIVIDUAL
    layout: str | None = None
    observation_type: ObservationType = ObservationType.FLATTENED
    image_observation_layers: tuple = LAYERS
    image_observation_directional: bool = True
    normalised_coordinates: bool = False
    floor: Layout = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self.reward_type = _member(RewardType, self.reward_type)
        self.observation_type = _member(ObservationType, self.observation_type)
        self.image_observation_layers = tuple(
            _member(ImageLayer, layer) for layer in self.image_observation_layers
        )
        if self.layout:
            is_file = self.layout.endswith((".yaml", ".yml"))
            self.floor = of_file(self.layout) if is_file else of_text(self.layout)
        else:
            self.floor = of_parameters(self.shelf_columns, self.shelf_rows, self.column_height)

    @property
    def vector_size(self) -> int:
        """Numbers that an agent's vector has."""
        return 8 + self.sensor_cells * (7 + self.msg_bits)

    @property
    def sensor_cells(self) -> int:
        """Cells that an agent sees."""
        return (1 + 2 * self.sensor_range) ** 2

    @property
    def image_shape(self) -> tuple[int, ...]:
        """(layers, height, width) of an agent's picture."""
        width = 1 + 2 * self.sensor_range
        return len(self.image_observation_layers), width, width

    def warehouses(self, count: int, threads: int = 1) -> Rware:
        """Returns `count` warehouses of this task, whose episodes have not begun."""
        height, width = self.floor.grid_size
        walls = self.floor.walls
        return Rware(
            height=height,
            width=width,
            highway=self.floor.highways.ravel().tolist(),
            goals=[y * width + x for x, y in self.floor.goals],
            count=count,
            agents=self.n_agents,
            requests=self.request_queue_size,
            max_inactivity=self.max_inactivity_steps or 0,
            max_steps=self.max_steps or 0,
            reward=self.reward_type.value,
            range=self.sensor_range,
            bits=self.msg_bits,
            normalised=bool(self.normalised_coordinates),
            layers=[layer.value for layer in self.image_observation_layers],
            directional=bool(self.image_observation_directional),
            threads=threads,
            walls=[] if walls is None else walls.ravel().tolist(),
        )


def _member(kind: type[E], value: object) -> E:
    """The member of `kind` that has the value of `given`, which may be another's member."""
    return kind(getattr(value, "value", value))


def seed_of(number: int | None) -> tuple[Any, ...]:
    """Returns the arguments of Rware.seed for Gymnasium's stream of a seed; None: any seed."""
    state = np.random.PCG64(np.random.SeedSequence(number)).state
    numbers = (state["state"]["state"], state["state"]["inc"])
    words = [word for n in numbers for word in (n >> 64, n & (2**64 - 1))]
    return words, bool(state["has_uint32"]), state["uinteger"]
