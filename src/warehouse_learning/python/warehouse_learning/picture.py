# SPDX-License-Identifier: Apache-2.0
"""A warehouse from above as pixels, by numpy alone: hundreds of frames a second, for films of
episodes. For print there is warehouse_sim's renderer, which takes a running warehouse's messages.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

PIXELS = 24  # an edge of a cell, if that gives no more than MOST
MOST = 1200  # an edge of the picture
FLOOR, WALL, LINE = (214, 216, 222), (96, 100, 108), (196, 198, 206)
STORAGE, STATION = (198, 206, 224), (150, 205, 150)
UNIT, REQUESTED, LEGS = (214, 178, 92), (206, 70, 62), (90, 96, 108)
ROBOT, BUSY, FRONT = (242, 120, 30), (60, 120, 216), (255, 255, 255)
UNIT_EDGE, ROBOT_LENGTH, ROBOT_WIDTH = 0.8, 0.76, 0.64  # [m]


class Picture:
    """Draws one of the `warehouses`."""

    def __init__(self, warehouses: Any, world: int = 0) -> None:
        self._of, self._world = warehouses, world
        grid = warehouses.grid
        rows, columns = grid.height - 2 * grid.rim, grid.width - 2 * grid.rim
        self._scale = max(4, min(PIXELS, MOST // max(rows, columns)))
        colours = np.full((grid.cells, 3), WALL, np.uint8)
        colours[grid.passable] = FLOOR
        colours[grid.storage] = STORAGE
        colours[grid.stations] = STATION
        inside = colours.reshape(grid.height, grid.width, 3)
        inside = inside[grid.rim : grid.rim + rows, grid.rim : grid.rim + columns]
        back = inside.repeat(self._scale, 0).repeat(self._scale, 1)
        back[:: self._scale] = back[:, :: self._scale] = LINE
        self._back = back
        first = grid.rim * grid.width + grid.rim
        x, y = grid.point_of(first)
        self._corner = np.array([x, y]) - grid.spacing / 2  # of the picture, in world [m]
        self._metre = self._scale / grid.spacing

    @property
    def shape(self) -> tuple[int, ...]:
        """(height, width, 3) of the picture."""
        return self._back.shape

    def draw(self) -> np.ndarray:
        """Returns the picture, (height, width, 3) uint8; y goes up."""
        see, w = self._of, self._world
        canvas = self._back.copy()
        rows = see.worlds[w].storage_units
        standing = rows["kiva_id"] == 0
        asked = see.requested[w]
        for i in np.flatnonzero(standing):
            self._unit(canvas, rows[i], asked[i])
        for robot in range(see.robots):
            self._robot(canvas, robot)
        for i in np.flatnonzero(~standing):
            self._unit(canvas, rows[i], asked[i])
        return np.ascontiguousarray(canvas[::-1])

    def _unit(self, canvas: np.ndarray, row: np.void, asked: bool) -> None:
        at, yaw = (row["x"], row["y"]), row["yaw"]
        self._box(canvas, at, yaw, UNIT_EDGE, UNIT_EDGE, REQUESTED if asked else UNIT)
        # Robots show beneath.
        if row["kiva_id"] == 0:
            self._box(canvas, at, yaw, 0.6 * UNIT_EDGE, 0.6 * UNIT_EDGE, STORAGE)
        else:
            self._box(canvas, at, yaw, 0.4 * UNIT_EDGE, 0.4 * UNIT_EDGE, BUSY)

    def _robot(self, canvas: np.ndarray, robot: int) -> None:
        w = self._world
        fleet = self._of.worlds[w].fleet
        at, yaw = np.array([fleet.x[robot], fleet.y[robot]]), fleet.yaw[robot]
        ahead = np.array([np.cos(yaw), np.sin(yaw)])
        colour = BUSY if self._of.busy[w, robot] else ROBOT
        self._box(canvas, at, yaw, ROBOT_LENGTH, ROBOT_WIDTH, LEGS)
        self._box(canvas, at, yaw, ROBOT_LENGTH - 0.1, ROBOT_WIDTH - 0.1, colour)
        self._box(canvas, at + 0.26 * ahead, yaw, 0.12, 0.36, FRONT)

    def _box(
        self,
        canvas: np.ndarray,
        at: ArrayLike,
        yaw: float,
        length: float,
        width: float,
        colour: tuple[int, int, int],
    ) -> None:
        """A filled rectangle around a place in world, in the picture before it is turned up."""
        centre = (np.asarray(at) - self._corner) * self._metre
        reach = np.hypot(length, width) / 2 * self._metre
        (x0, y0), (x1, y1) = np.floor(centre - reach), np.ceil(centre + reach)
        x0, y0 = max(int(x0), 0), max(int(y0), 0)
        x1, y1 = min(int(x1), canvas.shape[1]), min(int(y1), canvas.shape[0])
        if x0 >= x1 or y0 >= y1:
            return
        dx = np.arange(x0, x1) + 0.5 - centre[0]
        dy = (np.arange(y0, y1) + 0.5 - centre[1])[:, None]
        c, s = np.cos(yaw), np.sin(yaw)
        inside = np.abs(c * dx + s * dy) <= length / 2 * self._metre
        inside &= np.abs(c * dy - s * dx) <= width / 2 * self._metre
        canvas[y0:y1, x0:x1][inside] = colour
