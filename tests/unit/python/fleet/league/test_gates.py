# SPDX-License-Identifier: Apache-2.0
"""How many robots a map lets drive at a time, by its narrowest gate."""

import numpy as np
import pytest

from warehouse_fleet import Rules
from warehouse_fleet._core import PURSUING
from warehouse_fleet.league import gates
from warehouse_fleet.league.lifelong import Lifelong, floor_of
from warehouse_fleet.league.problem import Problem
from warehouse_fleet.planners.planner_plugins import make_planner

SIDE = 20  # of a room [cells]


def two_rooms(width, length=10):
    """Two square rooms, connected by a corridor so wide and long [cells]."""
    passable = np.zeros((SIDE, 2 * SIDE + length), bool)
    passable[:, :SIDE] = passable[:, -SIDE:] = True
    begin = (SIDE - width) // 2
    passable[begin : begin + width] = True
    return passable


def problem_on(passable, robots=1, tasks=4000):
    random = np.random.default_rng(0)
    cells = np.flatnonzero(passable)
    return Problem(
        passable,
        random.choice(cells, robots, replace=False).astype(np.int32),
        [random.choice(cells, 2, replace=False).tolist() for _ in range(tasks)],
        reveal=1.5,
    )


@pytest.mark.parametrize("width", [1, 2, 4])
def test_a_corridor_between_rooms_is_the_gate(width):
    # Half of the ways lead through it; a way is some 20 cells in a room, or 40 from room to room.
    robots = gates.filling(problem_on(two_rooms(width)))
    assert robots / width == pytest.approx(2 * 30, rel=0.3)


def test_the_gate_counts_by_the_errands_beyond():
    passable = two_rooms(2)
    problem = problem_on(passable)
    left = [cell for cell in np.flatnonzero(passable).tolist() if cell % passable.shape[1] < SIDE]
    problem.tasks = [[left[k % len(left)], left[7 * k % len(left)]] for k in range(4000)]
    assert gates.filling(problem) > 3 * gates.filling(problem_on(passable))


def test_the_planner_keeps_its_default_without_narrow_gates():
    assert gates.pursuing(problem_on(np.ones((32, 32), bool))) == PURSUING
    assert gates.pursuing(problem_on(two_rooms(2))) < 0.2


def test_what_no_robot_reaches_does_not_count():
    passable = np.ones((32, 33), bool)
    passable[:, 16] = False
    assert gates.pursuing(problem_on(passable)) == PURSUING


def test_a_map_of_one_cell_has_no_gate():
    assert gates.pursuing(Problem(np.ones((1, 1), bool), np.zeros(1, np.int32), [[0]])) == PURSUING


def test_as_many_robots_as_the_gate_demands_finish_more_tasks_than_all():
    """All 200 fill both ends of the corridor within 250 ticks; then hardly any gets through."""
    problem = problem_on(two_rooms(2), robots=200)
    finished = []
    for share in (PURSUING, gates.pursuing(problem)):
        options = {"goals_are_stops": False, "pursuing": share}
        spec = {"options": options}
        planner = make_planner(floor_of(problem), Rules(rings=True), 1, spec, ticks=1)
        run = Lifelong(problem, planner, share)
        for _ in range(300):
            run.step(attempts=100)
        before = run.finished
        for _ in range(200):
            run.step(attempts=100)
        finished.append(run.finished - before)
    assert finished[1] > 5 * finished[0]
