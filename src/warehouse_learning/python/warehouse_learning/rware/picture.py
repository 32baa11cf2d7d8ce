# SPDX-License-Identifier: Apache-2.0
"""A warehouse of RWARE as a picture."""

import numpy as np

from warehouse_learning._core import Rware
from warehouse_learning.rware.task import Direction, Task

CELL = 20  # [pixels]
FLOOR, LINE, WALL = (255, 255, 255), (214, 217, 222), (150, 155, 165)
SHELF, REQUESTED, GOAL = (72, 61, 139), (0, 128, 128), (60, 60, 60)
AGENT, LOADED, AHEAD = (255, 140, 0), (200, 30, 30), (0, 0, 0)
AHEAD_OF = {Direction.UP: (0, -1), Direction.DOWN: (0, 1), Direction.LEFT: (-1, 0)}


def picture(task: Task, warehouses: Rware, i: int) -> np.ndarray:
    """(height, width, 3) uint8 of warehouse i: goals grey, shelves blue, requested ones green,
    walls light grey, agents orange, with a load red; a black dot shows where an agent looks."""
    height, width = task.floor.grid_size
    image = np.full((height * CELL + 1, width * CELL + 1, 3), FLOOR, np.uint8)
    image[::CELL] = image[:, ::CELL] = LINE
    for y, x in np.argwhere(task.floor.walls) if task.floor.walls is not None else ():
        _fill(image, x, y, 0, WALL)
    for x, y in task.floor.goals:
        _fill(image, x, y, 1, GOAL)
    requested = set(warehouses.requests(i))
    for shelf, cell in enumerate(warehouses.shelves(i)):
        colour = REQUESTED if shelf in requested else SHELF
        _fill(image, cell % width, cell // width, 3, colour)
    for cell, direction, shelf, _ in warehouses.agents(i).tolist():
        x, y = cell % width, cell // width
        _fill(image, x, y, 5, AGENT if shelf < 0 else LOADED)
        dx, dy = AHEAD_OF.get(direction, (1, 0))
        _fill(image, x + 0.3 * dx, y + 0.3 * dy, 8, AHEAD)
    return image


def _fill(image: np.ndarray, x: float, y: float, margin: int, colour: tuple[int, int, int]) -> None:
    left, top = round(x * CELL), round(y * CELL)
    end = CELL - margin + 1
    image[top + margin : top + end, left + margin : left + end] = colour
