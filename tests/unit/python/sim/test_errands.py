# SPDX-License-Identifier: Apache-2.0
"""Errands of two robots at once: their ways are free, and apart from each other."""

import itertools
import math
import random

import pytest

from warehouse_client.routes import NoRouteError, elbow, point
from warehouse_layout.file.request import resolve
from warehouse_layout.generate.generated import plan
from warehouse_sim.errands import AISLE, Chart, meeting, two_errands

FLOOR = set(itertools.product(range(10), range(10)))
BELTS = {"belt1": (9, 1), "belt2": (9, 8)}


def floor_of(name):
    """(Chart, belts) of a preset."""
    layout = plan(resolve(name))
    edges = (range(round(-s / 2) - 1, round(s / 2) + 2) for s in (60, 60))
    points = [{i: point(p) for i, p in enumerate(ps)} for ps in (layout.robots, layout.units)]
    belts = {f"conveyor_belt{i}": point(p) for i, p in enumerate(layout.drops)}
    return Chart(set(itertools.product(*edges)), *points), belts


def drawn(draw):
    points = draw.sample(sorted(FLOOR - set(BELTS.values())), 8)
    return Chart(FLOOR, dict(enumerate(points[:3])), dict(enumerate(points[3:]))), BELTS


@pytest.mark.parametrize("name", ["small", "medium"])
def test_ways_are_free_and_apart(name):
    check(*floor_of(name))


def test_ways_are_apart_where_the_shortest_would_cross():
    draw, count = random.Random(1), 0
    for _ in range(50):
        try:
            check(*drawn(draw))
        except NoRouteError:
            continue
        count += 1
    assert count > 10


def check(chart, belts):
    a, b = two_errands(chart, belts)
    assert a.robot < b.robot
    assert a.unit != b.unit
    assert a.belt != b.belt
    assert min(math.dist(p, q) for p in a.way for q in b.way) > 1.13
    for errand in (a, b):
        unit = chart.units[errand.unit]
        others = {cell for robot, cell in chart.robots.items() if robot != errand.robot}
        assert errand.to_unit == elbow(chart.robots[errand.robot], unit)
        assert errand.to_belt == elbow(unit, belts[errand.belt])
        assert others.isdisjoint(errand.way)
        assert {*chart.units.values()}.isdisjoint(errand.to_belt[1:])
        assert chart.passable.issuperset(errand.way)


def test_one_robot_is_not_enough():
    with pytest.raises(NoRouteError, match="no two robots can fetch two storage units"):
        two_errands(Chart(FLOOR, {1: (0, 0)}, {1: (4, 1), 2: (4, 8)}), BELTS)


def test_robots_meet_in_the_aisle_in_which_they_stand():
    assert meeting(FLOOR, (1, 3), (5, 3)) == ((1, 3), (5, 3))


def test_aisles_are_straight_free_and_long_enough():
    free = {(x, y) for x in range(6) for y in range(6) if x != 2}
    a, b = meeting(free, (0, 0), (0, 1))
    assert a[0] == b[0]
    assert abs(a[1] - b[1]) == AISLE - 1


def test_no_aisle_is_long_enough():
    with pytest.raises(NoRouteError, match="no aisle"):
        meeting(set(itertools.product(range(4), range(4))), (0, 0), (3, 3))
