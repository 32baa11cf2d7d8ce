# SPDX-License-Identifier: Apache-2.0
"""What agents observe, read out of the warehouses."""

from typing import Any

import numpy as np

from warehouse_learning._core import Rware
from warehouse_learning.rware.task import FEATURES, ObservationType, Task


class Observer:
    """Reads observations of `count` warehouses of a Task.

    arrays(): new arrays, (count, agents, …) float32: one, or with IMAGE_DICT `image`, `features`.
    """

    def __init__(self, task: Task, warehouses: Rware, count: int) -> None:
        self._task, self._warehouses = task, warehouses
        lead = count, task.n_agents
        self._vector_shape = *lead, task.vector_size
        self._image_shape = *lead, *task.image_shape
        self._feature_shape = *lead, FEATURES
        self.arrays = {
            ObservationType.DICT: self._vectors,
            ObservationType.FLATTENED: self._vectors,
            ObservationType.IMAGE: self._images,
            ObservationType.IMAGE_DICT: self._images_and_features,
        }[task.observation_type]
        self._are_plain = task.observation_type in (
            ObservationType.FLATTENED,
            ObservationType.IMAGE,
        )

    def of_first(self) -> tuple[Any, ...]:
        """Returns what each agent of the first warehouse observes, as RWARE gives it."""
        arrays = self.arrays()
        if self._are_plain:
            return tuple(arrays[0])
        if self._task.observation_type is ObservationType.DICT:
            return tuple(_dictionary(vector, self._task) for vector in arrays[0])
        pairs = zip(arrays["image"][0], arrays["features"][0])
        return tuple({"image": image, "features": features} for image, features in pairs)

    def _vectors(self) -> np.ndarray:
        vectors = np.empty(self._vector_shape, np.float32)
        self._warehouses.vectors(vectors)
        return vectors

    def _images(self) -> np.ndarray:
        images = np.empty(self._image_shape, np.float32)
        self._warehouses.images(images)
        return images

    def _images_and_features(self) -> dict[str, np.ndarray]:
        features = np.empty(self._feature_shape, np.float32)
        self._warehouses.features(features)
        return {"image": self._images(), "features": features}


def _dictionary(vector: np.ndarray, task: Task) -> dict[str, Any]:
    """RWARE's dictionary of an agent, from its vector."""
    cells = vector[8:].reshape(task.sensor_cells, -1)
    return {
        "self": {
            "location": vector[:2].astype(np.int32),
            "carrying_shelf": [int(vector[2])],
            "direction": int(vector[3:7].argmax()),
            "on_highway": [int(vector[7])],
        },
        "sensors": tuple(_of_cell(cell, task.msg_bits) for cell in cells),
    }


def _of_cell(cell: np.ndarray, bits: int) -> dict[str, Any]:
    has_agent = int(cell[0])
    return {
        "has_agent": [has_agent],
        "direction": int(cell[1:5].argmax()),
        "local_message": _message(has_agent, cell[5 : 5 + bits]) if bits else None,
        "has_shelf": [int(cell[-2])],
        "shelf_requested": [int(cell[-1])],
    }


def _message(has_agent: int, bits: np.ndarray) -> np.ndarray | list[int]:
    return bits.astype(float) if has_agent else len(bits) * [0]
