# SPDX-License-Identifier: Apache-2.0
"""What is trained delivers; what chooses by chance does not."""

from warehouse_learning import Options
from warehouse_learning.baselines import greedy_policy, measure, random_policy
from warehouse_learning.ppo import REWARDS, train


def test_a_trained_policy_beats_chance():
    options = Options.of({"size": "tiny", "max_cycles": 200, "rewards": REWARDS})
    policy, curve = train(options, decisions=100_000, seed=0)
    trained = measure(policy, options, episodes=8, seed=1000)[0].mean()
    chance = measure(random_policy(), options, episodes=8, seed=1000)[0].mean()
    assert trained > chance + 1.5, curve


def test_the_greedy_one_delivers_where_nobody_is_in_its_way():
    options = Options.of({"robots": 1, "shelves": 6, "requests": 1, "max_cycles": 150})
    delivered, seconds = measure(greedy_policy(options), options, episodes=3)
    assert delivered.min() >= 1
    assert seconds.min() > 100
