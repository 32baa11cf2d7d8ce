# SPDX-License-Identifier: Apache-2.0
"""The dispatcher of a shift: what simulate does, decision by decision."""

import threading

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="scripts/learning_packages brings it")
pytest.importorskip("scipy", reason="shifts need scipy")
pytest.importorskip("sqlalchemy", reason="shifts need sqlalchemy")

from gymnasium.utils.env_checker import check_env  # noqa: E402

import warehouse_learning  # noqa: E402, F401  registers the environment
from warehouse_learning.operations_env import KivaOperationsEnv, run_shift, usual  # noqa: E402
from warehouse_learning.warehouses import ActionError  # noqa: E402
from warehouse_operations.runs import simulation  # noqa: E402

ALL = ("orders", "units", "robots")
OPTIONS = {"size": "small", "minutes": 5, "robots": 3}


def simulated(seed):
    described = simulation.Description(
        size="small", robots=3, seconds=300, physics=False, seed=seed
    )
    with simulation.open_operations(described) as operations:
        operations.run(seconds=300)
        return operations.kpis()


@pytest.mark.parametrize("decides", [("units",), ("orders",), ("robots",), ALL])
def test_who_takes_the_usual_gets_what_simulate_gets(decides):
    env = KivaOperationsEnv(decides=decides, **OPTIONS)
    got, expected = run_shift(env, usual, 3), simulated(3)
    env.close()
    assert got["return"] == got["items_picked"] > 20
    for name in expected.keys() - {"wall_s", "real_time_factor"}:
        assert got[name] == expected[name], name


def test_decisions_matter_and_seeds_repeat():
    env = KivaOperationsEnv(decides=("orders",), **OPTIONS)
    last = [run_shift(env, lambda d: len(d.keys) - 1, 3)["return"] for _ in range(2)]
    assert last[0] == last[1] < run_shift(env, usual, 3)["return"]
    env.close()


def test_observations_are_as_documented():
    env = gymnasium.make("KivaOperations-v0", decides=ALL, **OPTIONS)
    observation, info = env.reset(seed=1)
    roles = set()
    for _ in range(60):
        assert env.observation_space.contains(observation)
        mask = observation["mask"]
        assert mask.sum() == info["action_mask"].sum() == len(env.unwrapped.decision.keys) > 1
        assert info["usual"] < mask.sum()
        assert not observation["candidates"][int(mask.sum()) :].any()
        roles.add(ALL[int(observation["role"].argmax())])
        observation, reward, ends, truncated, info = env.step(info["usual"])
        assert reward >= 0 and not ends
        if truncated:
            break
    assert roles >= {"orders", "units"}
    env.close()


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_the_checker_finds_nothing():
    check_env(KivaOperationsEnv(**OPTIONS), skip_render_check=True)


def test_a_shift_that_is_left_ends_its_thread():
    before = set(threading.enumerate())  # environments that others left may end meanwhile
    env = KivaOperationsEnv(**OPTIONS)
    for seed in range(3):
        env.reset(seed=seed)
    assert len(set(threading.enumerate()) - before) == 1
    env.close()
    assert not set(threading.enumerate()) - before


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"decides": ["bins"]}, "decides is"),
        ({"decides": []}, "decides is"),
        ({"minutes": 0}, "minutes is 0"),
        ({"seed": 3}, "seed is not an option; there are"),
    ],
)
def test_bad_options(options, said):
    with pytest.raises(ValueError, match=said):
        KivaOperationsEnv(**options)


@pytest.mark.parametrize("action", [-1, 16, 0.5, np.zeros(2, int)])
def test_bad_actions(action):
    env = KivaOperationsEnv(**OPTIONS)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(0)
    env.reset(seed=1)
    with pytest.raises(ActionError, match="a whole number below 16"):
        env.step(action)
    env.close()


def test_a_wrong_description_is_told():
    env = KivaOperationsEnv(size="none")
    with pytest.raises(simulation.ERRORS, match="none"):
        env.reset(seed=1)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(0)


def test_a_shift_without_decisions_ends_at_its_first_step():
    env = KivaOperationsEnv(**OPTIONS | {"orders": "none"})
    env.reset(seed=1)
    _, reward, _, over, info = env.step(0)
    assert (reward, over, info["kpis"]["items_picked"]) == (0.0, True, 0)
    with pytest.raises(gymnasium.error.ResetNeeded, match="begins an episode"):
        env.step(0)
    assert run_shift(env, usual, seed=1)["return"] == 0
    env.close()
