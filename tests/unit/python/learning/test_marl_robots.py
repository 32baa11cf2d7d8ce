# SPDX-License-Identifier: Apache-2.0
"""What is trained delivers, one robot or several; what chooses by chance does not."""

import numpy as np
import pytest

from warehouse_learning import Options
from warehouse_learning.baselines import greedy_policy, measure, random_policy
from warehouse_learning.marl.encoding import Unchanged
from warehouse_learning.marl.mlp import Mlp
from warehouse_learning.marl.robots import REWARDS, RobotsEnv, train
from warehouse_learning.marl.rollouts import Rollouts
from warehouse_learning.marl.training import Training, TrainingSettings

ALONE = {"robots": 1, "shelves": 6, "requests": 1}


def options(**values):
    return Options.of({"max_cycles": 200, "rewards": REWARDS} | values)


@pytest.mark.parametrize(
    "floor",
    [
        pytest.param({"size": "tiny"}, id="tiny"),
        pytest.param(ALONE, id="alone", marks=pytest.mark.long),
    ],
)
def test_a_trained_policy_beats_chance(floor):
    policy, curve = train(options(**floor), decisions=100_000, seed=0)
    trained = measure(policy, options(**floor), episodes=8, seed=1000)[0].mean()
    chance = measure(random_policy(), options(**floor), episodes=8, seed=1000)[0].mean()
    assert trained > chance + 1.5, curve


def test_no_impossible_action_is_drawn_or_learnt():
    envs = RobotsEnv(4, options(**ALONE), threads=1)
    encoder, random = Unchanged(envs.observation_size), np.random.default_rng(1)
    actor = Mlp([encoder.size, 5], 1.0, random)
    rollout = Rollouts(envs, encoder, random).collect(actor, 40)
    assert not rollout.possible.all()
    assert np.take_along_axis(rollout.possible, rollout.action[..., None].astype(int), -1).all()
    training = Training(envs, encoder, TrainingSettings(environments=4), seed=1)
    count = rollout.action.size
    part = {
        "observations": rollout.observations[:-1].reshape(count, 1, -1),
        "possible": np.tile([True, True, True, True, False], (count, 1, 1)),
        "action": np.zeros((count, 1), int),
        "log": np.full((count, 1), -1.0, np.float32),
        "advantage": random.standard_normal((count, 1)).astype(np.float32),
    }
    bias = training._actor_slopes(part)[-1]
    assert bias[4] == 0 and (bias[:4] != 0).all()


def test_returns_are_what_was_delivered():
    """Rewards lead there; the curve counts units."""
    envs = RobotsEnv(4, options(size="tiny", max_cycles=20), threads=1)
    encoder, random = Unchanged(envs.observation_size), np.random.default_rng(2)
    rollout = Rollouts(envs, encoder, random).collect(Mlp([encoder.size, 5], 0.01, random), 60)
    assert rollout.reward.any() and rollout.end.sum() >= 8
    assert rollout.finished and all(value == int(value) >= 0 for value in rollout.finished)
    for t, which, rows in rollout.cut:
        assert rollout.end[t][which].all()
        assert rows.shape == (which.sum(), envs.agents, encoder.size)


def test_the_greedy_one_delivers_where_nobody_is_in_its_way():
    alone = Options.of(ALONE | {"max_cycles": 150})
    delivered, seconds = measure(greedy_policy(alone), alone, episodes=3)
    assert delivered.min() >= 1
    assert seconds.min() > 100
