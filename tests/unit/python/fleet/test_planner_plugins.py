# SPDX-License-Identifier: Apache-2.0
"""Planners of users, in Python and in C++, the check of their plans, and how long plans took."""

import sys

import numpy as np
import pytest
from paths import ROOT

from warehouse_fleet import Action, Fleet, Rules, epibt, validate
from warehouse_fleet.planners.plan_times import PlanTimes
from warehouse_fleet.planners.planner_plugins import (
    PlannerError,
    PlanRefusedError,
    make_planner,
    read_spec,
)
from warehouse_layout import Floor, FloorError

EXAMPLES = ROOT / "src/warehouse_fleet/examples"
LIBRARY = ROOT / "devel/lib/libright_of_way.so"


@pytest.fixture
def floor():
    return Floor(np.ones((4, 6)))


class Says:
    """Answers what it was made with."""

    answer = None

    def start(self, floor, rules, seed):
        pass

    def plan(self, fleet):
        return self.answer


def refusal(floor, fleet, answer, names=None, rules=None):
    Says.answer = answer
    planner = make_planner(floor, rules or Rules(), 1, {"planner": f"{__name__}:Says"}, names)
    with pytest.raises(PlanRefusedError) as error:
        planner.plan(fleet)
    return str(error.value)


def arrives(planner, floor, ticks=40):
    cell, heading = np.array([0, 23], np.int32), np.array([1, 1], np.uint8)
    goal = np.array([11, 12], np.int32)
    step = np.array([1, floor.width, -1, -floor.width], np.int32)
    for _ in range(ticks):
        action = planner.plan(Fleet(cell, heading, goal))[:, 0]
        cell = np.where(action == Action.FORWARD, cell + step[heading], cell)
        heading = (heading + np.array([0, 0, 1, 3], np.uint8)[action]) & 3
    return (cell == goal).all()


@pytest.mark.parametrize("planner", ["epibt", "right_of_way:RightOfWay", f"{LIBRARY}:RightOfWay"])
def test_each_example_drives(floor, planner, monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(EXAMPLES))
    named = tmp_path / "planner.yaml"
    named.write_text(f"planner: {planner}\n")
    assert arrives(make_planner(floor, Rules(), 1, read_spec(named)), floor)
    sys.modules.pop("right_of_way", None)


def test_a_plan_that_collides_is_refused_with_names(floor):
    fleet = Fleet([0, 2], [0, 2], [5, 0])
    text = refusal(floor, fleet, np.array([1, 1]), names=["kiva3", "kiva7"])
    assert text == "kiva3 and kiva7 would both be in (1, 0) (tick 0)"
    text = refusal(floor, Fleet([0, 1], [0, 2], [1, 0]), np.array([1, 0]))
    assert text == "robot 0 and robot 1 would exchange their cells at (1, 0) (tick 0)"
    follow = Fleet([0, 1], [0, 0], [1, 2])
    assert "while the other leaves it" in refusal(
        floor, follow, np.array([1, 2]), rules=Rules(following=False)
    )


def test_what_is_no_plan_is_refused(floor):
    fleet = Fleet([0, 5], [0, 0], [5, 0])
    assert "a next cell for each robot" in refusal(floor, fleet, np.array([1]))
    assert "a next cell for each robot" in refusal(floor, fleet, np.array([1.5, 2]))
    assert "that cell or a neighbour" in refusal(floor, fleet, np.array([2, 5]))
    assert "that cell or a neighbour" in refusal(floor, fleet, np.array([0, 6]))  # the next row


def test_a_planner_may_answer_with_actions(floor):
    fleet = Fleet([0, 5], [0, 0], [5, 0])
    answer = np.array([[Action.FORWARD, Action.WAIT], [Action.TURN_NEGATIVE, Action.WAIT]])
    Says.answer = answer
    planner = make_planner(floor, Rules(), 1, {"planner": f"{__name__}:Says"})
    assert planner.plan(fleet).tolist() == answer.tolist()
    assert "a plan of Actions" in refusal(floor, fleet, answer[:1])
    assert "a plan of Actions" in refusal(floor, fleet, answer + 3)
    assert "a plan of Actions" in refusal(floor, fleet, answer + 0.5)


def test_who_does_not_face_its_cell_turns_first(floor):
    Says.answer = np.array([6, 4])
    planner = make_planner(floor, Rules(), 1, {"planner": f"{__name__}:Says"})
    assert planner.plan(Fleet([0, 5], [0, 0], [5, 0])).tolist() == [
        [Action.TURN_POSITIVE, Action.FORWARD, Action.WAIT],
        [Action.TURN_POSITIVE, Action.TURN_POSITIVE, Action.FORWARD],
    ]


@pytest.mark.parametrize(
    "spec,expected",
    [
        (
            {"planner": "nothing"},
            "planner 'nothing'; epibt, learned, MODULE:CLASS or LIBRARY.so:CLASS",
        ),
        ({"planner": "nowhere:Mine"}, "planner 'nowhere:Mine': No module named 'nowhere'"),
        ({"planner": "json:Mine"}, "planner 'json:Mine': module 'json' has no attribute 'Mine'"),
        ({"planner": f"{LIBRARY}:Mine"}, "no class Mine; it has RightOfWay (fleet::Planner)"),
        ({"plan": "epibt"}, "unknown key 'plan'; planner, options were expected"),
        ({"options": {"deep": 4}}, "epibt: no such option: deep"),
        ({"options": {"depth": 2.5}}, "epibt: depth is 2.5; a whole number was expected"),
        ({"options": {"crowd": "x"}}, "epibt: crowd is 'x'; a number was expected"),
        ({"options": {"goals_are_stops": "no"}}, "is 'no'; true or false was expected"),
    ],
)
def test_no_such_planner(floor, spec, expected):
    with pytest.raises(PlannerError) as error:
        make_planner(floor, Rules(), 1, spec)
    assert expected in str(error.value)


def test_arrays_in_and_out(floor):
    fleet = Fleet([3], [2], [0], loaded=[1], closed=[9])
    assert fleet.cell.dtype == np.int32 and fleet.cell.tolist() == [3]
    assert not fleet.cell.flags.writeable and fleet.closed.tolist() == [9]
    actions = epibt(floor, seed=1, depth=3).plan(fleet)
    assert actions.shape == (1, 3) and actions[0].tolist() == [Action.FORWARD] * 3
    assert not validate(floor, fleet, actions, Rules())
    with pytest.raises(FloorError, match="robot 0 has heading 7; 0 to 3 was expected"):
        epibt(floor).plan(Fleet([3], [7], [0]))
    assert floor.edges().shape == (24, 4) and floor.edges()[0].tolist() == [1, 6, -1, -1]


def test_times_are_kept_from_the_oldest_to_the_newest():
    times = PlanTimes(kept=3)
    assert not times and times.all().tolist() == []
    for count, kept in ((2, [0, 1]), (3, [0, 1, 2]), (5, [2, 3, 4]), (6, [3, 4, 5])):
        while times._count < count:
            times.append(float(times._count))
        assert times.all().tolist() == kept
        assert len(times) == len(kept)


def test_a_long_shift_takes_no_more_memory():
    times = PlanTimes()
    before = times._times.nbytes
    for number in range(25_000):
        times.append(number)
    assert times._times.nbytes == before == 8 * len(times)
    assert times.all()[[0, -1]].tolist() == [15_000, 24_999]
