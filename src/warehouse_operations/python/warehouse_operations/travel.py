# SPDX-License-Identifier: Apache-2.0
"""How long robots take without traffic, in closed form on a floor plan.

A run of n cells takes n * spacing / speed plus one start and stop (speed / acceleration); a quarter
turn takes its time, and a start and stop more.
"""

from collections import OrderedDict

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

HEADINGS = 4
TABLES = 400  # kept at most, the least recently used is dropped


class Table:
    """From one cell to all others, or back: time [s] and length [m] by cell; inf: no way."""

    def __init__(self, seconds, metres, cells, heading):
        self.seconds, self.metres = seconds, metres
        self._cells, self._heading = cells, heading

    def cells(self, cell):
        """The cells on the way between the table's own cell and another one, both included."""
        node, way = cell * HEADINGS + self._heading[cell], [cell]
        while (node := self._cells[node]) >= 0:
            if node // HEADINGS != way[-1]:
                way.append(node // HEADINGS)
        return way


class Travel:
    """Times and lengths of ways on a FloorPlan."""

    def __init__(self, plan, kinematics):
        self.plan, self.kinematics = plan, kinematics
        self.width = plan.passable.shape[1]
        self._keep_out = np.asarray(plan.storage | plan.parking, bool).ravel()
        edges = _edges(plan, self._keep_out)
        # Places in storage are ends of ways, never on the way.
        self._forward = _graph(plan, kinematics, edges, ~self._keep_out[edges[0]])
        self._backward = _graph(plan, kinematics, edges, ~self._keep_out[edges[2]]).T.tocsr()
        self._edges = edges
        self._tables = OrderedDict()

    def loaded_from(self, cell):
        """The Table of ways of a loaded robot from a cell to all others."""
        return self._table(int(cell), True)

    def loaded_to(self, cell):
        """The Table of ways of a loaded robot to a cell from all others."""
        return self._table(int(cell), False)

    def unloaded(self, cells, to):
        """Time [s] and length [m] for robots without a load, which drive beneath the units.

        cells (n,) and to (m,): arrays of shape (n, m).
        """
        cells, to = np.asarray(cells)[:, None], np.asarray(to)[None, :]
        dx = np.abs(cells % self.width - to % self.width) * self.plan.spacing
        dy = np.abs(cells // self.width - to // self.width) * self.plan.spacing
        turns = 1.0 * ((dx > 0) | (dy > 0)) + ((dx > 0) & (dy > 0))  # to start, and at the corner
        run = self.kinematics.run
        return run(dx) + run(dy) + turns * self.kinematics.quarter_turn, dx + dy

    def _table(self, cell, forward):
        key = cell, forward
        if key in self._tables:
            self._tables.move_to_end(key)
            return self._tables[key]
        table = self._tables[key] = self._search(cell, self._graph_of(cell, forward))
        if len(self._tables) > TABLES:
            self._tables.popitem(last=False)
        return table

    def _graph_of(self, cell, forward):
        """All ways from a cell, or to it; out of its own storage place too, or into it."""
        graph = self._forward if forward else self._backward
        if not self._keep_out[cell]:
            return graph
        own = self._edges[0 if forward else 2] == cell
        between = _graph(self.plan, self.kinematics, self._edges, own, turns=False)
        return graph + (between if forward else between.T.tocsr())

    def _search(self, cell, graph):
        start = cell * HEADINGS + np.arange(HEADINGS)
        seconds, before, _ = dijkstra(graph, indices=start, min_only=True, return_predecessors=True)
        metres = _lengths(before, self.plan.spacing)
        heading = np.argmin(seconds.reshape(-1, HEADINGS), axis=1)
        nodes = np.arange(len(heading)) * HEADINGS + heading
        # The start and stop of the first run; the turn into it.
        seconds = seconds[nodes] + self.kinematics.start_stop + self.kinematics.quarter_turn
        seconds[cell] = 0.0
        return Table(seconds, metres[nodes], before, heading)


def _edges(plan, keep_out):
    """Cells, headings and next cells of all steps that a loaded robot may ever make."""
    following = np.asarray(plan.floor().edges(False)).reshape(-1, HEADINGS)
    lane = np.asarray(plan.lane, bool).ravel()
    cells, headings = np.nonzero(following >= 0)
    to = following[cells, headings]
    allowed = ~(keep_out[cells] & (keep_out[to] | lane[to])) & ~(lane[cells] & keep_out[to])
    return cells[allowed], headings[allowed], to[allowed]


def _graph(plan, kinematics, edges, chosen, turns=True):
    """Steps between (cell, heading) with their time [s], and turns on the spot."""
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


def _turned(node, quarters):
    return node // HEADINGS * HEADINGS + (node + quarters) % HEADINGS


def _lengths(before, spacing):
    """Metres along a tree of predecessors, by pointer doubling."""
    pointer = np.where(before < 0, np.arange(len(before)), before)
    length = np.where(pointer // HEADINGS == np.arange(len(before)) // HEADINGS, 0.0, spacing)
    while True:
        further = pointer[pointer]
        if np.array_equal(further, pointer):
            return length
        length, pointer = length + length[pointer], further
