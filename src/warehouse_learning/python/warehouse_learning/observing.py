# SPDX-License-Identifier: Apache-2.0
"""What robots observe of their warehouses, as fields.py describes it."""

import numpy as np

from warehouse_learning import fields
from warehouse_learning.warehouses import Warehouses


class Observer:
    """Observes `warehouses`. Each call makes new arrays."""

    def __init__(self, warehouses: Warehouses) -> None:
        self._of = warehouses
        options, grid = warehouses.options, warehouses.grid
        self._rays = warehouses.worlds.scans().shape[2] if options.lasers else 0
        self.fields = fields.robot_fields(options, self._rays)
        self.state_fields = fields.state_fields(options)
        self._at = fields.slices(self.fields)
        self.size = sum(field.size for field in self.fields)
        self.state_size = sum(field.size for field in self.state_fields)
        share = grid.share_of(np.arange(grid.cells)).astype(np.float32)
        self._share = np.clip(share, 0, 1)
        self._one_hot = np.eye(4, dtype=np.float32)

    def observations(self) -> np.ndarray:
        """Returns (n, robots, size) float32."""
        see = self._of
        out = np.empty((see.n, see.robots, self.size), np.float32)
        see.task.observe(out)
        if see.options.continuous:
            self._motion(out, self._at)
        if self._rays:
            ranges = see.worlds.scans()
            out[..., self._at["laser"]] = np.clip(ranges / fields.LASER_RANGE, 0, 1)
        return out

    def state(self) -> np.ndarray:
        """Returns (n, state_size) float32: each warehouse as a whole."""
        see = self._of
        out = np.empty((see.n, self.state_size), np.float32)
        part = fields.slices(self.state_fields)
        rows = lambda values: values.reshape(see.n, -1)  # noqa: E731
        out[:, part["robot_position"]] = rows(self._share[see.cell])
        out[:, part["robot_heading"]] = rows(self._one_hot[see.heading])
        out[:, part["robot_load"]] = rows(self._load())
        out[:, part["robot_busy"]] = see.busy
        carried = see.unit_cell < 0
        cells = np.where(carried, 0, see.unit_cell)
        w, robot = np.nonzero(see.load >= 0)
        cells[w, see.load[w, robot]] = see.cell[w, robot]
        out[:, part["unit_position"]] = rows(self._share[cells])
        out[:, part["unit_requested"]] = see.requested
        out[:, part["unit_carried"]] = carried
        return out

    def _load(self) -> np.ndarray:
        see = self._of
        asked = see.requested[np.arange(see.n)[:, None], np.maximum(see.load, 0)]
        return self._one_hot[np.where(see.load < 0, 0, np.where(asked, 1, 2))][..., :3]

    def _motion(self, out: np.ndarray, at: dict[str, slice]) -> None:
        see, worlds = self._of, self._of.worlds
        x, y = see.grid.point_of(see.cell)
        off = np.stack([worlds.x - x, worlds.y - y], -1) / see.grid.spacing
        out[..., at["offset"]] = np.clip(_faced(off, see.heading), -1, 1)
        out[..., at["turned"]] = np.stack([np.sin(worlds.yaw), np.cos(worlds.yaw)], -1)
        wheels = np.stack([worlds.left_wheel_speed, worlds.right_wheel_speed], -1)
        out[..., at["wheels"]] = np.clip(wheels / see.top_wheel_speed, -1, 1)


def _faced(vectors: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """(…, 2) in world as a robot sees them: ahead and to the left."""
    c = np.array([1, 0, -1, 0])[heading]
    s = np.array([0, 1, 0, -1])[heading]
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x + s * y, c * y - s * x], -1)
