# SPDX-License-Identifier: Apache-2.0
"""What a robot observes, field by field."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from warehouse_learning.options import Options

LAYERS = ("blocked", "storage", "station", "unit", "requested", "robot", "loaded")
LASER_RANGE = 5.0  # [m]


@dataclass(frozen=True)
class Field:
    """Some of the numbers of an observation."""

    name: str
    shape: tuple
    low: float
    high: float
    unit: str
    text: str

    @property
    def size(self) -> int:
        """How many numbers it takes."""
        return int(np.prod(self.shape))


def robot_fields(options: Options, rays: int = 0) -> list[Field]:
    """Returns the Fields of one robot's observation, in order."""
    edge = 2 * options.radius + 1
    fields = [
        Field("position", (2,), 0, 1, "floor", "column and row of its cell; 1 is the last one"),
        Field("heading", (4,), 0, 1, "", "one-hot: +x, +y, -x, -y in world"),
        Field("load", (3,), 0, 1, "", "one-hot: none, a requested unit, another unit"),
        Field("busy", (1,), 0, 1, "", "1: it is still at an action, and another one is not heard"),
        Field(
            "goal", (2,), -1, 1, "floor", "its goal, ahead and to the left; 1 is the floor's edge"
        ),
        Field("distance", (1,), 0, 1, "floor", "the way to its goal; 1 is twice the floor's edge"),
        Field(
            "way", (4,), -1, 1, "cells", "how much nearer the cells ahead, left, behind, right are"
        ),
        Field(
            "neighbourhood",
            (edge, edge, len(LAYERS)),
            0,
            1,
            "",
            "cells around it as it faces them, from behind right to ahead left (first axis ahead, "
            "second to the left); layers: " + ", ".join(LAYERS),
        ),
    ]
    if options.continuous:
        fields.append(
            Field("offset", (2,), -1, 1, "cells", "from its cell's centre, ahead and to the left")
        )
        fields.append(Field("turned", (2,), -1, 1, "", "sine and cosine of its heading in world"))
        fields.append(Field("wheels", (2,), -1, 1, "top speed", "left and right wheel's speeds"))
    if rays:
        fields.append(
            Field("laser", (rays,), 0, 1, f"{LASER_RANGE:g} m", "ranges, from right to left")
        )
    return fields


def state_fields(options: Options) -> list[Field]:
    """Returns the Fields of the whole warehouse's state."""
    return [
        Field("robot_position", (options.robots, 2), 0, 1, "floor", "as position"),
        Field("robot_heading", (options.robots, 4), 0, 1, "", "as heading"),
        Field("robot_load", (options.robots, 3), 0, 1, "", "as load"),
        Field("robot_busy", (options.robots, 1), 0, 1, "", "as busy"),
        Field(
            "unit_position", (options.shelves, 2), 0, 1, "floor", "of storage units; as position"
        ),
        Field("unit_requested", (options.shelves,), 0, 1, "", "1: it is asked for"),
        Field("unit_carried", (options.shelves,), 0, 1, "", "1: a robot carries it"),
    ]


def slices(fields: Iterable[Field]) -> dict[str, slice]:
    """Returns {name: slice} of each in the row of numbers."""
    out, at = {}, 0
    for field in fields:
        out[field.name] = slice(at, at + field.size)
        at += field.size
    return out


def bounds(fields: Iterable[Field]) -> tuple[np.ndarray, np.ndarray]:
    """Returns (low, high), each (size,) float32."""
    low = np.concatenate([np.full(field.size, field.low, np.float32) for field in fields])
    high = np.concatenate([np.full(field.size, field.high, np.float32) for field in fields])
    return low, high


def split(observation: np.ndarray, fields: Iterable[Field]) -> dict[str, np.ndarray]:
    """Returns {name: array of the field's shape} of one observation or of many, (…, size)."""
    observation = np.asarray(observation)
    return {
        field.name: observation[..., part].reshape(observation.shape[:-1] + field.shape)
        for field, part in zip(fields, slices(fields).values())
    }
