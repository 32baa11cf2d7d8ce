# SPDX-License-Identifier: Apache-2.0
"""The Gymnasium spaces of RWARE."""

import numpy as np
from gymnasium import spaces

from warehouse_learning.rware.task import (
    FEATURES,
    Action,
    Direction,
    ImageLayer,
    ObservationType,
    Task,
)


def of_actions(task: Task) -> spaces.Space:
    """Returns the actions of an agent: which, and the bits of its message if there are any."""
    if not task.msg_bits:
        return spaces.Discrete(len(Action))
    return spaces.MultiDiscrete([len(Action), *task.msg_bits * (2,)])


def of_observations(task: Task) -> spaces.Space:
    """Returns the space of an agent's observations."""
    if task.observation_type is ObservationType.DICT:
        return _of_dictionaries(task)
    if task.observation_type is ObservationType.FLATTENED:
        return _unbounded(task.vector_size)
    image = _of_images(task)
    if task.observation_type is ObservationType.IMAGE:
        return image
    return spaces.Dict({"image": image, "features": _unbounded(FEATURES)})


def _unbounded(size: int) -> spaces.Box:
    return spaces.Box(-float("inf"), float("inf"), (size,), np.float32)


def _of_images(task: Task) -> spaces.Box:
    high = np.ones(task.image_shape, np.float32)
    for i, layer in enumerate(task.image_observation_layers):
        if layer is ImageLayer.AGENT_DIRECTION:
            high[i] = len(Direction)
    return spaces.Box(np.zeros_like(high), high, dtype=np.float32)


def _of_dictionaries(task: Task) -> spaces.Dict:
    highest, kind = (
        (1, np.float32)
        if task.normalised_coordinates
        else (
            max(task.floor.grid_size),
            np.int32,
        )
    )
    own = {
        "location": spaces.Box(np.zeros(2), np.full(2, highest, float), (2,), kind),
        "carrying_shelf": spaces.MultiBinary(1),
        "direction": spaces.Discrete(len(Direction)),
        "on_highway": spaces.MultiBinary(1),
    }
    cell = {"has_agent": spaces.MultiBinary(1), "direction": spaces.Discrete(len(Direction))}
    if task.msg_bits:
        cell["local_message"] = spaces.MultiBinary(task.msg_bits)
    cell |= {"has_shelf": spaces.MultiBinary(1), "shelf_requested": spaces.MultiBinary(1)}
    sensors = spaces.Tuple(task.sensor_cells * (spaces.Dict(cell),))
    return spaces.Dict({"self": spaces.Dict(own), "sensors": sensors})
