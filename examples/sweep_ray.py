#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Trains with several learning rates and seeds at once on a Ray cluster: pip install "ray[tune]"

examples/sweep_ray.py [decisions] [--address auto]

Workers need the wheel and nothing else.
"""

import argparse

import ray


@ray.remote(num_cpus=1)
def train(rate, seed, decisions):
    """(rate, seed, units delivered in each of the last episodes)."""
    from warehouse_learning import Options
    from warehouse_learning.baselines import measure
    from warehouse_learning.ppo import REWARDS, Settings
    from warehouse_learning.ppo import train as train_ppo

    options = Options.of({"size": "tiny", "max_cycles": 200, "rewards": REWARDS})
    policy, _ = train_ppo(options, decisions, seed, Settings(rate=rate))
    delivered, _ = measure(policy, options, episodes=8, seed=1000, threads=1)
    return rate, seed, float(delivered.mean())


def main():
    parser = argparse.ArgumentParser("sweep_ray", description=__doc__)
    parser.add_argument("decisions", type=int, nargs="?", default=200_000)
    parser.add_argument("--address", help="of a cluster; none: this machine's cores")
    parser.add_argument("--rates", type=float, nargs="+", default=[3e-4, 1e-3, 3e-3])
    parser.add_argument("--seeds", type=int, default=2)
    wanted = parser.parse_args()
    ray.init(address=wanted.address)
    jobs = [
        train.remote(rate, seed, wanted.decisions)
        for rate in wanted.rates
        for seed in range(wanted.seeds)
    ]
    while jobs:
        done, jobs = ray.wait(jobs)
        rate, seed, delivered = ray.get(done[0])
        print(f"rate {rate:g}, seed {seed}: {delivered:.2f} units an episode", flush=True)
    ray.shutdown()


if __name__ == "__main__":
    main()
