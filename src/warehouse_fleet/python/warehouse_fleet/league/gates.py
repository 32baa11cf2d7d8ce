# SPDX-License-Identifier: Apache-2.0
"""How many robots a map lets drive at a time: as many as fill its narrowest gate.

A gate is made of the cells at one distance from a source that lead to the same cells beyond. If a
share f of the errands lies there, 2 f (1 - f) of the ways from one errand to the next lead through
the gate, and at most one robot a tick does so in each of its cells. A robot is on its way for at
least as many ticks as the way has cells. Little's law gives the number of robots on their way: the
ways begun a tick, times the ticks of one. More robots gather before the gate, on both sides, until
none gets through.
"""

import math
from collections import Counter
from itertools import groupby

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from warehouse_fleet._core import PURSUING
from warehouse_fleet.league.problem import Problem
from warehouse_fleet.league.steps import steps_between

SOURCES = 4  # from which gates are looked for
UNREACHED = -1  # the distance of what no robot reaches
SHARE = 0.7  # of the robots that fill a gate: as many get through for thousands of ticks


def pursuing(problem: Problem) -> float:
    """Returns the planner's option `pursuing`: its default, or less if a gate demands it."""
    most = SHARE * filling(problem)
    return min(PURSUING, most / np.count_nonzero(problem.passable))


def filling(problem: Problem) -> float:
    """Returns how many robots on their way fill the narrowest gate; infinity without gates."""
    number = np.cumsum(problem.passable).reshape(-1) - 1  # by location: among the passable ones
    goals = number[np.concatenate(problem.tasks)]
    share = np.bincount(goals, minlength=number[-1] + 1) / len(goals)
    steps = steps_between(problem.passable)
    graph = steps + steps.T
    sources = np.random.default_rng(0).choice(goals, SOURCES)
    ways, flow = [], math.inf
    for cells in dijkstra(graph, unweighted=True, indices=sources):
        reached = np.isfinite(cells)
        distance = np.where(reached, cells, UNREACHED).astype(int)
        part = np.where(reached, share, 0)  # of the errands; all others are elsewhere
        part /= part.sum()
        ways.append((distance * part).sum())
        flow = min(flow, _flow(graph, distance, part) / share[reached].sum())
    return flow if math.isinf(flow) else float(np.mean(ways) * flow)


def _flow(graph: csr_matrix, distance: NDArray[np.int64], share: NDArray[np.float64]) -> float:
    """Returns how many ways a tick the gates around the source of these distances allow.

    graph: the steps in both directions. distance, share, (cells,): from the source, and of the
    errands. Cells are joined from the farthest on, so that those beyond a gate are together when it
    is reached.
    """
    beyond = _Sets(share.tolist())
    least = math.inf
    order = np.argsort(-distance, kind="stable")
    order = order[distance[order] > 0].tolist()
    for level, cells in groupby(order, key=distance.tolist().__getitem__):
        gate = list(cells)
        for cell in gate:
            for other in graph.indices[graph.indptr[cell] : graph.indptr[cell + 1]].tolist():
                if distance[other] >= level:
                    beyond.join(cell, other)
        for root, width in Counter(map(beyond.root, gate)).items():
            crossing = 2 * beyond.share[root] * (1 - beyond.share[root])
            if crossing > 0:
                least = min(least, width / crossing)
    return least


class _Sets:
    """Disjoint sets of cells, each with its share of the errands."""

    def __init__(self, share: list[float]) -> None:
        self.share = share  # of a set, at its root
        self._parent = list(range(len(share)))

    def root(self, cell: int) -> int:
        """Returns the cell that stands for the set of this one."""
        parent = self._parent
        while parent[cell] != cell:
            parent[cell] = parent[parent[cell]]
            cell = parent[cell]
        return cell

    def join(self, cell: int, other: int) -> None:
        """Makes one set of the two that these cells are in."""
        cell, other = self.root(cell), self.root(other)
        if cell != other:
            self._parent[cell] = other
            self.share[other] += self.share[cell]
