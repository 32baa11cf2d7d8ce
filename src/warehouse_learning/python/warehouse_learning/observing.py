# SPDX-License-Identifier: Apache-2.0
"""What robots observe of their warehouses, as fields.py describes it."""

import numpy as np

from warehouse_learning import fields
from warehouse_learning.grid import FAR

BLOCKED, STORAGE, STATION, UNIT, REQUESTED, ROBOT, LOADED = (1 << i for i in range(7))


class Observer:
    """Of `warehouses`. Each call makes new arrays."""

    def __init__(self, warehouses):
        self._of = warehouses
        options, grid = warehouses.options, warehouses.grid
        self._rays = warehouses.worlds.scans().shape[2] if options.lasers else 0
        self.fields = fields.robot_fields(options, self._rays)
        self.state_fields = fields.state_fields(options)
        self._at = fields.slices(self.fields)
        self.size = sum(one.size for one in self.fields)
        self.state_size = sum(one.size for one in self.state_fields)
        static = np.where(grid.passable, 0, BLOCKED) | np.where(grid.storage, STORAGE, 0)
        self._static = (static | np.where(grid.is_station, STATION, 0)).astype(np.uint8)
        self._around = _around(grid, options.radius)
        self._share = grid.share_of(np.arange(grid.cells)).astype(np.float32)
        self._one_hot = np.eye(4, dtype=np.float32)
        self._bits = np.unpackbits(
            np.arange(256, dtype=np.uint8)[:, None], axis=1, bitorder="little"
        )[:, : len(fields.LAYERS)].astype(np.float32)

    def observations(self):
        """(n, robots, size) float32."""
        see, at = self._of, self._at
        out = np.empty((see.n, see.robots, self.size), np.float32)
        self._own(out, at)
        self._goal(out, at)
        around = self._around[see.heading] + see.cell[..., None]
        layers = self._layers()[np.arange(see.n)[:, None, None], around]
        out[..., at["neighbourhood"]] = self._bits[layers].reshape(see.n, see.robots, -1)
        if see.options.continuous:
            self._motion(out, at)
        if self._rays:
            ranges = see.worlds.scans()
            out[..., at["laser"]] = np.clip(ranges / fields.LASER_RANGE, 0, 1)
        return out

    def state(self):
        """(n, state_size) float32: of each warehouse as a whole."""
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
        out[:, part["unit_position"]] = rows(np.clip(self._share[cells], 0, 1))
        out[:, part["unit_requested"]] = see.requested
        out[:, part["unit_carried"]] = carried
        return out

    def _own(self, out, at):
        see = self._of
        out[..., at["position"]] = np.clip(self._share[see.cell], 0, 1)
        out[..., at["heading"]] = self._one_hot[see.heading]
        out[..., at["load"]] = self._load()
        out[..., at["busy"]] = see.busy[..., None]

    def _load(self):
        see = self._of
        asked = see.requested[np.arange(see.n)[:, None], np.maximum(see.load, 0)]
        return self._one_hot[np.where(see.load < 0, 0, np.where(asked, 1, 2))][..., :3]

    def _goal(self, out, at):
        see, grid = self._of, self._of.grid
        goals = see.goals
        row, column = np.divmod(goals.cell, grid.width)
        own_row, own_column = np.divmod(see.cell, grid.width)
        way = np.stack([column - own_column, row - own_row], -1) / grid.longest
        out[..., at["goal"]] = np.clip(_faced(way, see.heading), -1, 1)
        far = grid.far
        here = goals.distance()
        out[..., at["distance"]] = np.minimum(here / (2 * grid.longest), 1)[..., None]
        # Ahead, left, behind, right.
        headings = (see.heading[..., None] + np.arange(4)) % 4
        next_ = far[goals.row[..., None], see.cell[..., None] + grid.steps[headings]]
        nearer = np.where(next_ == FAR, -1, np.clip(here[..., None] - next_, -1, 1))
        nearer[goals.row == grid.nowhere] = 0
        out[..., at["way"]] = nearer

    def _layers(self):
        """(n, cells) bits."""
        see = self._of
        out = np.repeat(self._static[None], see.n, axis=0)
        w, unit = np.nonzero(see.unit_cell >= 0)
        bits = np.where(see.requested[w, unit], UNIT | REQUESTED, UNIT).astype(np.uint8)
        out[w, see.unit_cell[w, unit]] |= bits
        rows = np.arange(see.n)[:, None]
        robots = np.where(see.load >= 0, ROBOT | LOADED, ROBOT).astype(np.uint8)
        out[rows, see.cell] |= robots
        return out

    def _motion(self, out, at):
        see, worlds = self._of, self._of.worlds
        x, y = see.grid.point_of(see.cell)
        off = np.stack([worlds.x - x, worlds.y - y], -1) / see.grid.spacing
        out[..., at["offset"]] = np.clip(_faced(off, see.heading), -1, 1)
        out[..., at["turned"]] = np.stack([np.sin(worlds.yaw), np.cos(worlds.yaw)], -1)
        wheels = np.stack([worlds.left_wheel_speed, worlds.right_wheel_speed], -1)
        out[..., at["wheels"]] = np.clip(wheels / see.top_wheel_speed, -1, 1)


def _faced(vectors, heading):
    """(…, 2) in world as a robot sees them: ahead and to the left."""
    c = np.array([1, 0, -1, 0])[heading]
    s = np.array([0, 1, 0, -1])[heading]
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x + s * y, c * y - s * x], -1)


def _around(grid, radius):
    """(4, cells of the neighbourhood): what to add to a robot's cell, by heading."""
    reach = np.arange(-radius, radius + 1)
    ahead, left = (axis.ravel() for axis in np.meshgrid(reach, reach, indexing="ij"))
    # Heading h: ahead is steps[h], left is steps[h + 1].
    return np.stack(
        [ahead * grid.steps[h] + left * grid.steps[(h + 1) % 4] for h in range(4)]
    ).astype(np.int32)
