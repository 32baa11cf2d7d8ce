# SPDX-License-Identifier: Apache-2.0
"""Rings of plans become moves one after the other, with the same outcome."""

import numpy as np
import pytest

from warehouse_fleet.league.ring_breaking import NO_ROBOT, RingBreaker, rings_of

ROWS, COLUMNS = 5, 6
SQUARE = (7, 8, 14, 13)  # cells of a ring, in its order


def standing(cells):
    at = np.full(ROWS * COLUMNS, NO_ROBOT)
    at[cells] = range(len(cells))
    return at


def driven(moves, cells):
    """Returns where robots are after the moves, of which each is checked."""
    at, now = standing(cells), list(map(int, cells))
    for robot, start, end in moves:
        assert now[robot] == start
        assert at[end] == NO_ROBOT, "each move enters a free cell"
        assert abs(start - end) in (1, COLUMNS)
        at[start], at[end], now[robot] = NO_ROBOT, robot, end
    return now


def turned(cells, ring):
    after = list(cells)
    for i, robot in enumerate(ring):
        after[robot] = cells[ring[(i + 1) % len(ring)]]
    return after


def test_rings_are_found_among_queues_that_follow_each_other():
    before = np.array([*SQUARE, 20, 21, 22, 0])
    after = np.array([*turned(SQUARE, range(4)), 21, 22, 23, 0])
    assert rings_of(before, after, standing(before)) == [[0, 1, 2, 3]]
    after[2] = SQUARE[2]  # one stands, and the others run into it: that is not a ring
    assert rings_of(before, after, standing(before)) == []


def test_a_ring_turns_by_a_detour():
    cells = np.array(SQUARE)
    moves = RingBreaker(np.ones((ROWS, COLUMNS), bool)).moves(range(4), cells, standing(cells))
    assert driven(moves, cells) == turned(SQUARE, range(4))
    assert len(moves) == 4 + 2


@pytest.mark.parametrize("free", range(2, 6))
@pytest.mark.parametrize("seed", range(10))
def test_robots_in_the_way_make_room_and_go_back(free, seed):
    rng = np.random.default_rng(seed)
    others = rng.permutation(np.setdiff1d(np.arange(ROWS * COLUMNS), SQUARE))[free:]
    cells = np.array([*SQUARE, *others])
    moves = RingBreaker(np.ones((ROWS, COLUMNS), bool)).moves(range(4), cells, standing(cells))
    assert driven(moves, cells) == turned(cells.tolist(), range(4))


def test_without_two_free_cells_there_is_no_way():
    cells = np.array([*SQUARE, *np.setdiff1d(np.arange(ROWS * COLUMNS), SQUARE)[1:]])
    passable = np.ones((ROWS, COLUMNS), bool)
    assert RingBreaker(passable).moves(range(4), cells, standing(cells)) is None
