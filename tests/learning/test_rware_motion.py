# SPDX-License-Identifier: Apache-2.0
"""RWARE's task where actions take time, with and without bodies."""

import numpy as np
import pytest

pytest.importorskip("gymnasium", reason="gymnasium is missing: scripts/learning_packages")

from gymnasium.vector import AutoresetMode  # noqa: E402
from pettingzoo.test import parallel_api_test  # noqa: E402

from kiva_plugin_cpp import World  # noqa: E402
from warehouse_learning import rware  # noqa: E402
from warehouse_learning.rware.motion import DURATIONS  # noqa: E402
from warehouse_learning.rware.task import Action  # noqa: E402

FLOOR = """
g x x . g
. x x . .
. . . . .
x . . x .
g . . x g
"""
LIKELY = [0.05, 0.5, 0.1, 0.1, 0.25]
NEAR = 0.03  # [m]


def make(physics, agents, **options):
    options = {"layout": FLOOR, "request_queue_size": 3, "max_steps": 10_000} | options
    return rware.Warehouse(physics=physics, n_agents=agents, **options)


def drawn(agents, steps, seed=1):
    return np.random.default_rng(seed).choice(5, size=(steps, agents), p=LIKELY).tolist()


def seed_that_delivers(actions):
    """Returns a seed with which a robot alone on the grid delivers."""
    env = make("grid", 1)
    for seed in range(1000):
        env.reset(seed=seed)
        if sum(env.step(action)[1][0] for action in actions):
            return seed
    raise AssertionError("no seed delivers")


@pytest.mark.parametrize("physics", ["ideal", "bodies"])
def test_a_robot_alone_does_as_on_the_grid(physics):
    actions = drawn(1, 250)
    seed = seed_that_delivers(actions)
    grid, other = make("grid", 1), make(physics, 1)
    assert (grid.reset(seed=seed)[0][0] == other.reset(seed=seed)[0][0]).all()
    for step, action in enumerate(actions):
        expected, got = grid.step(action), other.step(action)
        assert (expected[0][0] == got[0][0]).all(), f"step {step}"
        assert expected[1:4] == got[1:4]
    assert got[4]["time"] > 100


def test_actions_take_as_long_as_with_bodies():
    """What the ideal robot is given is what the physics needs."""
    ideal, bodies = make("ideal", 1), make("bodies", 1)
    ideal.reset(seed=5), bodies.reset(seed=5)
    before, times = 0.0, set()
    for action in drawn(1, 60):
        time = bodies.step(action)[4]["time"]
        passed = time - before
        seconds = ideal.step(action)[4]["time"]
        if passed > 0.06:
            times.add(action[0])
            assert passed == pytest.approx(DURATIONS[Action(action[0])], abs=0.001)
        assert seconds <= time + 0.5
        before = time
    assert times == {1, 2, 3, 4}


def off_grid(env):
    """The farthest that a robot, and a unit, is from where the task has it [m]."""
    motion, core = env.motion, env.warehouses
    agents = core.agents(0)
    x, y = motion._at(agents[:, 0])
    robots = np.hypot(motion.worlds.x[0] - x, motion.worlds.y[0] - y).max()
    units = motion.worlds[0].storage_units
    x, y = motion._at(np.array(core.shelves(0)))
    return robots, np.hypot(units["x"] - x, units["y"] - y).max()


@pytest.mark.parametrize("decision", ["action", 0.7])
def test_bodies_are_where_the_task_has_them(decision):
    env = make("bodies", 5, decision=decision)
    env.reset(seed=2)
    moved = 0
    for action in drawn(5, 250):
        before = env.warehouses.agents(0)
        info = env.step(action)[4]
        moved += (env.warehouses.agents(0)[:, 0] != before[:, 0]).sum()
        assert not info["collisions"].any()
        if not info["busy"].any():
            assert max(off_grid(env)) < NEAR
    assert moved > 50


def test_robots_wait_for_a_cell_until_it_is_empty():
    """A robot on the grid follows at once."""
    options = {"layout": ". . . . .\ng . . . x", "request_queue_size": 1}
    seed = seed_of_a_column(options)
    steps = {}
    for physics in ("grid", "bodies"):
        env = make(physics, 2, **options)
        env.reset(seed=seed)
        steps[physics] = 0
        while env.warehouses.agents(0)[1][0] < 2:
            env.step([1, 1])
            steps[physics] += 1
    assert steps == {"grid": 2, "bodies": 3}


def seed_of_a_column(options):
    """After which agent 0 is in cell 1 and agent 1 behind it, both facing to the right."""
    env = make("grid", 2, **options)
    for seed in range(20_000):
        env.reset(seed=seed)
        if env.warehouses.agents(0)[:, :2].tolist() == [[1, 3], [0, 3]]:
            return seed
    raise AssertionError("no seed begins like that")


def test_who_is_busy_goes_on_with_it():
    env = make("ideal", 1, decision=0.5)
    env.reset(seed=5)
    for action in drawn(1, 100):
        if env.step(action)[4]["busy"][0]:
            break
    before = env.warehouses.agents(0).tolist()
    steps = 0
    while env.step([2])[4]["busy"][0] and steps < 9:
        steps += 1
    assert 1 <= steps <= 4
    assert env.warehouses.agents(0).tolist() != before


@pytest.mark.parametrize("physics", ["ideal", "bodies"])
def test_vectors_are_single_ones_side_by_side(physics):
    options = {"layout": FLOOR, "request_queue_size": 3, "max_steps": 30, "n_agents": 3}
    envs = rware.RwareVectorEnv(
        3, physics=physics, autoreset_mode=AutoresetMode.SAME_STEP, **options
    )
    alone = make(physics, 3, max_steps=30)
    assert (np.stack(alone.reset(seed=9)[0]) == envs.reset(seed=7)[0][2]).all()
    for action in drawn(3, 70):
        observations, rewards, ends, _, infos = envs.step([action] * 3)
        expected = alone.step(action)
        last = infos["final_obs"] if ends[2] else observations
        assert (np.stack(expected[0]) == last[2]).all()
        assert expected[1] == rewards[2].tolist()
        if ends[2]:
            assert (np.stack(alone.reset()[0]) == observations[2]).all()
        else:
            assert infos["time"][2] == pytest.approx(expected[4]["time"], abs=1e-9)


def test_pettingzoo_tells_each_its_own():
    env = rware.parallel_env("rware-tiny-2ag-v2", physics="ideal")
    parallel_api_test(env, 100)
    env.reset(seed=1)
    infos = env.step({"agent_0": 2, "agent_1": 2})[-1]
    assert infos["agent_0"] == {"time": pytest.approx(0.7), "busy": False}


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"physics": "real"}, "physics is 'real'; one of grid, ideal, bodies"),
        ({"physics": "ideal", "decision": 0}, "decision is 0"),
        ({"physics": "ideal", "decision": "tick"}, "decision is 'tick'"),
    ],
)
def test_bad_options(options, said):
    with pytest.raises(ValueError, match=said):
        rware.Warehouse(**options)


def test_a_world_has_the_floor_of_the_task():
    env = make("bodies", 2)
    env.reset(seed=1)
    world = env.motion.worlds[0]
    assert isinstance(world, World)
    assert len(world.storage_units) == 7
    assert len(world.fleet) == 2
