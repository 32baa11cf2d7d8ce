# SPDX-License-Identifier: Apache-2.0
"""Ways over a floor are the shortest, and the quickest, as a search by scipy finds them."""

import numpy as np
import pytest
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from warehouse_layout._core import Floor, routes, ways
from warehouse_layout.file.request import resolve
from warehouse_layout.generate.generated import plan

STEP, TURN = 2 / 3, 2.125  # [s]


def random_graph(rng, cells):
    """Returns (next, end): cells beside each other in a row of two, with some edges missing."""
    following = np.full((cells, 4), -1, np.int32)
    for heading, offset in enumerate((1, 7, -1, -7)):
        to = np.arange(cells) + offset
        there = (to >= 0) & (to < cells) & (rng.random(cells) < 0.7)
        following[there, heading] = to[there]
    return following, (rng.random(cells) < 0.2).astype(np.uint8)


def by_scipy(following, end, start):
    cells, headings = np.nonzero(following >= 0)
    goes_on = (end == 0) | (np.arange(len(end)) == start)
    cells, headings = cells[goes_on[cells]], headings[goes_on[cells]]
    node = np.arange(following.size)
    turned = [node // 4 * 4 + (node + quarters) % 4 for quarters in (1, 3)]
    rows = np.concatenate([cells * 4 + headings, node, node])
    columns = np.concatenate([following[cells, headings] * 4 + headings, *turned])
    weights = np.r_[np.full(len(cells), STEP), np.full(2 * len(node), TURN)]
    graph = csr_matrix((weights, (rows, columns)), (following.size, following.size))
    return dijkstra(graph, indices=start * 4 + np.arange(4), min_only=True)


@pytest.mark.parametrize("seed", range(20))
def test_the_quickest_ways_are_those_of_dijkstra(seed):
    rng = np.random.default_rng(seed)
    following, end = random_graph(rng, 49)
    start = int(rng.integers(49))
    seconds, steps, before = routes(following, end, start, STEP, TURN)
    quickest = by_scipy(following, end, start).reshape(-1, 4).min(axis=1)
    assert np.array_equal(seconds.reshape(-1, 4).min(axis=1), quickest)
    for node in np.flatnonzero(np.isfinite(seconds) & (before >= 0)):
        is_step = node // 4 != before[node] // 4
        assert steps[node] == steps[before[node]] + is_step
        assert seconds[node] == seconds[before[node]] + (STEP if is_step else TURN)


@pytest.mark.parametrize("seed", range(5))
def test_ways_are_the_quickest_routes_in_any_heading(seed):
    rng = np.random.default_rng(seed)
    following, end = random_graph(rng, 49)
    to = rng.permutation(49)[:20].astype(np.int32)
    seconds, steps = ways(following, end, 3, STEP, TURN, to)
    all_seconds, all_steps, _ = routes(following, end, 3, STEP, TURN)
    nodes = to * 4 + all_seconds.reshape(-1, 4)[to].argmin(axis=1)
    assert np.array_equal(seconds, all_seconds[nodes])
    assert np.array_equal(steps, all_steps[nodes])
    with pytest.raises(ValueError, match="to holds what is not a cell"):
        ways(following, end, 3, STEP, TURN, to + 40)


def test_a_graph_that_does_not_fit_is_refused():
    following, end = random_graph(np.random.default_rng(1), 49)
    for wrong in ((following[1:], end, 0), (following, end, 49), (following, end, -1)):
        with pytest.raises(ValueError, match=r"next \(cells, 4\)"):
            routes(*wrong, STEP, TURN)


@pytest.mark.parametrize("loaded", [False, True])
def test_the_shortest_way_has_as_many_steps_as_a_search_of_all_cells_finds(loaded):
    floor_plan = plan(resolve("small")).plan
    floor, lane = floor_plan.floor(), floor_plan.lane.ravel()
    streets = np.flatnonzero((floor_plan.passable & ~floor_plan.storage).ravel() & ~lane)
    streets = streets[~floor_plan.parking.ravel()[streets]]
    edges = np.asarray(floor.edges(loaded)).reshape(-1, 4)
    cells, headings = np.nonzero(edges >= 0)
    to = edges[cells, headings]
    kept = ~lane[to]  # lanes are no short cuts
    graph = csr_matrix((np.ones(kept.sum()), (cells[kept], to[kept])), (len(lane),) * 2)
    for begin in streets[::40].tolist():
        steps = dijkstra(graph, indices=begin, unweighted=True)
        for end in streets[::7].tolist():
            way = floor.shortest(begin, end, loaded=loaded)
            assert way == (steps[end] if np.isfinite(steps[end]) else -1)


def test_there_is_no_way_off_an_island():
    floor = Floor(np.array([[1, 0, 1]], np.uint8))
    assert floor.shortest(0, 2) == -1
    assert floor.shortest(0, 0) == 0
