#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""RLlib's PPO, one policy that all robots share: pip install "ray[rllib]" torch

examples/train_rllib.py [iterations]
"""

import sys

import ray
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.env.wrappers.pettingzoo_env import ParallelPettingZooEnv
from ray.tune.registry import register_env

import warehouse_learning
from warehouse_learning.marl.robots import REWARDS


def make(_config):
    return ParallelPettingZooEnv(
        warehouse_learning.parallel_env(size="tiny", max_cycles=200, rewards=REWARDS)
    )


def main():
    iterations = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    ray.init()
    register_env("kiva", make)
    config = (
        PPOConfig()
        .environment("kiva")
        .env_runners(num_env_runners=1, sample_timeout_s=600)  # on a busy machine, too
        .training(train_batch_size_per_learner=1000, minibatch_size=128, num_epochs=4)
        .multi_agent(policies={"robot"}, policy_mapping_fn=lambda *_, **__: "robot")
    )
    algorithm = config.build_algo()
    for i in range(iterations):
        result = algorithm.train()
        print(i, result["env_runners"].get("episode_return_mean"))
    algorithm.stop()
    ray.shutdown()


if __name__ == "__main__":
    main()
