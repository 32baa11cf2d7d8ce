# SPDX-License-Identifier: Apache-2.0
"""Which robot does which task of a problem of the League of Robot Runners."""

import numpy as np
import pytest

from warehouse_fleet.league import schedulers
from warehouse_fleet.league.problem import Problem
from warehouse_fleet.league.schedulers import NOWHERE, Shortest

CORRIDOR = np.ones((1, 20), bool)
WALL = np.ones((3, 20), bool)
WALL[:2, 10] = False


def of(tasks, robots, reveal=10.0, passable=CORRIDOR):
    return Shortest(Problem(passable, np.array(robots, np.int32), tasks, reveal=reveal))


def dealt(scheduler, task, errand, cell, finished=0):
    return dict(scheduler.give(*map(np.array, (task, errand, cell)), finished))


def test_ways_are_shortest_in_all():
    # The first robot is nearest to both tasks.
    scheduler = of([[6, 7], [8, 9]], [7, 12])
    assert dealt(scheduler, [NOWHERE] * 2, [0, 0], [7, 12]) == {0: 0, 1: 1}


def test_a_short_task_comes_before_a_long_one_as_far_away():
    assert dealt(of([[2, 19], [8, 9]], [5]), [NOWHERE], [0], [5]) == {0: 1}


def test_robots_come_farther_where_more_tasks_wait(monkeypatch):
    monkeypatch.setattr(schedulers, "QUEUE", 1.5)
    for waiting, first in ((schedulers.CHANCE, 0), (schedulers.CHANCE + 1, 1)):
        tasks = [[8, 9], *([13, 14] for _ in range(waiting))]
        assert dealt(of(tasks, [10], len(tasks)), [NOWHERE], [0], [10]) == {0: first}


def test_a_nearer_robot_takes_a_task_over_that_is_not_begun():
    scheduler = of([[10, 11], [19, 18], [0, 1]], [0, 9], reveal=1)
    assert dealt(scheduler, [NOWHERE, NOWHERE], [0, 0], [9, 18]) == {0: 0, 1: 1}
    # The second robot has done task 1 beside task 0, which the first one has not begun.
    assert dealt(scheduler, [0, NOWHERE], [0, 0], [0, 11], finished=1) == {1: 0, 0: 2}


def test_a_task_that_is_begun_stays_with_its_robot():
    scheduler = of([[10, 11], [19, 18]], [0, 9], reveal=1)
    dealt(scheduler, [NOWHERE, NOWHERE], [0, 0], [9, 18])
    assert dealt(scheduler, [0, NOWHERE], [1, 0], [0, 11], finished=1) == {1: 2}


def test_as_many_tasks_are_known_as_the_problem_says_and_the_first_come_again():
    scheduler = of([[5, 6], [0, 1]], [0], reveal=1)
    assert dealt(scheduler, [NOWHERE], [0], [0]) == {0: 0}
    assert dealt(scheduler, [NOWHERE], [0], [6], finished=1) == {0: 1}
    assert dealt(scheduler, [NOWHERE], [0], [1], finished=2) == {0: 2}


def test_on_a_crowded_floor_those_nearest_to_a_task_get_one():
    robots = range(0, 20, 2)  # ten on 20 cells, of which nine may be at work
    scheduler = of([[cell, cell] for cell in range(10, 20)], robots, reveal=1)
    assert dealt(scheduler, [NOWHERE] * 10, [0] * 10, robots).keys() == {*range(1, 10)}


def test_of_many_robots_that_wait_some_are_weighed(monkeypatch):
    monkeypatch.setattr(schedulers, "MOST_PAIRS", 30)
    robots = range(10)
    problem = Problem(CORRIDOR, np.array(robots, np.int32), [[15, 15], [16, 16], [17, 17]] * 4)
    scheduler = Shortest(problem, pursuing=0.2)  # four of the ten
    assert len(dealt(scheduler, [NOWHERE] * 10, [0] * 10, robots)) == 4


@pytest.mark.parametrize("most", [4000, 1])
def test_ways_lead_around_walls(monkeypatch, most):
    monkeypatch.setattr(schedulers, "MOST_TABLE", most)
    scheduler = of([[11, 11], [5, 5]], [9], passable=WALL)
    assert dealt(scheduler, [NOWHERE], [0], [9]) == {0: 1}


def test_on_large_maps_ways_are_at_least_as_long_and_nearly_as_long_as_told(monkeypatch):
    rooms = np.ones((40, 60), bool)
    rooms[:, ::10] = rooms[::10] = False
    rooms[5::10, 1:] = rooms[1:, 5::10] = True  # doors
    cells = np.flatnonzero(rooms)
    whole = schedulers._Ways(rooms).between(cells[:, None], cells)
    monkeypatch.setattr(schedulers, "MOST_TABLE", 0)
    monkeypatch.setattr(schedulers, "LANDMARKS", 50)
    bound = schedulers._Ways(rooms).between(cells[:, None], cells)
    assert (bound <= whole).all()
    assert (whole - bound).mean() < 0.05 * whole.mean()


def test_large_fleets_are_dealt_tasks_in_parts(monkeypatch):
    monkeypatch.setattr(schedulers, "MOST_PAIRS", 4)
    scheduler = of([[i, i] for i in range(6)], [0, 1, 2, 3, 4, 5], reveal=1)
    assert sorted(dealt(scheduler, [NOWHERE] * 6, [0] * 6, range(6)).values()) == [*range(6)]


def test_of_large_fleets_some_are_weighed_again(monkeypatch):
    scheduler = of([[19, 19], [18, 18], [17, 17], [0, 0], [2, 2]], [0, 19, 18, 17], reveal=1)
    first = dealt(scheduler, [NOWHERE] * 4, [0] * 4, [0, 19, 18, 17])
    assert first == {0: 3, 1: 0, 2: 1, 3: 2}
    # The first robot has gone to where the others want to, and they to where a task is revealed.
    monkeypatch.setattr(schedulers, "MOST_PAIRS", 4)
    then = dealt(scheduler, [NOWHERE, 0, 1, 2], [0] * 4, [19, 1, 2, 3], finished=1)
    (other,) = then.keys() - {0}
    assert then == {0: first[other], other: 4}
