# SPDX-License-Identifier: Apache-2.0
"""A planner to learn from: each robot in turn drives along x, then along y, and gives way to all
who came before it in the list. Safe, but robots that meet head on stay there for ever. Named in a
YAML file, with this folder in PYTHONPATH:

    planner: right_of_way:RightOfWay
"""

import numpy as np


class RightOfWay:
    def start(self, floor, rules, seed):
        self.width, self.edges = floor.width, floor.edges()

    def plan(self, fleet):
        """The cell that each robot goes to next."""
        goal = np.where(fleet.goal < 0, fleet.cell, fleet.goal)
        x = np.sign(goal % self.width - fleet.cell % self.width)
        y = np.sign(goal // self.width - fleet.cell // self.width)
        wanted = fleet.cell + np.where(x != 0, x, y * self.width)
        taken = set(fleet.cell.tolist()) | set(fleet.closed.tolist())
        cells = fleet.cell.copy()
        for robot, cell in enumerate(wanted):
            if cell not in taken and cell in self.edges[fleet.cell[robot]]:
                cells[robot] = cell
                taken.add(int(cell))
        return cells
