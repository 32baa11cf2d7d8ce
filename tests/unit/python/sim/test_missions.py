# SPDX-License-Identifier: Apache-2.0
"""Plans for two robots at once: their ways are free, and share nothing."""

import itertools
import math
import random

import pytest
from test_hints import survey_of

from warehouse_client.routes import Grid, NoRouteError, point
from warehouse_client.survey import Survey
from warehouse_layout.file.request import resolve
from warehouse_layout.generate.generated import plan
from warehouse_layout.place.layout import Floor
from warehouse_sim.missions import CORRIDOR, Map, meeting, two_missions


def paper_world():
    """The world of worlds/paper.sdf."""
    return Survey(
        kiva={1: (-6, -2, 0), 2: (-6, 2, 0)},
        storage_unit={1: (0, -4, 0), 2: (0, 0, 0), 3: (0, 4, 0)},
        conveyor_belt={1: (7, -3, 0), 2: (7, 3, 0)},
    )


CHARTS = {
    "small": lambda: _chart("small"),
    "medium": lambda: _chart("medium"),
    "paper": lambda: Map(paper_world()),
}


def _chart(name):
    layout = plan(resolve(name))
    return Map(survey_of(layout), layout.floor)


@pytest.fixture(params=CHARTS)
def chart(request):
    return CHARTS[request.param]()


def test_ways_are_free_and_apart(chart):
    a, b = two_missions(chart)
    assert a.cells.isdisjoint(b.cells)
    assert a.kiva < b.kiva
    assert len({a.unit, b.unit}) == len({a.belt, b.belt}) == 2
    for m in (a, b):
        empty_handed, loaded = chart.grid([m.kiva]), chart.grid([m.kiva], chart.units[m.unit])
        assert all(map(empty_handed.free, m.to_unit))
        assert all(map(loaded.free, m.to_drop))
        assert (m.to_unit[0], m.to_unit[-1]) == (chart.robots[m.kiva], m.to_drop[0])
        assert (m.to_drop[-1], m.to_drop[-2]) == (chart.drops[m.belt], m.out)


def test_ways_are_apart_where_the_shortest_would_cross():
    draw, solved = random.Random(1), 0
    for _ in range(30):
        points = draw.sample([(x, y, 0) for x in range(6) for y in range(6)], 6)
        robots, units = dict(enumerate(points[:2], 1)), dict(enumerate(points[2:], 1))
        survey = Survey(kiva=robots, storage_unit=units)
        survey.conveyor_belt = {1: (7.5, 1, 0), 2: (7.5, 4, 0)}
        try:
            a, b = two_missions(Map(survey, Floor(-0.5, 8.5, -0.5, 5.5)))
        except NoRouteError:
            continue
        solved += 1
        assert a.cells.isdisjoint(b.cells)
    assert solved > 10


def test_loaded_robots_do_not_come_side_by_side(chart):
    a, b = two_missions(chart)
    assert min(math.dist(p, q) for p in a.to_drop for q in b.to_drop) > 1.13


def test_steps_go_from_cell_to_cell(chart):
    for mission in two_missions(chart):
        for way in (mission.to_unit, mission.to_drop):
            assert all(math.dist(*pair) == 1 for pair in itertools.pairwise(way))


def test_parked_robots_leave_ahead():
    layout = plan(resolve("small"))
    for mission in two_missions(Map(survey_of(layout), layout.floor)):
        x, y, yaw = layout.robots[mission.kiva - 1]
        assert mission.to_unit[1] == point((x + math.cos(yaw), y + math.sin(yaw)))


def test_drop_points_of_a_layout_are_found():
    layout = plan(resolve("medium"))
    assert list(_chart("medium").drops.values()) == [point(p) for p in layout.drops]


@pytest.mark.parametrize("yaw, drop", [(0, (5, 3)), (math.pi / 2, (7, 1)), (math.pi, (9, 3))])
def test_drop_point_of_a_turned_belt(yaw, drop):
    survey = Survey(kiva={1: (0, 0, 0)}, conveyor_belt={1: (7, 3, yaw)})
    assert Map(survey, Floor(-9.5, 9.5, -9.5, 9.5)).drops == {1: drop}


def test_drop_point_is_at_the_other_end_where_a_wall_stands_before_this_one():
    survey = Survey(kiva={1: (0, 0, 0)}, conveyor_belt={1: (7, 3, 0)}, others={"wall1": (5, 3, 0)})
    assert Map(survey, Floor(-9.5, 9.5, -9.5, 9.5)).drops == {1: (9, 3)}


def test_one_robot_is_not_enough():
    survey = paper_world()
    del survey.kiva[2]
    with pytest.raises(NoRouteError, match="no two robots can fetch two storage units"):
        two_missions(Map(survey))


def test_robots_meet_in_the_aisle_in_which_they_stand():
    grid = Grid(Floor(-0.5, 9.5, -0.5, 9.5))
    assert meeting(grid, (1, 3), (7, 3)) == ((1, 3), (7, 3))


def test_aisles_are_straight_free_and_long_enough():
    grid = Grid(Floor(-0.5, 5.5, -0.5, 5.5), [(2, y) for y in range(6)])
    a, b = meeting(grid, (0, 0), (0, 1))
    assert a[0] == b[0]
    assert abs(a[1] - b[1]) >= CORRIDOR - 1


def test_no_aisle_is_long_enough():
    with pytest.raises(NoRouteError, match="no aisle"):
        meeting(Grid(Floor(-0.5, 3.5, -0.5, 3.5)), (0, 0), (3, 3))
