# SPDX-License-Identifier: Apache-2.0
"""Where a coordinated fleet drives, of a CoordinatorPaths, as line segments (n, 2, 2) [m]."""

from collections.abc import Mapping

import numpy as np

from warehouse_msgs.msg import CoordinatorPaths

DASH = np.array([[0.3], [0.7]])  # of each step that is planned


def released_and_planned(message: CoordinatorPaths) -> tuple[np.ndarray, np.ndarray]:
    """Returns the released segments, and a dash for each step planned beyond."""
    xy = np.column_stack([message.x, message.y]).reshape(-1, 2)
    released = np.array(message.released, int)
    points = released + np.array(message.planned, int)
    robot = np.repeat(np.arange(len(points)), points)
    place = np.arange(len(xy)) - np.repeat(np.cumsum(points) - points, points)
    steps = np.stack([xy[:-1], xy[1:]], axis=1)
    is_step = (robot[1:] == robot[:-1]) & (steps[:, 0] != steps[:, 1]).any(axis=1)
    is_released = place[1:] < released[robot[1:]]
    begin, end = np.split(steps[is_step & ~is_released], 2, axis=1)
    return steps[is_step & is_released], begin + DASH * (end - begin)


def ties(message: CoordinatorPaths, where: Mapping[int, tuple[float, float]]) -> np.ndarray:
    """Returns a segment from each waiting robot to the one in its way; `where` is (x, y) by id."""
    pairs = [
        (where[robot], where[other])
        for robot, other in zip(message.kiva_id, message.waits_for)
        if robot in where and other in where
    ]
    return np.reshape(pairs, (-1, 2, 2))
