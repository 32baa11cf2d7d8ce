# SPDX-License-Identifier: Apache-2.0
"""Plans are read with what is wrong named, by file and field; their order is theirs."""

import json

import numpy as np
import pytest

from warehouse_fleet.league import problem
from warehouse_fleet.league.drive_order import order_of
from warehouse_fleet.league.league_plan import read_plan

FLOOR = ["....", ".@..", "...."]
GOOD = {
    "teamSize": 2,
    "start": [[0, 0, "E"], [2, 3, "N"]],
    "actualPaths": ["F,F,R,F", "F,W,C,W"],
}


@pytest.fixture
def files(tmp_path):
    """Writes a floor, and a plan with some fields changed: its path and the map's."""
    floor = tmp_path / "floor.map"
    floor.write_text("type octile\nheight 3\nwidth 4\nmap\n" + "\n".join(FLOOR) + "\n")

    def make(**changed):
        plan = tmp_path / "plan.json"
        fields = {name: value for name, value in {**GOOD, **changed}.items() if value is not None}
        plan.write_text(json.dumps(fields))
        return plan, floor

    return make


def test_robots_are_where_the_actions_lead(files):
    plan = read_plan(*files())
    assert plan.locations().tolist() == [[0, 1, 2, 2, 6], [11, 7, 7, 7, 7]]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"actualPaths": None}, "plan.json: there is no 'actualPaths'"),
        ({"actualPaths": []}, "plan.json: actualPaths is []; a list"),
        ({"actualPaths": ["F,X", "W"]}, 'actualPaths[0]: "X" at tick 1; F, R, C or W'),
        ({"actualPaths": ["F", 7]}, "actualPaths[1] is 7; a text such as"),
        ({"actualPaths": ["F"]}, "teamSize is 2; actualPaths has 1 robots"),
        ({"actualPaths": ["", ""]}, "actualPaths has no ticks"),
        ({"actualPaths": ["F,R,F", "W"]}, "actualPaths: robot 0 would drive out of"),
        ({"actualPaths": ["F,F,F", "F,F,W"]}, "actualPaths: robot 0 and robot 1 would both be in"),
        ({"actualPaths": ["F,F,F,R,F", "F,W,W,W,F"]}, "would exchange their cells"),
        ({"start": None}, "plan.json: there is no 'start'"),
        ({"start": [[0, 0, "E"]]}, "start has 1 robots; actualPaths has 2"),
        ({"start": [[0, 0, "E"], [3, 0, "E"]]}, 'start[1] is [3, 0, "E"]; [row, column, E, S'),
        ({"start": [[0, 0, "E"], [1, 0, "up"]]}, 'start[1] is [1, 0, "up"]; [row, column, E, S'),
        ({"start": [[0, 0, "E"], [1, 1, "E"]]}, 'start[1] is [1, 1, "E"], which is a wall'),
        ({"start": [[0, 0, "E"], [0, 0, "N"]]}, "start[1] is where start[0] is"),
    ],
)
def test_what_is_wrong_is_named(files, changed, message):
    with pytest.raises(problem.ProblemError) as error:
        read_plan(*files(**changed))
    assert message in str(error.value)


def test_a_file_that_is_no_plan_is_named(files, tmp_path):
    plan, floor = files()
    plan.write_text('{"start": [')
    with pytest.raises(problem.ProblemError, match=r"plan.json:1: .*; JSON was expected"):
        read_plan(plan, floor)
    with pytest.raises(problem.ProblemError, match=r"none.json: No such file"):
        read_plan(tmp_path / "none.json", floor)


def test_starts_must_be_those_of_the_problem(files, tmp_path):
    plan, _ = files()
    passable = np.array([[cell == "." for cell in row] for row in FLOOR])
    path = problem.write_problem(tmp_path, "other", passable, [0, 10], [[0]])
    message = r"start\[1\] is row 2, column 3; in .* it is row 2, column 2"
    with pytest.raises(problem.ProblemError, match=message):
        read_plan(plan, path)
    path = problem.write_problem(tmp_path, "right", passable, [0, 11], [[0]])
    assert len(read_plan(plan, path).start) == 2


def test_ranks_are_ticks_where_no_ring_is(files):
    order = order_of(read_plan(*files()))
    assert order.steps.tolist() == [3, 1]
    assert order.cell.tolist() == [1, 2, 6, 7]
    assert order.rank.tolist() == [0, 1, 3, 0]
    assert (order.end.tolist(), order.last.tolist(), order.rings) == ([6, 7], [4, 1], 0)


RING = {
    "teamSize": 4,
    "start": [[0, 2, "E"], [0, 3, "S"], [1, 3, "W"], [1, 2, "N"]],
    "actualPaths": ["W,F", "W,F", "W,F", "W,F,C,F"],
}


def test_a_ring_comes_before_its_tick_move_by_move(files):
    order = order_of(read_plan(*files(**RING)))
    assert order.rings == 1
    assert order.rank_of_tick.tolist() == [0, 7, 8, 9]
    assert sorted(order.rank.tolist()) == [*range(1, 7), 9], "six moves, and the last step"
    assert order.breaks_ring(order.rank).sum() == 6
    assert set(order.tick(order.rank).tolist()) == {1, 3}


def test_a_ring_without_room_is_refused(files, tmp_path):
    plan, floor = files(**RING)
    floor.write_text("type octile\nheight 2\nwidth 4\nmap\n@@..\n@@..\n")
    with pytest.raises(problem.ProblemError, match="at tick 1 4 robots move around in a ring"):
        order_of(read_plan(plan, floor, ticks=2))
