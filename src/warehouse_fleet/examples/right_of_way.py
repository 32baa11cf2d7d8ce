# SPDX-License-Identifier: Apache-2.0
"""A planner to learn from: each robot in turn takes the shortest way that is left to it, and gives
way to all who came before it in the list. Safe, but robots that meet head on stay there for ever.
Named in a YAML file, with this folder in PYTHONPATH:

    planner: right_of_way:RightOfWay
"""

import functools

import numpy as np


class RightOfWay:
    def start(self, floor, rules, seed):
        # By cell and heading: the cell before one there, -1 for none. Loaded robots keep to aisles.
        self.edges = {loaded: floor.edges(loaded) for loaded in (False, True)}
        self.distances = functools.lru_cache(maxsize=2000)(self._distances)

    def plan(self, fleet):
        """The cell that each robot goes to next."""
        taken = set(fleet.cell.tolist()) | set(fleet.closed.tolist())
        cells = fleet.cell.copy()
        for robot in np.flatnonzero(fleet.goal >= 0):
            here, goal = int(fleet.cell[robot]), int(fleet.goal[robot])
            ways, far = self.distances(goal, bool(fleet.loaded.size and fleet.loaded[robot]))
            options = [c for c in ways[here].tolist() if c >= 0 and c not in taken]
            nearest = min(options, key=lambda c: far[c], default=here)
            if far[nearest] < far[here]:
                cells[robot] = nearest
                taken.add(nearest)
        return cells

    def _distances(self, goal, loaded):
        """Its edges, and how many cells it is from each to the goal. A goal may be a storage place,
        which aisles don't lead into."""
        ways = np.where(self.edges[False] == goal, goal, self.edges[loaded])
        far = np.full(len(ways) + 1, np.inf)  # the last one stands for -1
        far[goal], before = 0, None
        while not np.array_equal(before, far):
            before = far.copy()
            far[:-1] = np.minimum(far[:-1], far[ways].min(axis=1) + 1)
        return ways, far
