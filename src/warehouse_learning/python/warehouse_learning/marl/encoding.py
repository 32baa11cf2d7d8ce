# SPDX-License-Identifier: Apache-2.0
"""How observations enter a network."""

from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from warehouse_learning.rware.task import Task

KEPT = 2  # where a vector's part begins that is taken as it is: before it are column and row


class Encoding(Protocol):
    """Turns what robots observe into a network's inputs, `size` numbers a robot."""

    size: int

    def encode(self, observations: np.ndarray) -> np.ndarray:
        """Returns (…, agents, size) float32 of observations (…, agents, width)."""
        ...


class Unchanged:
    """Observations that a network takes as they are, `size` numbers a robot."""

    def __init__(self, size: int) -> None:
        self.size = size

    def encode(self, observations: np.ndarray) -> np.ndarray:
        """Returns the observations."""
        return observations


class Encoder:
    """RWARE's vectors on a floor of `width` x `height` cells with `agents` robots.

    A robot's column and row become one-hot, and which robot it is is added. Nothing is added that
    the robot does not observe.
    """

    def __init__(self, width: int, height: int, agents: int, vector_size: int) -> None:
        self.width, self.height, self.agents = width, height, agents
        self.size = vector_size - KEPT + width + height + agents
        self._columns = np.eye(width, dtype=np.float32)
        self._rows = np.eye(height, dtype=np.float32)
        self._ids = np.eye(agents, dtype=np.float32)

    @classmethod
    def of_task(cls, task: "Task") -> "Encoder":
        """Returns the encoder of a task's observations."""
        height, width = task.floor.grid_size
        return cls(width, height, task.n_agents, task.vector_size)

    def encode(self, observations: np.ndarray) -> np.ndarray:
        """Returns (…, agents, size) float32 of RWARE's (…, agents, vector_size)."""
        lead = observations.shape[:-1]
        out = np.empty((*lead, self.size), np.float32)
        at = observations.shape[-1] - KEPT
        out[..., :at] = observations[..., KEPT:]
        cells = observations[..., :KEPT].astype(np.intp)
        out[..., at : at + self.width] = self._columns[cells[..., 0]]
        at += self.width
        out[..., at : at + self.height] = self._rows[cells[..., 1]]
        out[..., at + self.height :] = self._ids
        return out
