# SPDX-License-Identifier: Apache-2.0
"""A learned planner keeps robots apart whatever its network says, and brings them to goals."""

import numpy as np
import pytest

from kiva_plugin_cpp import World
from warehouse_fleet import Action, Fleet, Rules, validate
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_fleet.planners import scorer
from warehouse_fleet.planners.learned_planner import ROLE
from warehouse_fleet.planners.local_view import LocalView
from warehouse_fleet.planners.planner_plugins import PlannerError, make_planner, read_spec
from warehouse_fleet.transports.transports import Kind
from warehouse_layout import Floor

LEARNED = {"planner": "learned"}


def after(floor, cell, heading, action):
    step = np.array([1, floor.width, -1, -floor.width], np.int32)
    cell = np.where(action == Action.FORWARD, cell + step[heading], cell)
    return cell, (heading + np.array([0, 0, 1, 3], np.uint8)[action]) & 3


def drive(floor, planner, robots, ticks, seed=1):
    """How many goals are reached, one random goal after the other; make_planner() validates."""
    random = np.random.default_rng(seed)
    cell, goal = (random.choice(floor.size, robots, replace=False) for _ in range(2))
    heading, reached = np.zeros(robots, np.uint8), 0
    for _ in range(ticks):
        plan = planner.plan(Fleet(cell, heading, goal))
        cell, heading = after(floor, cell, heading, plan[:, 0])
        for robot in np.flatnonzero(cell == goal):
            goal[robot] = random.integers(floor.size)
            reached += 1
    return reached


def test_random_goals_are_reached():
    floor = Floor(np.ones((8, 8)))
    assert drive(floor, make_planner(floor, Rules(), 1, LEARNED), 12, 80) > 60


@pytest.mark.parametrize("rules", [Rules(), Rules(following=False)])
def test_a_network_of_chance_is_safe(rules, tmp_path):
    """Each plan is validated, to its last tick."""
    floor = Floor(np.ones((6, 6)))
    chance = np.random.default_rng(2)
    scorer.linear(chance.standard_normal(LocalView.FEATURES)).save(tmp_path / "any.npz", ROLE)
    (tmp_path / "any.yaml").write_text("planner: learned\noptions: {file: any.npz}\n")
    drive(floor, make_planner(floor, rules, 1, read_spec(tmp_path / "any.yaml")), 20, 40)


def test_what_can_not_be_taken_back_is_kept():
    floor = Floor(np.ones((3, 8)))
    committed = np.full((2, 4), 0xFF, np.uint8)
    committed[0, :2] = Action.FORWARD
    fleet = Fleet([8, 11], [0, 2], [15, 8], committed=committed, stopped=[0, 0])
    plan = make_planner(floor, Rules(), 1, LEARNED).plan(fleet)
    assert plan[0, :2].tolist() == [Action.FORWARD, Action.FORWARD]
    assert not validate(floor, fleet, plan, Rules())


def test_who_is_stopped_stands_and_is_passed():
    floor = Floor(np.ones((2, 5)))
    cell, heading, goal = np.array([0, 2]), np.array([0, 0], np.uint8), np.array([4, 2])
    planner = make_planner(floor, Rules(), 1, LEARNED)
    for _ in range(16):
        plan = planner.plan(Fleet(cell, heading, goal, stopped=[0, 1]))
        cell, heading = after(floor, cell, heading, plan[:, 0])
    assert cell.tolist() == [4, 2]


def test_lanes_are_no_short_cuts():
    """A lane of one cell is the shortest way from the left to the right."""
    passable, lane = np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]]), np.zeros((3, 3))
    lane[0, 1] = 1
    view = LocalView(Floor(passable, lane=lane))
    planner = make_planner(Floor(passable, lane=lane), Rules(), 1, LEARNED)
    plan = planner.plan(Fleet([0], [0], [2]))
    assert Action.FORWARD not in plan[0, :1]
    assert view.FEATURES == 16


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"file": "/none.npz"}, "/none.npz"),
        ({"horizon": 0}, "horizon is 0; 1 to 32 ticks were expected"),
        ({"deep": 1}, "deep"),
    ],
)
def test_wrong_options_are_reported(options, said):
    floor = Floor(np.ones((2, 2)))
    with pytest.raises(
        PlannerError, match="planner 'warehouse_fleet.planners.learned_planner:Learned'"
    ):
        make_planner(floor, Rules(), 1, LEARNED | {"options": options})
    with pytest.raises(PlannerError, match=said):
        make_planner(floor, Rules(), 1, LEARNED | {"options": options})


def test_a_fleet_with_bodies_works():
    driver = FleetDriver(World.preset("small"), planner=LEARNED)
    demand = RandomTransports(driver.transports)
    stored = 0
    while driver.time < 240:
        events = driver.transports.take_events()
        stored += sum(event.kind == Kind.STORED for event in events)
        demand.advance(driver.time, events)
        driver.step()
    driver.close()
    assert stored > 3 and not driver.collisions and not driver.traffic.plans.refused
