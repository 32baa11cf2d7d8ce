# SPDX-License-Identifier: Apache-2.0
"""Policies that match robots to transports."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import linear_sum_assignment

from warehouse_operations.stock.protocols import Task

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View


class Nearest:
    """Matches each task, in their order, to the robot that arrives first."""

    def match(
        self, tasks: Sequence[Task], robots: Sequence[int], seconds: np.ndarray, view: "View"
    ) -> Iterable[tuple[int, int]]:
        """Returns pairs (index of the task, index of the robot); seconds: (tasks, robots)."""
        return _in_order(range(len(tasks)), seconds)


class Balanced:
    """Matches tasks of stations with the fewest units on the way first."""

    def match(
        self, tasks: Sequence[Task], robots: Sequence[int], seconds: np.ndarray, view: "View"
    ) -> Iterable[tuple[int, int]]:
        """Returns pairs (index of the task, index of the robot); seconds: (tasks, robots)."""
        ahead: dict[int, int] = {}

        def key(i: int) -> tuple[int, int, int]:
            return -tasks[i].priority, ahead[i], i

        waiting: dict[str, int] = {}
        for task in tasks:
            waiting[task.station] = waiting.get(task.station, 0) + 1
        for i, task in enumerate(tasks):
            # Tasks without a robot are not on the way.
            ahead[i] = task.inbound - waiting[task.station]
            waiting[task.station] -= 1
        return _in_order(sorted(ahead, key=key), seconds)


class Optimal:
    """Minimises the sum of the times, by the Hungarian method.

    Only the first tasks are matched if there are fewer robots.
    """

    def match(
        self, tasks: Sequence[Task], robots: Sequence[int], seconds: np.ndarray, view: "View"
    ) -> Iterable[tuple[int, int]]:
        """Returns pairs (index of the task, index of the robot); seconds: (tasks, robots)."""
        count = min(len(tasks), len(robots))
        return list(zip(*linear_sum_assignment(np.asarray(seconds)[:count])))


def _in_order(order: Iterable[int], seconds: np.ndarray) -> Iterator[tuple[int, int]]:
    seconds = np.array(seconds)
    for task in list(order)[: seconds.shape[1]]:
        robot = int(np.argmin(seconds[task]))
        seconds[:, robot] = np.inf
        yield task, robot


NAMES: dict[str, type] = {"nearest": Nearest, "balanced": Balanced, "optimal": Optimal}
