# SPDX-License-Identifier: Apache-2.0
"""Ways over the grid and the commands made of them."""

import math

import pytest

from warehouse_client.routes import NoRouteError, covered, elbow, goals, route

FLOOR = {(x, y) for x in range(6) for y in range(5)}


def test_straight_way():
    assert route(FLOOR, (0, 0), (3, 0)) == [(0, 0), (1, 0), (2, 0), (3, 0)]


def test_way_round_a_wall():
    points = route(FLOOR - {(2, y) for y in range(4)}, (0, 0), (4, 0))
    assert (2, 4) in points
    assert len(points) == 1 + 4 + 4 + 4


def test_few_turns():
    assert len(goals(route(FLOOR, (0, 0), (5, 4)))) == 1


def test_start_may_be_blocked():
    assert route(FLOOR - {(0, 0)}, (0, 0), (1, 0)) == [(0, 0), (1, 0)]


@pytest.mark.parametrize("goal", [(9, 0), (1, 0)])
def test_no_way(goal):
    with pytest.raises(NoRouteError, match=rf"no way from \(0, 0\) to \({goal[0]}, 0\)"):
        route(FLOOR - {(1, 0)}, (0, 0), goal)


def test_one_goal_covers_x_then_y():
    assert goals([(0, 0), (1, 0), (1, 1), (1, 2)]) == [(1, 2)]


def test_y_then_x_needs_two_goals():
    assert goals([(0, 0), (0, 1), (1, 1)]) == [(0, 1), (1, 1)]


def test_goals_lead_over_the_route():
    points = route(FLOOR - {(2, y) for y in range(4)}, (0, 0), (4, 0))
    driven, here = [points[0]], points[0]
    for goal in goals(points):
        driven += elbow(here, goal)[1:]
        here = goal
    assert driven == points


def test_a_route_to_where_one_stands_needs_no_goal():
    assert goals(route(FLOOR, (1, 1), (1, 1))) == []


def test_elbow_goes_back_as_well():
    assert elbow((2, 2), (1, 0)) == [(2, 2), (1, 2), (1, 1), (1, 0)]


@pytest.mark.parametrize(
    "yaw, cells",
    [
        (0, [(6, -3), (7, -3), (8, -3)]),
        (math.pi / 2, [(7, -4), (7, -3), (7, -2)]),
    ],
)
def test_cells_of_a_belt_on_a_grid_point(yaw, cells):
    assert covered(7, -3, yaw, 1.8, 0.8) == cells


def test_cells_of_a_belt_between_grid_points():
    assert covered(7.5, 2, 0, 1.8, 0.8) == [(7, 2), (8, 2)]


def test_a_cell_is_covered_where_only_a_little_reaches_into_it():
    assert covered(0, 0, 0, 1.1, 0.5) == [(-1, 0), (0, 0), (1, 0)]
    assert covered(0, 0, 0, 1.0, 0.5) == [(0, 0)]
