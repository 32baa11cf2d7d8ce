# SPDX-License-Identifier: Apache-2.0
"""Plans driven with bodies: the order in each cell is kept, without a contact, to the end."""

import numpy as np
import pytest

from kiva_plugin_cpp import World
from warehouse_fleet import Rules
from warehouse_fleet.league import drive_report, generator
from warehouse_fleet.league.drive_order import order_of
from warehouse_fleet.league.league_floor import layout_of
from warehouse_fleet.league.league_plan import ACTIONS, HEADINGS, LeaguePlan
from warehouse_fleet.league.lifelong import Lifelong, floor_of
from warehouse_fleet.league.plan_driver import Cause, PlanDriver, upright
from warehouse_fleet.league.problem import Problem
from warehouse_fleet.planners.planner_plugins import make_planner


def plan_of(floor, starts, paths):
    """Returns a plan from rows of a map, (row, column, letter) of each robot, and its letters."""
    passable = np.array([[cell == "." for cell in row] for row in floor])
    rows, columns, letters = zip(*starts)
    actions = np.zeros((len(paths), max(map(len, paths))), np.uint8)
    for robot, path in enumerate(paths):
        actions[robot, : len(path)] = [ACTIONS[letter] for letter in path]
    return LeaguePlan(
        passable,
        np.array(rows, np.int32) * passable.shape[1] + np.array(columns, np.int32),
        np.array([HEADINGS[letter] for letter in letters], np.uint8),
        actions,
        "plan.json",
    )


def entered(driver):
    """Drives a plan; returns the robots that entered each cell, in order, as they were seen."""
    cells_of = {}
    cells = driver.plan.cell_of(driver.world.fleet.x, driver.world.fleet.y)
    while not (driver.is_over or driver.is_stuck):
        driver.step()
        now = driver.plan.cell_of(driver.world.fleet.x, driver.world.fleet.y)
        for robot in np.flatnonzero(now != cells).tolist():
            cells_of.setdefault(int(now[robot]), []).append(robot)
        cells = now
    return cells_of


def order_in_cells(driver):
    """Returns the robots that enter each cell by the order of the plan, the same way."""
    robot = np.repeat(np.arange(len(driver.order.steps)), driver.order.steps)
    cell = upright(driver.order.cell, driver.plan)
    queues = {}
    for i in np.argsort(driver.order.rank, kind="stable"):
        queues.setdefault(int(cell[i]), []).append(int(robot[i]))
    return queues


def driven(plan, obstacles="walls"):
    """Drives a plan to its end, and checks what holds for each."""
    laid = layout_of(plan, obstacles)
    driver = PlanDriver(World.of_layout(laid, own_models=True), laid.plan, order_of(plan))
    cells_of = entered(driver)
    assert driver.is_over
    assert driver.at_end().all()
    assert driver.collisions == driver.refusals == 0
    assert cells_of == order_in_cells(driver)
    return driver


def test_two_robots_cross_in_the_order_of_the_plan():
    """The second one is nearer, and waits until the first has passed."""
    floor = ["@@.@@", ".....", "@@.@@"]
    driver = driven(plan_of(floor, [(1, 0, "E"), (0, 2, "S")], ["FFFF", "WWWFF"]))
    assert driver.seconds[Cause.ORDER][1] > 0.5
    assert driver.seconds[Cause.AHEAD][1] > 0.5
    assert driver.seconds[[Cause.ORDER, Cause.AHEAD], 0].sum() == 0


def test_a_queue_follows_at_a_safe_distance():
    starts = [(0, column, "E") for column in (3, 2, 1, 0)]
    driver = driven(plan_of(["." * 12], starts, ["F" * 8] * 4))
    assert (np.diff(driver.arrival) > 0.5).all(), "bodies leave a cell before the next one enters"
    assert driver.seconds[Cause.AHEAD][3] > driver.seconds[Cause.AHEAD][1] > 0
    assert driver.seconds[Cause.AHEAD][0] == 0


def test_the_one_that_drives_alone_takes_as_long_as_its_motors():
    driver = driven(plan_of(["." * 10], [(0, 0, "E")], ["F" * 9]))
    run = driver.kinematics.run(9.0)
    assert driver.arrival[0] == pytest.approx(run, abs=0.35)
    assert driver.seconds[Cause.DRIVING][0] == pytest.approx(9 / 1.5, abs=0.15)
    assert driver.seconds.sum() == pytest.approx(driver.time)


def test_a_ring_is_broken_and_ends_as_planned():
    floor = ["....", "....", "...."]
    starts = [(0, 0, "E"), (0, 1, "S"), (1, 1, "W"), (1, 0, "N")]
    driver = driven(plan_of(floor, starts, ["F", "F", "F", "F"]))
    assert driver.order.rings == 1
    assert driver.seconds[Cause.RING].sum() > 0


@pytest.fixture(scope="module")
def small():
    return generator.warehouse(blocks=(3, 4), block=(5, 2), aisle=1, margin=3, stations=8)


@pytest.mark.parametrize(("seed", "rings"), [(1, False), (2, False), (3, True), (4, True)])
def test_fifty_robots_reach_their_ends_without_a_contact(small, seed, rings):
    rng = np.random.default_rng(seed)
    agents = generator.starts(small, 50, rng)
    tasks = [[int(task)] for task in generator.tasks(small, 1000, rng)]
    problem = Problem(small.walls(), agents.astype(np.int32), tasks, round_robin=True)
    spec = {"options": {"goals_are_stops": False}}
    planner = make_planner(floor_of(problem), Rules(rings=rings), seed, spec, ticks=1)
    run = Lifelong(problem, planner)
    for _ in range(60):
        run.step(attempts=50)
    actions = np.array(run.actions, np.uint8).T
    plan = LeaguePlan(small.walls(), problem.agents, np.zeros(50, np.uint8), actions)
    driver = driven(plan, ("walls", "marked")[seed % 2])
    summary = drive_report.figures(driver, 1.0, 1.0)
    assert summary["executed_over_planned"] > 1.0
    assert drive_report.faults(summary, is_whole=True) == []
    assert f"{summary['robots']} of {summary['robots']}" in drive_report.table(summary)
