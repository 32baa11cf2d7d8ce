# SPDX-License-Identifier: Apache-2.0
"""Which robot drives which transport."""

import numpy as np
from scipy.optimize import linear_sum_assignment


class Nearest:
    """In the tasks' order, each the robot that is there first."""

    def match(self, tasks, robots, seconds, view):
        return _in_order(range(len(tasks)), seconds)


class Balanced:
    """Stations with the fewest units on the way come first."""

    def match(self, tasks, robots, seconds, view):
        ahead = {}

        def key(i):
            return -tasks[i].priority, ahead[i], i

        waiting = {}
        for task in tasks:
            waiting[task.station] = waiting.get(task.station, 0) + 1
        for i, task in enumerate(tasks):
            # Those that no robot fetches yet are not on the way.
            ahead[i] = task.inbound - waiting[task.station]
            waiting[task.station] -= 1
        return _in_order(sorted(ahead, key=key), seconds)


class Optimal:
    """The least time in all, by the Hungarian method; the first tasks, if robots are few."""

    def match(self, tasks, robots, seconds, view):
        count = min(len(tasks), len(robots))
        return list(zip(*linear_sum_assignment(np.asarray(seconds)[:count])))


def _in_order(order, seconds):
    seconds = np.array(seconds)
    for task in list(order)[: seconds.shape[1]]:
        robot = int(np.argmin(seconds[task]))
        seconds[:, robot] = np.inf
        yield task, robot


NAMES = {"nearest": Nearest, "balanced": Balanced, "optimal": Optimal}
