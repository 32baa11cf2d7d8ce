# SPDX-License-Identifier: Apache-2.0
"""How long robots take without traffic, in closed form on a floor plan.

A run of n cells takes n * spacing / speed plus one start and stop (speed / acceleration); a quarter
turn takes its time, and a start and stop more.
"""

from collections import OrderedDict

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from warehouse_fleet.kinematics import Kinematics
from warehouse_layout.floor_plan import FloorPlan

HEADINGS = 4
TABLES = 400  # kept at most, the least recently used is dropped


class Table:
    """Routes from one cell to all others, or back: time [s] and length [m] by cell; or inf."""

    def __init__(
        self, seconds: np.ndarray, metres: np.ndarray, cells: np.ndarray, heading: np.ndarray
    ) -> None:
        self.seconds, self.metres = seconds, metres
        self._cells, self._heading = cells, heading

    def cells(self, cell: int) -> list[int]:
        """Returns the cells of the route between the table's own cell and another, with both."""
        node, way = cell * HEADINGS + self._heading[cell], [cell]
        while (node := self._cells[node]) >= 0:
            if node // HEADINGS != way[-1]:
                way.append(node // HEADINGS)
        return way


class Travel:
    """Times and lengths of routes on a FloorPlan."""

    def __init__(self, plan: FloorPlan, kinematics: Kinematics) -> None:
        self.plan, self.kinematics = plan, kinematics
        self.width = plan.passable.shape[1]
        self._keep_out = np.asarray(plan.storage | plan.parking, bool).ravel()
        edges = _edges(plan, self._keep_out)
        # Places in storage are ends of ways, never on the way.
        self._forward = _graph(plan, kinematics, edges, ~self._keep_out[edges[0]])
        self._backward = _graph(plan, kinematics, edges, ~self._keep_out[edges[2]]).T.tocsr()
        self._edges = edges
        self._tables: OrderedDict[tuple[int, bool], Table] = OrderedDict()

    def loaded_from(self, cell: int) -> Table:
        """Returns the routes of a loaded robot from a cell to all others."""
        return self._table(int(cell), True)

    def loaded_to(self, cell: int) -> Table:
        """Returns the routes of a loaded robot to a cell from all others."""
        return self._table(int(cell), False)

    def unloaded(self, cells: np.ndarray, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns time [s] and length [m] for robots without a load, which drive under the units.

        cells: (n,); to: (m,); both results: (n, m).
        """
        cells, to = np.asarray(cells)[:, None], np.asarray(to)[None, :]
        dx = np.abs(cells % self.width - to % self.width) * self.plan.spacing
        dy = np.abs(cells // self.width - to // self.width) * self.plan.spacing
        turns = 1.0 * ((dx > 0) | (dy > 0)) + ((dx > 0) & (dy > 0))  # to start, and at the corner
        run = self.kinematics.run
        return run(dx) + run(dy) + turns * self.kinematics.quarter_turn, dx + dy

    def _table(self, cell: int, forward: bool) -> Table:
        key = cell, forward
        if key in self._tables:
            self._tables.move_to_end(key)
            return self._tables[key]
        table = self._tables[key] = self._search(cell, self._graph_of(cell, forward))
        if len(self._tables) > TABLES:
            self._tables.popitem(last=False)
        return table

    def _graph_of(self, cell: int, forward: bool) -> csr_matrix:
        """Returns all routes from or to a cell; also out of its own storage place, or into it."""
        graph = self._forward if forward else self._backward
        if not self._keep_out[cell]:
            return graph
        own = self._edges[0 if forward else 2] == cell
        between = _graph(self.plan, self.kinematics, self._edges, own, turns=False)
        return graph + (between if forward else between.T.tocsr())

    def _search(self, cell: int, graph: csr_matrix) -> Table:
        start = cell * HEADINGS + np.arange(HEADINGS)
        seconds, before, _ = dijkstra(graph, indices=start, min_only=True, return_predecessors=True)
        metres = _lengths(before, self.plan.spacing)
        heading = np.argmin(seconds.reshape(-1, HEADINGS), axis=1)
        nodes = np.arange(len(heading)) * HEADINGS + heading
        # The start and stop of the first run; the turn into it.
        seconds = seconds[nodes] + self.kinematics.start_stop + self.kinematics.quarter_turn
        seconds[cell] = 0.0
        return Table(seconds, metres[nodes], before, heading)


def _edges(plan: FloorPlan, keep_out: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns cells, headings and next cells of all steps that a loaded robot may ever make."""
    following = np.asarray(plan.floor().edges(False)).reshape(-1, HEADINGS)
    lane = np.asarray(plan.lane, bool).ravel()
    cells, headings = np.nonzero(following >= 0)
    to = following[cells, headings]
    allowed = ~(keep_out[cells] & (keep_out[to] | lane[to])) & ~(lane[cells] & keep_out[to])
    return cells[allowed], headings[allowed], to[allowed]


def _graph(
    plan: FloorPlan,
    kinematics: Kinematics,
    edges: tuple[np.ndarray, ...],
    chosen: np.ndarray,
    turns: bool = True,
) -> csr_matrix:
    """Returns steps between (cell, heading) with their time [s], and turns on the spot."""
    cells, headings, to = (values[chosen] for values in edges)
    count = plan.passable.size * HEADINGS
    rows, columns = [cells * HEADINGS + headings], [to * HEADINGS + headings]
    weights = [np.full(len(cells), plan.spacing / kinematics.speed)]
    if turns:
        node = np.arange(count)
        rows += [node, node]
        columns += [_turned(node, 1), _turned(node, HEADINGS - 1)]
        weights += [np.full(2 * count, kinematics.quarter_turn + kinematics.start_stop)]
    joined = (np.concatenate(parts) for parts in (weights, rows, columns))
    weights, rows, columns = joined
    return csr_matrix((weights, (rows, columns)), (count, count))


def _turned(node: np.ndarray, quarters: int) -> np.ndarray:
    return node // HEADINGS * HEADINGS + (node + quarters) % HEADINGS


def _lengths(before: np.ndarray, spacing: float) -> np.ndarray:
    """Returns the metres along a tree of predecessors, by pointer doubling."""
    pointer = np.where(before < 0, np.arange(len(before)), before)
    length = np.where(pointer // HEADINGS == np.arange(len(before)) // HEADINGS, 0.0, spacing)
    while True:
        further = pointer[pointer]
        if np.array_equal(further, pointer):
            return length
        length, pointer = length + length[pointer], further
