#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Stable-Baselines3's PPO moves all robots of `tiny`: pip install stable-baselines3

examples/train_sb3.py [decisions]
"""

import sys

import gymnasium
from stable_baselines3 import PPO
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.evaluation import evaluate_policy

import warehouse_learning  # noqa: F401  registers the environments
from warehouse_learning.marl.robots import REWARDS


def main():
    decisions = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    options = {"max_cycles": 200, "rewards": REWARDS}
    env = gymnasium.make("KivaRobots-tiny-v0", **options)
    check_env(env.unwrapped)
    model = PPO("MlpPolicy", env, seed=0, n_steps=min(2048, decisions), verbose=1)
    model.learn(decisions)
    mean, deviation = evaluate_policy(model, model.get_env(), n_eval_episodes=5)
    print(f"reward of an episode: {mean:.2f} ± {deviation:.2f}")


if __name__ == "__main__":
    main()
