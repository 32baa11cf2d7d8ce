# SPDX-License-Identifier: Apache-2.0
"""The ecosystem's own checks of the environments, with warnings as errors."""

import numpy as np
import pytest

MISSING = "gymnasium or pettingzoo is missing: scripts/learning_packages brings them from PyPI"
gymnasium = pytest.importorskip("gymnasium", reason=MISSING)
pytest.importorskip("pettingzoo", reason=MISSING)

from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402
from pettingzoo.test import (  # noqa: E402
    api_test,
    max_cycles_test,
    parallel_api_test,
    parallel_seed_test,
    render_test,
    seed_test,
)

import warehouse_learning  # noqa: E402
from warehouse_learning import ActionError, fields  # noqa: E402

pytestmark = pytest.mark.filterwarnings("error")
TINY = {"size": "tiny"}
REGISTERED = [
    f"{name}{size}-v0"
    for name in ("KivaWarehouse", "KivaRobots")
    for size in ("", "-tiny", "-small", "-medium", "-large")
]


def parallel(**options):
    return warehouse_learning.parallel_env(**TINY | options)


def turns(**options):
    return warehouse_learning.env(**TINY | options)


VARIANTS = [
    {},
    {"size": "small"},
    {"size": "medium"},
    {"continuous": True},
    {"lasers": True},
    {"decision": 0.5},
    {"reserve": False},
]


@pytest.mark.parametrize("options", VARIANTS, ids=str)
def test_pettingzoo(options):
    parallel_api_test(parallel(**options), 1000)
    api_test(turns(max_cycles=100, **options), 1000)
    parallel_seed_test(lambda: parallel(**options), 100)
    seed_test(lambda: turns(**options), 50)
    render_test(lambda **mode: turns(**options | mode))


def test_pettingzoo_large():
    parallel_api_test(parallel(size="large"), 100)


def test_max_cycles():
    max_cycles_test(warehouse_learning)


@pytest.mark.parametrize("name", REGISTERED)
def test_gymnasium(name):
    check_env(gymnasium.make(name).unwrapped)
    # Half a second of a dispatcher is a decision too, and a tenth of its own.
    options = {"decision": 0.5} if "Warehouse" in name else {}
    env = gymnasium.make(name, max_cycles=400, **options)
    env.action_space.seed(1)
    env.reset(seed=1)
    for step in range(1, 1001):
        observation, reward, ended, cut, _ = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation) and np.isfinite(reward)
        assert not ended and cut == (step % 400 == 0)
        if cut:
            env.reset()
    env.close()


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_many_at_once_are_each_as_one_alone(mode):
    cycles, seed = 8, 3
    options = TINY | {"max_cycles": cycles}
    many = gymnasium.make_vec("KivaRobots-v0", num_envs=3, autoreset_mode=mode, **options)
    alone = gymnasium.make("KivaRobots-v0", **options)
    observations, _ = many.reset(seed=seed)
    assert many.observation_space.contains(observations)
    many.action_space.seed(seed)
    expected, _ = alone.reset(seed=seed + 1)
    np.testing.assert_array_equal(observations[1], expected)
    for cycle in range(cycles):
        actions = many.action_space.sample()
        before = observations
        observations, rewards, ended, cut, infos = many.step(actions)
        assert observations is not before
        expected, reward, _, ends, _ = alone.step(actions[1])
        last = cycle == cycles - 1
        assert cut.tolist() == [last] * 3 and not ended.any() and ends == last
        assert rewards[1] == reward
        if last and mode == AutoresetMode.SAME_STEP:
            np.testing.assert_array_equal(infos["final_obs"][1], expected)
            assert (observations[1] != expected).any()
        else:
            np.testing.assert_array_equal(observations[1], expected)
    if mode == AutoresetMode.NEXT_STEP:
        observations, rewards, _, cut, _ = many.step(many.action_space.sample())
        assert not cut.any() and not rewards.any()
    elif mode == AutoresetMode.DISABLED:
        with pytest.raises(gymnasium.error.ResetNeeded, match="environment 0 has ended"):
            many.step(many.action_space.sample())
        chosen = np.array([False, True, False])
        many.reset(options={"reset_mask": chosen})
    many.close()
    alone.close()


def test_observations_are_what_their_fields_say_and_new_each_time():
    env = parallel()
    observations, infos = env.reset(seed=0)
    row = observations["robot_1"]
    assert row.shape == env.observation_space("robot_1").shape
    see = fields.split(row, env.fields)
    assert see["neighbourhood"].shape == (5, 5, len(fields.LAYERS))
    assert see["neighbourhood"][2, 2, fields.LAYERS.index("robot")] == 1
    assert see["load"].tolist() == [1, 0, 0] and see["heading"].sum() == 1
    assert infos["robot_1"]["action_mask"][0] == 1
    assert env.state_space.contains(env.state())
    kept = row.copy()
    again = env.step(dict.fromkeys(env.agents, 2))[0]["robot_1"]
    assert (row == kept).all() and not np.shares_memory(row, again)


def test_bad_actions_name_the_agent():
    env = parallel()
    env.reset(seed=0)
    good = dict.fromkeys(env.agents, 0)
    for bad, said in (
        ({"robot_2": 7}, "robot_2: action 7; a whole number from 0 to 4"),
        ({"robot_3": np.nan}, "robot_3: action nan"),
        ({"robot_1": [1, 2]}, "robot_1"),
        ({"robot_9": 0}, "no agent 'robot_9'"),
    ):
        with pytest.raises(ActionError, match=said):
            env.step(good | bad)
    with pytest.raises(ActionError, match="robot_3 has no action"):
        env.step({"robot_1": 0, "robot_2": 0})
    in_turns = turns()
    in_turns.reset(seed=0)
    in_turns.step(0)
    with pytest.raises(ActionError, match="robot_2: action nan"):
        in_turns.step(np.nan)
    jointly = gymnasium.make("KivaRobots-tiny-v0").unwrapped
    jointly.reset(seed=0)
    for bad, said in (
        ([0, np.nan, 0], "robot_2 of world 0: action nan"),
        (["left", "left", "left"], "robot_1 of world 0: action .*left"),
        ([[0, 0, 0]], r"shape \(3,\) was expected, not \(1, 3\)"),
    ):
        with pytest.raises(ActionError, match=said):
            jointly.step(bad)
    dispatcher = gymnasium.make("KivaWarehouse-tiny-v0").unwrapped
    dispatcher.reset(seed=0)
    with pytest.raises(ActionError, match="dispatcher: action 99"):
        dispatcher.step(99)
    dispatcher.close()


def test_a_dispatcher_that_gives_tasks_gets_units_delivered():
    env = gymnasium.make("KivaWarehouse-tiny-v0", max_cycles=30).unwrapped
    runs = []
    for _ in range(2):
        observation, info = env.reset(seed=5)
        run, total, cut = [observation], 0.0, False
        while not cut:
            possible = np.flatnonzero(info["action_mask"])
            observation, reward, _, cut, info = env.step(int(possible[-1]))
            run.append(observation)
            total += reward
        assert info["delivered"] == total >= 2
        runs.append(run)
    assert all((a == b).all() for a, b in zip(*runs))
    env.close()
