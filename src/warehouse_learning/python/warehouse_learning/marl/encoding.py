# SPDX-License-Identifier: Apache-2.0
"""How RWARE's vectors enter a network: a robot's column and row one hot instead of as numbers, and
which robot it is. Nothing is added that the robot does not observe."""

import numpy as np

KEPT = 2  # where a vector's part begins that is taken as it is: before it are column and row


class Encoder:
    """The encoder for a floor of `width` x `height` cells and `agents` robots."""

    def __init__(self, width: int, height: int, agents: int, vector_size: int) -> None:
        self.width, self.height, self.agents = width, height, agents
        self.size = vector_size - KEPT + width + height + agents
        self._columns = np.eye(width, dtype=np.float32)
        self._rows = np.eye(height, dtype=np.float32)
        self._ids = np.eye(agents, dtype=np.float32)

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
